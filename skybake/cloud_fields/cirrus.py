"""Cirrus: crystals that fall out of heads near the top, and that shear draws into hooks."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.fit import Surface, fitted_field
from skybake.cloud_fields.noise import billows, random_map
from skybake.cloud_fields.scales import displacements, dyadic

_COLUMNS = 768
_LEVELS = 13
_WIDTH = 1.0
"""Distance that stands for a change of density from none to all. [km]"""


def cirrus(
    cover: float,
    base: float,
    depth: float,
    size: float,
    optical_depth: float,
    seed: int,
    wind_from: float,
) -> CloudField:
    """Return a layer of cirrus.

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
    wind_from : float
        Where the wind comes from, clockwise from north: trails lag behind their heads, where it
        blows faster. [rad]
    """
    spacing = dyadic(size / 80.0)
    period = _COLUMNS * spacing
    rise = dyadic(depth / (_LEVELS - 3))
    lag = math.sin(wind_from), math.cos(wind_from)
    density = _trails(spacing, size, cover, lag, seed)
    # Where there is none the surface is so far that no blur reaches it.
    nodes = (_WIDTH * (0.5 - density)).astype(np.float32)
    surface = Surface(
        nodes=nodes,
        spacing=np.array([rise, spacing, spacing]),
        base=base - rise,
        profile=np.ones(len(nodes)),
        edge=_WIDTH,
        widest_edge=_WIDTH,
        condensation=base - 10.0 * depth,
        displacement=displacements(
            (period, period), [(0.012 * _WIDTH, 0.4 * size), (0.006 * _WIDTH, 0.1 * size)], seed
        ),
        noise=billows(seed),
    )
    return fitted_field(surface, cover, optical_depth, 0.45 * _WIDTH)


def _trails(
    spacing: float, size: float, cover: float, lag: tuple[float, float], seed: int
) -> npt.NDArray[np.float64]:
    """Return relative densities; below 0 where there would have to be more cover for cloud."""
    shape = (_COLUMNS, _COLUMNS)
    extent = (_COLUMNS * spacing, _COLUMNS * spacing)
    heads = random_map(shape, extent, -1.4, (1.5 * spacing, 0.7 * size), (seed, 12))
    patches = random_map(shape, extent, -2.4, (0.25 * size, 0.4 * extent[0]), (seed, 13))
    envelope = 1.0 / (1.0 + np.exp(-2.5 * (patches - np.quantile(patches, 1.0 - cover))))
    source = np.fft.rfft2(np.maximum(heads + 1.2 * (cover - 0.7), 0.0) ** 1.5 * envelope)
    kx = 2.0 * np.pi * np.fft.rfftfreq(_COLUMNS, spacing)
    ky = 2.0 * np.pi * np.fft.fftfreq(_COLUMNS, spacing)[:, None]
    along, across = kx * lag[0] + ky * lag[1], ky * lag[0] - kx * lag[1]
    wander = 0.22 * size * random_map(shape, extent, -3.0, (1.2 * size, 5.0 * size), (seed, 14))
    rows, columns = np.indices(shape, np.float64)
    rows += wander * (lag[0] / spacing)
    columns -= wander * (lag[1] / spacing)
    density = np.zeros((_LEVELS, *shape))
    for level in range(1, _LEVELS - 1):
        fallen = 1.0 - (level - 1) / (_LEVELS - 3)
        # Crystals fall faster than they drift at first, and evaporate as they fall.
        drift, smear = 1.5 * size * fallen**1.7, size * (0.12 + 0.75 * fallen)
        moved = np.exp(-1j * along * drift - 0.5 * (along * smear) ** 2)
        spread = np.exp(-0.5 * (across * spacing * (0.4 + 0.9 * fallen)) ** 2)
        trail = np.fft.irfft2(source * moved * spread, s=shape)
        trail *= math.exp(-1.3 * fallen) * (1.0 - fallen**4)
        density[level] = _between_columns(trail, rows, columns)
    return density / np.quantile(density, 0.995)


def _between_columns(
    values: npt.NDArray[np.float64],
    rows: npt.NDArray[np.float64],
    columns: npt.NDArray[np.float64],
) -> npt.NDArray[np.float64]:
    """Look values of a periodic map up at fractional rows and columns, linear between."""
    count = len(values)
    j, i = np.floor(rows).astype(int), np.floor(columns).astype(int)
    v, u = rows - j, columns - i
    j, i = j % count, i % count
    north, east = (j + 1) % count, (i + 1) % count
    low = values[j, i] + u * (values[j, east] - values[j, i])
    high = values[north, i] + u * (values[north, east] - values[north, i])
    return np.asarray(low + v * (high - low), np.float64)
