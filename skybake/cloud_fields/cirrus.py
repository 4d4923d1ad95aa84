"""Cirrus: crystals that fall out of heads near the top, and that shear draws into hooks."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.fit import Surface, fitted_field
from skybake.cloud_fields.noise import billows, random_map
from skybake.cloud_fields.scales import displacements, dyadic

_ROWS, _COLUMNS = 768, 384
_LEVELS = 13
_STRETCH = 3.0
_WIDTH = 1.0
"""Distance that stands for a change of density from none to all. [km]"""


def cirrus(
    cover: float, base: float, depth: float, size: float, optical_depth: float, seed: int
) -> CloudField:
    """Return a layer of cirrus, whose trails lie along x.

    Parameters
    ----------
    cover : float
        Share of the sky it covers, seen from below, in (0, 1].
    base, depth : float
        Altitude where the trails end, and height of the heads above it. [km]
    size : float
        Distance over which shear draws the trails. [km]
    optical_depth : float
        Vertical, mean where there is cloud.
    seed : int
        Another one, another layer.
    """
    across = dyadic(size / 80.0)
    along = _STRETCH * across
    extent = (_ROWS * across, _COLUMNS * along)
    rise = dyadic(depth / (_LEVELS - 3))
    density = _trails(extent, (across, along), size, cover, seed)
    # Where there is none the surface is so far that no blur reaches it.
    nodes = (_WIDTH * (0.5 - density)).astype(np.float32)
    surface = Surface(
        nodes=nodes,
        spacing=np.array([rise, across, along]),
        base=base - rise,
        profile=np.ones(len(nodes)),
        edge=_WIDTH,
        widest_edge=_WIDTH,
        condensation=base - 10.0 * depth,
        displacement=displacements(
            extent[::-1], [(0.012 * _WIDTH, 0.4 * size), (0.006 * _WIDTH, 0.1 * size)], seed
        ),
        noise=billows(seed),
    )
    return fitted_field(surface, cover, optical_depth, 0.45 * _WIDTH)


def _trails(
    extent: tuple[float, float],
    spacing: tuple[float, float],
    size: float,
    cover: float,
    seed: int,
) -> npt.NDArray[np.float64]:
    """Return relative densities; below 0 where there would have to be more cover for cloud."""
    across, along = spacing
    shape = (_ROWS, _COLUMNS)
    heads = random_map(shape, extent, -1.4, (1.5 * across, 0.7 * size), (seed, 12))
    patches = random_map(shape, extent, -2.4, (0.25 * size, 0.3 * extent[1]), (seed, 13))
    envelope = 1.0 / (1.0 + np.exp(-2.5 * (patches - np.quantile(patches, 1.0 - cover))))
    source = np.fft.rfft2(np.maximum(heads + 1.2 * (cover - 0.7), 0.0) ** 1.5 * envelope)
    kx = 2.0 * np.pi * np.fft.rfftfreq(_COLUMNS, along)
    ky = 2.0 * np.pi * np.fft.fftfreq(_ROWS, across)[:, None]
    wander = 0.22 * size * random_map(shape, extent, -3.0, (1.2 * size, 5.0 * size), (seed, 14))
    rows = np.arange(_ROWS)[:, None] + wander / across
    density = np.zeros((_LEVELS, *shape))
    for level in range(1, _LEVELS - 1):
        fallen = 1.0 - (level - 1) / (_LEVELS - 3)
        # Crystals fall faster than they drift at first, and evaporate as they fall.
        drift, smear = 1.5 * size * fallen**1.7, size * (0.12 + 0.75 * fallen)
        moved = np.exp(-1j * kx * drift - 0.5 * (kx * smear) ** 2)
        spread = np.exp(-0.5 * (ky * across * (0.4 + 0.9 * fallen)) ** 2)
        trail = np.fft.irfft2(source * moved * spread, s=shape)
        trail *= math.exp(-1.3 * fallen) * (1.0 - fallen**4)
        density[level] = _along_rows(trail, rows)
    return density / np.quantile(density, 0.995)


def _along_rows(
    values: npt.NDArray[np.float64], rows: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]:
    """Look values up at fractional rows of each column, linear between rows."""
    low = np.floor(rows).astype(int)
    share = rows - low
    columns = np.arange(values.shape[1])[None]
    count = len(values)
    below, above = values[low % count, columns], values[(low + 1) % count, columns]
    return np.asarray(below + share * (above - below), np.float64)
