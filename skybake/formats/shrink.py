"""Reduces maps band by band, since a large one would fill the memory."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import OpenImageIO

Pixels = npt.NDArray[np.float32]

_MARGIN = 2


class Shrinking:
    """A picture that is averaged to at most a width while its rows arrive.

    Parameters
    ----------
    width, height : int
        Size of the whole picture. [pixel]
    max_width : int
        Largest width of the result. [pixel]

    Notes
    -----
    Each pixel is a mean over two of its own widths and heights by a triangle, which is
    positive, so that the sun does not ring.
    """

    def __init__(self, width: int, height: int, max_width: int) -> None:
        self._width, self._height = width, height
        self.width = min(width, max_width)
        self.height = height if width <= max_width else max(1, round(height * max_width / width))
        self._first = 0
        self._waiting = np.empty((0, width, 3), np.float32)
        self._done: list[Pixels] = []
        self._rows_done = 0

    def add(self, rows: Pixels) -> None:
        """Take the next rows, shape (row, column, 3)."""
        if self.width == self._width:
            self._done.append(rows)
            return
        self._waiting = np.concatenate([self._waiting, rows])
        seen = self._first + len(self._waiting)
        ready = self._rows_done
        while ready < self.height and (seen == self._height or self._needed(ready)[1] <= seen):
            ready += 1
        if ready > self._rows_done:
            self._shrink(self._rows_done, ready)

    def result(self) -> Pixels:
        """Return the smaller picture, when all rows have arrived."""
        return np.concatenate(self._done)

    def _needed(self, row: int) -> tuple[int, int]:
        """First and last row, the latter excluded, that a row of the smaller picture is of."""
        scale = self._height / self.height
        reach = max(scale, 1.0)
        middle = (row + 0.5) * scale
        first = math.floor(middle - reach) - _MARGIN
        return max(0, first), min(self._height, math.ceil(middle + reach) + _MARGIN)

    def _shrink(self, first: int, last: int) -> None:
        """Make rows of the smaller picture, and keep the rows that later ones need."""
        source = _empty(self._width, self._height, self._first, len(self._waiting))
        # Without memory for its copy of them the library divides by zero, which ends the process.
        np.empty_like(self._waiting)
        source.set_pixels(source.roi, self._waiting)
        smaller = _empty(self.width, self.height, first, last - first)
        if not OpenImageIO.ImageBufAlgo.resize(
            smaller, source, filtername="triangle", roi=smaller.roi
        ):
            raise RuntimeError(f"resize must succeed, got {smaller.geterror()}")
        self._done.append(np.asarray(smaller.get_pixels(OpenImageIO.FLOAT), np.float32))
        self._rows_done = last
        kept = self._needed(last)[0] if last < self.height else self._height
        self._waiting = self._waiting[kept - self._first :].copy()
        self._first = kept


def shrunk(pixels: Pixels, max_width: int) -> Pixels:
    """Return a picture, shape (row, column, 3), averaged to at most a width."""
    height, width = pixels.shape[:2]
    shrinking = Shrinking(width, height, max_width)
    shrinking.add(pixels)
    return shrinking.result()


def _empty(width: int, height: int, first: int, rows: int) -> OpenImageIO.ImageBuf:
    """Return empty rows of a picture with their place in it."""
    spec = OpenImageIO.ImageSpec(width, rows, 3, "float")
    spec.y = first
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = 0, 0, width, height
    return OpenImageIO.ImageBuf(spec)
