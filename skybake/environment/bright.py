"""Texels that hold much of a map's light, such as a sun's, which are to keep all of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from skybake.environment.environment import Pixels, charts_of
from skybake.environment.gather import Source, fill_peaks
from skybake.environment.layout import NOWHERE, Layout, direction_at, layout_of, place_of
from skybake.jit.kernel import kernel
from skybake.jit.workers import Workers
from skybake.projection.chart import Projection

BRIGHT = 4.0
"""Times the mean magnitude of a map's pixels beyond which a texel is bright."""

MOST = 20_000
"""Bright texels; more of them are not few enough to fail by chance."""

_STRIP = 1 << 18

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Bright:
    """The bright texels of a map.

    Attributes
    ----------
    threshold : float
        Largest magnitude of all others.
    texel : ndarray of int64, shape (bright,)
        Indices among all pixels of the map, in rising order.
    place : ndarray of int64, shape (bright, 3)
        Chart, row and column.
    size : ndarray of float64, shape (bright,)
        Solid angles. [sr]
    """

    threshold: float
    texel: Index
    place: Index
    size: Array


def bright_texels(projection: Projection, pixels: Pixels, workers: Workers) -> Bright:
    """Find the texels that are far brighter than the mean.

    Parameters
    ----------
    projection : Projection
        Of the map.
    pixels : ndarray of float32, shape (pixel, 3)
        Of all of its canvases.
    workers : Workers
        Threads that do the work.
    """
    peaks = np.empty(len(pixels), np.float32)

    def fill(first: int, last: int) -> None:
        fill_peaks(pixels[first:last], peaks[first:last])

    workers.run_rows(len(pixels), fill, chunk=_STRIP)
    threshold = BRIGHT * _mean(projection, peaks)
    texel = np.flatnonzero(peaks > threshold)
    if texel.size > MOST:
        threshold = float(np.partition(peaks[texel], -MOST)[-MOST])
        texel = np.flatnonzero(peaks > threshold)
    place = _places(layout_of(projection), texel)
    return Bright(threshold, texel, place, _sizes(projection, place))


def _mean(projection: Projection, peaks: npt.NDArray[np.float32]) -> float:
    """Mean of pixels; of an equirect map, whose rows at the poles are small, by solid angle."""
    (chart, *others) = (part.chart for canvas in projection.canvases() for part in canvas.parts)
    sizes = chart.solid_angles(0, chart.height)
    if others or sizes.shape[1] > 1:
        return float(peaks.mean(dtype=np.float64))
    rows = peaks.reshape(chart.height, chart.width).mean(axis=1, dtype=np.float64)
    return float(rows @ sizes[:, 0] / sizes.sum())


def gains_of(bright: Bright, received: Array, source: Source, layout: Layout) -> Array:
    """Return by how much more of each bright texel's light pixels have to take.

    Parameters
    ----------
    bright : Bright
        The texels.
    received : ndarray of float64, shape (bright,)
        Solid angles in which pixels see them. [sr]
    source : Source
        Their map.
    layout : Layout
        Of the map that the pixels belong to. Where it ends within a texel, it takes its share only.
    """
    _, is_whole = _found(bright, source, layout)
    gains = np.divide(bright.size, received, out=np.ones_like(received), where=received > 0.0)
    gains[~is_whole] = 1.0
    return gains


def add_missed(
    bright: Bright,
    received: Array,
    source: Source,
    projection: Projection,
    pictures: tuple[Pixels, ...],
) -> None:
    """Add the excess of bright texels that no sample fell on, to the pixels that they lie in."""
    missed = received == 0.0
    if not missed.any():
        return
    found, _ = _found(bright, source, layout_of(projection))
    rgb = source.pixels[bright.texel].astype(np.float64)
    excess = 1.0 - bright.threshold / np.abs(rgb).max(axis=1)
    flux = (bright.size * excess)[:, None] * rgb
    sizes = _sizes(projection, found)
    for number, (_, place) in enumerate(charts_of(projection, pictures)):
        here = missed & (found[:, 0] == number) & (sizes > 0.0)
        added = (flux[here] / sizes[here, None]).astype(np.float32)
        np.add.at(place, (found[here, 1], found[here, 2]), added)


def _places(layout: Layout, texel: Index) -> Index:
    """Chart, row and column of pixels, `NOWHERE` of those between charts."""
    place = np.full((texel.size, 3), NOWHERE, np.int64)
    for chart, (origin, down, right) in enumerate(layout.place.tolist()):
        width = abs(down)
        along = (texel - origin) * (1 if down > 0 else -1)
        is_same = (down > 0) == (right > 0)
        row = along // width if is_same else -(-along // width)
        column = along - row * width if is_same else row * width - along
        rows, columns = layout.size[chart]
        here = (row >= 0) & (row < rows) & (column < columns)
        place[here] = np.stack([np.full(row.shape, chart), row, column], axis=1)[here]
    return place


def _sizes(projection: Projection, place: Index) -> Array:
    """Solid angles of pixels at charts, rows and columns. [sr]"""
    sizes = np.zeros(len(place))
    charts = [part.chart for canvas in projection.canvases() for part in canvas.parts]
    for number, chart in enumerate(charts):
        here = place[:, 0] == number
        for row in np.unique(place[here, 1]).tolist():
            chosen = here & (place[:, 1] == row)
            of_row = chart.solid_angles(row, row + 1)[0]
            sizes[chosen] = of_row[np.minimum(place[chosen, 2], of_row.size - 1)]
    return sizes


def _found(bright: Bright, source: Source, layout: Layout) -> tuple[Index, npt.NDArray[np.bool_]]:
    """Where in a map the centres of bright texels are, and whether it has all of their corners."""
    found = np.full((bright.texel.size, 3), NOWHERE, np.int64)
    is_whole = np.zeros(bright.texel.size, np.bool_)
    fill_found(source.layout, bright.place, source.cosine, source.sine, layout, found, is_whole)
    return found, is_whole


@kernel
def fill_found(source, places, cosine, sine, target, found, is_whole):
    """Write where one map has the centres of another's texels, and whether it has all corners."""
    for i in range(places.shape[0]):
        chart, row, column = places[i, 0], places[i, 1], places[i, 2]
        if chart == NOWHERE:
            continue
        is_whole[i] = True
        for corner in range(5):
            down = 0.5 if corner == 4 else float(corner & 1)
            right = 0.5 if corner == 4 else float(corner >> 1)
            x, y, z, _ = direction_at(source, chart, row + down, column + right)
            there, place_row, place_column = place_of(
                target, x * cosine + z * sine, y, z * cosine - x * sine
            )
            if there == NOWHERE:
                is_whole[i] = False
        # The last one is the centre.
        if there != NOWHERE:
            found[i, 0] = there
            found[i, 1] = min(int(place_row), target.size[there, 0] - 1)
            found[i, 2] = min(int(place_column), target.size[there, 1] - 1)
