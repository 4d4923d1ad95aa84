"""A view of what another picture shows, made while the rows of that picture are read."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.projection.cells import Array
from skybake.projection.chart import Canvas, Part
from skybake.projection.perspective import Perspective

Pixels = npt.NDArray[np.float32]
Index = npt.NDArray[np.int32]

_FINER = 2


class _Taps(NamedTuple):
    """Samples between two rows of a picture and two columns of each."""

    sample: Index
    rows: tuple[Index, Index]
    columns: tuple[Index, Index]
    down: npt.NDArray[np.float32]
    right: npt.NDArray[np.float32]


class Lookup:
    """A perspective view of a picture, linear between its pixels.

    Parameters
    ----------
    canvas : Canvas
        The layout of the picture that is looked at.
    view : Perspective
        What is seen of it. Each pixel is the mean of four samples; directions that the
        picture does not show are black.

    Attributes
    ----------
    shows_something : bool
        Whether the picture shows any direction of the view.
    """

    def __init__(self, canvas: Canvas, view: Perspective) -> None:
        fine = view.finer(_FINER)
        (seen,) = fine.canvases()
        vectors = fine.vectors().reshape(-1, 3)
        self._shape = (view.height, _FINER, view.width, _FINER, 3)
        self._seen = np.zeros((seen.height * seen.width, 3), np.float32)
        self._taps = []
        missing = np.arange(len(vectors), dtype=np.int32)
        for part in canvas.parts:
            row, column = part.chart.places(vectors[missing])
            found = np.isfinite(row)
            if found.any():
                self._taps.append(_taps(part, missing[found], row[found], column[found]))
            missing = missing[~found]
        self.shows_something = len(missing) < len(vectors)
        self._above: Pixels | None = None
        self._first = 0

    def add(self, rows: Pixels) -> None:
        """Take the next rows of the picture, shape (row, column, 3)."""
        if self._above is not None:
            rows, first = np.concatenate([self._above, rows]), self._first - 1
        else:
            first = self._first
        last = first + len(rows)
        for taps in self._taps:
            upper = np.minimum(*taps.rows)
            # The last row was looked at with those after it, unless both taps are that row.
            here = (upper >= first) & (np.maximum(*taps.rows) < last)
            if self._above is not None:
                here &= np.maximum(*taps.rows) > first
            if here.any():
                self._seen[taps.sample[here]] = _interpolated(rows, first, taps, here)
        self._above, self._first = rows[-1:], last

    def result(self) -> Pixels:
        """Return the view, shape (row, column, 3), when all rows have been added."""
        mean: Pixels = self._seen.reshape(self._shape).mean(axis=(1, 3), dtype=np.float32)
        return mean


def _taps(part: Part, sample: Index, row: Array, column: Array) -> _Taps:
    chart = part.chart
    top, down = _neighbours(row, chart.height)
    if chart.wraps:
        start = np.floor(column - 0.5).astype(np.int32)
        left, right = (start % chart.width, (start + 1) % chart.width), column - 0.5 - start
    else:
        left, right = _neighbours(column, chart.width)
    if part.flip in {"rows", "both"}:
        top = (chart.height - 1 - top[0], chart.height - 1 - top[1])
    if part.flip in {"columns", "both"}:
        left = (chart.width - 1 - left[0], chart.width - 1 - left[1])
    return _Taps(
        sample,
        (top[0] + np.int32(part.row), top[1] + np.int32(part.row)),
        (left[0] + np.int32(part.column), left[1] + np.int32(part.column)),
        down.astype(np.float32),
        right.astype(np.float32),
    )


def _neighbours(place: Array, count: int) -> tuple[tuple[Index, Index], Array]:
    """Return the two pixels beside a place, and how far it is toward the second."""
    start = np.floor(place - 0.5).astype(np.int32)
    along = place - 0.5 - start
    return (np.clip(start, 0, count - 1), np.clip(start + 1, 0, count - 1)), along


def _interpolated(rows: Pixels, first: int, taps: _Taps, here: npt.NDArray[np.bool_]) -> Pixels:
    (top, bottom), (left, right) = (
        (taps.rows[0][here] - first, taps.rows[1][here] - first),
        (taps.columns[0][here], taps.columns[1][here]),
    )
    down, across = taps.down[here, None], taps.right[here, None]
    above = rows[top, left] * (1.0 - across) + rows[top, right] * across
    below = rows[bottom, left] * (1.0 - across) + rows[bottom, right] * across
    between: Pixels = above * (1.0 - down) + below * down
    return between
