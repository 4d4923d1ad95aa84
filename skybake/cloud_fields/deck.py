"""Layers of clouds whose height varies from place to place: stratus and cells of overturning."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.fit import Surface, fitted_field
from skybake.cloud_fields.noise import billows, random_map
from skybake.cloud_fields.scales import displacements, dyadic
from skybake.cloud_fields.slopes import limit_slopes
from skybake.jit.kernel import kernel

Map = npt.NDArray[np.float64]

_COLUMNS = 512
_TURBULENCE = -5.0 / 3.0


class Deck(NamedTuple):
    """How a deck looks; lengths are in its cells' size or in its depth.

    Attributes
    ----------
    nodes_per_cell : float
        Nodes of the tile in the size of a cell.
    cells, swell, weather : float
        Share of the depth that varies with the cells, with turbulence that is finer, and with
        the regions of the tile.
    elongation : float
        Of cells along y, as in rolls.
    wander : float
        By which cells are displaced from where they would be, in their size.
    base : float
        By which the base undulates, in the depth.
    billows : tuple of tuple of float
        Amplitude in the depth and period in the size of each noise.
    edge : float
        Distance over which clouds end, in the depth.
    """

    nodes_per_cell: float
    cells: float
    swell: float
    weather: float
    elongation: float
    wander: float
    base: float
    billows: tuple[tuple[float, float], ...]
    edge: float


STRATUS = Deck(22.0, 0.1, 0.08, 0.05, 1.6, 0.3, 0.12, ((0.1, 0.5), (0.03, 0.11)), 0.3)
STRATOCUMULUS = Deck(
    24.0, 0.62, 0.16, 0.25, 1.25, 0.34, 0.16, ((0.2, 0.5), (0.07, 0.13), (0.02, 0.035)), 0.1
)
ALTOCUMULUS = Deck(
    14.0, 1.0, 0.2, 0.32, 1.5, 0.4, 0.1, ((0.3, 0.62), (0.1, 0.17), (0.03, 0.05)), 0.16
)


def deck(
    look: Deck,
    cover: float,
    base: float,
    depth: float,
    size: float,
    optical_depth: float,
    seed: int,
) -> CloudField:
    """Return a layer of clouds.

    Parameters
    ----------
    look : Deck
        Its kind.
    cover : float
        Share of the sky it covers, seen from below, in (0, 1].
    base, depth : float
        Altitude of the base, and height above it of all but the highest clouds. [km]
    size : float
        Of a cell of overturning air. [km]
    optical_depth : float
        Vertical, mean where there is cloud.
    seed : int
        Another one, another layer.

    Notes
    -----
    Extinction inside goes with the height to the power of 2/3, so that optical depth goes with
    that of the layer to the power of 5/3, as in an adiabatic one.
    """
    spacing = dyadic(size / look.nodes_per_cell)
    period = _COLUMNS * spacing
    height = depth * _relative_height(look, cover, size, period, seed)
    rise = dyadic(depth / 11.0)
    margin = 0.5 * depth
    below = math.ceil(0.45 * depth / rise)
    above = math.ceil((min(float(height.max()), 1.6 * depth) + 0.3 * depth) / rise)
    heights = rise * np.arange(-below, above + 1)
    extent = (period, period)
    floor = look.base * depth * _map(-2.0, (2.0 * spacing, 2.0 * size), extent, (seed, 6))
    # Both sides of a lens: most of it rises above the level of condensation, some hangs below.
    upper, lower = (0.85 * height).astype(np.float32), (floor - 0.15 * height).astype(np.float32)
    z = heights.astype(np.float32)[:, None, None]
    slope = _inverse_steepness(height, spacing)
    nodes = np.clip(np.maximum(z - upper, lower - z) * slope, -margin, margin)
    steps = np.array([rise, spacing, spacing])
    limit_slopes(nodes, steps)
    surface = Surface(
        nodes=nodes,
        spacing=steps,
        base=base + float(heights[0]),
        profile=np.maximum(heights + 0.3 * depth, 0.05 * depth) ** (2.0 / 3.0),
        edge=look.edge * depth,
        widest_edge=0.6 * depth,
        condensation=base - 10.0 * depth,
        displacement=displacements(
            extent, [(depth * amplitude, size * length) for amplitude, length in look.billows], seed
        ),
        noise=billows(seed),
    )
    return fitted_field(surface, cover, optical_depth, 0.8 * depth)


def _relative_height(look: Deck, cover: float, size: float, period: float, seed: int) -> Map:
    """Return heights in the depth, whose quantile at the share without cloud is 0."""
    extent = (period, period)
    spacing = period / _COLUMNS
    swell = _map(_TURBULENCE, (2.5 * spacing, 2.0 * size), extent, (seed, 7))
    weather = _map(_TURBULENCE, (2.0 * size, 0.3 * period), extent, (seed, 8))
    cells = _cells(look, size, period, seed)
    thick = look.cells * cells + look.swell * swell + look.weather * weather
    low = float(np.quantile(thick, 1.0 - cover)) if cover < 1.0 else float(thick.min())
    if cover >= 1.0:
        # A closed deck is deep everywhere, and only its surface shows cells.
        return 0.55 + 0.45 * (thick - low) / float(np.quantile(thick - low, 0.95))
    height = thick - low
    return np.maximum(height / float(np.quantile(height[height > 0.0], 0.9)), -0.5)


def _cells(look: Deck, size: float, period: float, seed: int) -> Map:
    """Return domes with seams between them, 0 at the seams and up to 1."""
    extent = (period, period)
    counts = max(2, round(period / (size * look.elongation))), max(2, round(period / size))
    rng = np.random.default_rng([seed, 9])
    points = 0.5 + 0.85 * (rng.random((*counts, 2)) - 0.5)
    scales = (0.12 * size, 2.5 * size)
    away = [look.wander * size * _map(-2.2, scales, extent, (seed, q)) for q in (10, 11)]
    seams = np.empty((_COLUMNS, _COLUMNS))
    _seam_distances(seams, points, away[0], away[1], period)
    return np.minimum(seams / 0.62, 1.0) ** 0.65


def _map(
    slope: float, scales: tuple[float, float], extent: tuple[float, float], seed: tuple[int, int]
) -> Map:
    return random_map((_COLUMNS, _COLUMNS), extent, slope, scales, seed)


def _inverse_steepness(height: Map, spacing: float) -> npt.NDArray[np.float32]:
    """Return by what a difference in height is to be multiplied for a distance."""
    east = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / (2.0 * spacing)
    north = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) / (2.0 * spacing)
    return (1.0 / np.sqrt(1.0 + east**2 + north**2)).astype(np.float32)


@kernel
def _seam_distances(seams, points, away_y, away_x, period):
    """By how much the second nearest of one point a cell is farther than the nearest, in cells."""
    rows, columns = points.shape[0], points.shape[1]
    size = seams.shape[0]
    for b in range(size):
        for a in range(size):
            y = (b / size + away_y[b, a] / period) * rows
            x = (a / size + away_x[b, a] / period) * columns
            j0, i0 = math.floor(y), math.floor(x)
            nearest = second = 1e9
            for j in range(j0 - 2, j0 + 3):
                for i in range(i0 - 2, i0 + 3):
                    point = points[j % rows, i % columns]
                    distance = (i + point[0] - x) ** 2 + (j + point[1] - y) ** 2
                    if distance < nearest:
                        second = nearest
                        nearest = distance
                    elif distance < second:
                        second = distance
            seams[b, a] = math.sqrt(second) - math.sqrt(nearest)
