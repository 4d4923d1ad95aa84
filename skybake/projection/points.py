"""Points of light on charts: a few pixels each, that keep the flux exactly."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.projection.cells import Array
from skybake.projection.chart import Chart

ROWS_AT_ONCE = 128

REACH = 1.5
"""Half the width of a point's spot where pixels are square. [pixel]"""


class Spots(NamedTuple):
    """Shares of points in pixels, ordered by points.

    Attributes
    ----------
    point : ndarray of int64, shape (share,)
        Index of a point.
    texel : ndarray of int64, shape (share,)
        Index of a pixel in a flat image.
    weight : ndarray of float64, shape (share,)
        Share of the point's flux over the pixel's solid angle. [sr⁻¹]
    """

    point: npt.NDArray[np.int64]
    texel: npt.NDArray[np.int64]
    weight: Array


def spread_points(chart: Chart, vectors: Array) -> Spots:
    """Spread points over the pixels about them.

    Parameters
    ----------
    chart : Chart
        Where the pixels look.
    vectors : ndarray of float64, shape (n, 3)
        Unit vectors; points that the chart does not show have no share.

    Notes
    -----
    A spot is a quadratic B-spline, 3 pixels wide: narrower ones flicker when a point moves from
    pixel to pixel, 4 to 1 in the brightest one with linear weights and 2.25 to 1 with these. It is
    round in the sky: where pixels are slivers it has as many more of them as they are narrower.
    What would lie beyond the edge of the chart stays in the pixels at the edge.
    """
    row, column = chart.places(vectors)
    shown = np.flatnonzero(np.isfinite(row) & np.isfinite(column))
    row, column = row[shown], column[shown]
    point, y, down = _bands(row, np.ones(len(row)), chart.height, wraps=False)
    stretch = np.minimum(chart.stretch(row), chart.width / (2.0 * REACH))
    # Of every row of a spot, all its columns.
    part, x, across = _bands(column[point], stretch[point], chart.width, wraps=chart.wraps)
    y, share, point = y[part], down[part] * across, point[part]
    solid_angle = _solid_angles(chart, y, x)
    share = np.where(solid_angle > 0.0, share, 0.0)
    total = np.bincount(point, share, minlength=len(row))
    is_lit = share > 0.0
    point, y, x, share = point[is_lit], y[is_lit], x[is_lit], share[is_lit]
    weight = share / total[point] / solid_angle[is_lit]
    return Spots(shown[point], y * chart.width + x, weight)


def _solid_angles(chart: Chart, row: npt.NDArray[np.int64], column: npt.NDArray[np.int64]) -> Array:
    """Solid angles of single pixels. [sr]"""
    sizes = np.empty(len(row))
    order = np.argsort(row, kind="stable")
    # Those of a whole map would fill the memory.
    ends = np.searchsorted(row[order], np.arange(0, chart.height + ROWS_AT_ONCE, ROWS_AT_ONCE))
    for i, (begin, end) in enumerate(pairwise(ends)):
        if begin == end:
            continue
        first = i * ROWS_AT_ONCE
        last = min(first + ROWS_AT_ONCE, chart.height)
        band = np.broadcast_to(chart.solid_angles(first, last), (last - first, chart.width))
        those = order[begin:end]
        sizes[those] = band[row[those] - first, column[those]]
    return sizes


def _bands(
    centre: Array, stretch: Array, length: int, *, wraps: bool
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Array]:
    """Pixels of a line that spots cover: whose spot, which pixel, and its share.

    Parameters
    ----------
    centre, stretch : ndarray of float64, shape (spot,)
        Middles of the spots [pixel], and by how much wider they are.
    length : int
        Of the line. [pixel]
    wraps : bool
        Whether its ends meet.
    """
    reach = REACH * stretch
    first = np.ceil(centre - reach - 0.5).astype(np.int64)
    last = np.floor(centre + reach - 0.5).astype(np.int64)
    if wraps:
        last = np.minimum(last, first + length - 1)
    else:
        first = np.clip(first, 0, length - 1)
        last = np.clip(last, first, length - 1)
    count = last - first + 1
    spot = np.repeat(np.arange(len(centre)), count)
    step = np.arange(len(spot)) - np.repeat(np.cumsum(count) - count, count)
    pixel = first[spot] + step
    share = _spline(np.abs(pixel + 0.5 - centre[spot]) / stretch[spot])
    return spot, pixel % length, share


def _spline(distance: Array) -> Array:
    """Quadratic B-spline at distances in pixels from its middle."""
    inner = 0.75 - distance**2
    outer = 0.5 * np.maximum(REACH - distance, 0.0) ** 2
    return np.where(distance < 0.5, inner, outer)
