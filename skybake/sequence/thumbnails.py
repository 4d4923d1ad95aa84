"""Thumbnails of frames on disk, since those of thousands would fill the memory."""

from __future__ import annotations

import errno
import math
import os
import weakref
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, overload

import numpy as np
import numpy.typing as npt

from skybake.errors import OutputError
from skybake.sequence.frame import FrameOutcome

Picture = npt.NDArray[np.uint8]


class Thumbnails:
    """Pictures of frames in an unnamed file, which is removed with the process.

    Parameters
    ----------
    folder : Path
        Folder of the file: that of the pictures that are made of them.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file: IO[bytes] | None = None
        self._places: dict[tuple[int, int], tuple[int, tuple[int, ...]]] = {}

    def keep(self, outcome: FrameOutcome) -> FrameOutcome:
        """Take the thumbnails of a frame, and return it without them.

        Raises
        ------
        OutputError
            If they cannot be written.
        """
        try:
            for width, picture in outcome.thumbnails.items():
                if self._file is None:
                    self._file = _open(self, self._folder)
                place = self._file.seek(0, 2)
                content = np.ascontiguousarray(picture).tobytes()
                if self._file.write(content) != len(content):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                self._places[outcome.number, width] = place, picture.shape
        except OSError as error:
            raise OutputError(
                f"{self._folder}: thumbnails must be writable, got {error.strerror or error}"
            ) from error
        return replace(outcome, thumbnails={})

    def pictures(self, width: int, numbers: Sequence[int]) -> Sequence[Picture]:
        """Return the thumbnails of some frames, each read when it is needed."""
        return _Pictures(self, width, numbers)

    def read(self, number: int, width: int) -> Picture:
        """Return the thumbnail of a frame."""
        place, shape = self._places[number, width]
        if self._file is None:
            raise KeyError(number)
        self._file.seek(place)
        content = self._file.read(math.prod(shape))
        return np.frombuffer(content, np.uint8).reshape(shape)


def _open(owner: Thumbnails, folder: Path) -> IO[bytes]:
    """Return an unnamed file in a folder, which is closed when its owner is deleted."""
    file = TemporaryFile(dir=folder, buffering=0)  # noqa: SIM115 - its owner keeps it open
    weakref.finalize(owner, file.close)
    return file


class _Pictures(Sequence[Picture]):
    """Thumbnails of one width, as a sequence."""

    def __init__(self, thumbnails: Thumbnails, width: int, numbers: Sequence[int]) -> None:
        self._thumbnails, self._width, self._numbers = thumbnails, width, numbers

    def __len__(self) -> int:
        return len(self._numbers)

    @overload
    def __getitem__(self, index: int) -> Picture: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Picture]: ...
    def __getitem__(self, index: int | slice) -> Picture | Sequence[Picture]:
        if isinstance(index, slice):
            return _Pictures(self._thumbnails, self._width, self._numbers[index])
        return self._thumbnails.read(self._numbers[index], self._width)

    def __iter__(self) -> Iterator[Picture]:
        for number in self._numbers:
            yield self._thumbnails.read(number, self._width)
