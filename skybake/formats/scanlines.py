"""Scanlines in and out of OpenImageIO, which reports errors in return values only."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.errors import OutputError
from skybake.formats.fork import end_threads_before_forks
from skybake.formats.targets import faults_of, write_error
from skybake.jit.workers import ALL_CPUS, Workers

Rows = npt.NDArray[np.float32] | npt.NDArray[np.float16]


end_threads_before_forks()


class ScanlineWriter:
    """An image file that is written from its first row to its last.

    Parameters
    ----------
    path : Path
        The target, for messages.
    temporary : Path
        The file to write.
    spec : ImageSpec
        Its header.

    Attributes
    ----------
    clamped : int
        Values so far that were changed because the format has no place for them.

    Raises
    ------
    OutputError
        Here and from each method, if the library refuses or cannot write.

    Notes
    -----
    After a failed write nothing more is written, since OpenEXR 3.5 would wait for ever.
    """

    def __init__(self, path: Path, temporary: Path, spec: OpenImageIO.ImageSpec) -> None:
        self.clamped = 0
        self._path = path
        self._temporary = temporary
        self._height: int = spec.height
        self._shape: tuple[int, int] = (spec.width, spec.nchannels)
        self._next_row = 0
        self._failed: OutputError | None = None
        output = OpenImageIO.ImageOutput.create(str(temporary))
        if output is None or not output.open(str(temporary), spec):
            source = OpenImageIO if output is None else output
            raise write_error(path, temporary, source.geterror())
        self._output = output

    def __enter__(self) -> Self:
        """Return itself; the file is open."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close, and if all went well check that the file is complete."""
        self._output.close()
        if kind is not None:
            return
        message = self._output.geterror()
        if message:
            raise write_error(self._path, self._temporary, message)
        if self._next_row != self._height:
            raise ValueError(f"rows must be written to {self._height}, got {self._next_row}")
        with faults_of(self._path):
            self.check_whole()

    def write_rows(self, y_begin: int, y_end: int, rows: Rows) -> None:
        """Write rows `y_begin` to `y_end`, the latter excluded, shape (row, column, channel)."""
        self.write_ready(y_begin, y_end, self.ready(rows))

    def ready(self, rows: Rows, _workers: Workers = ALL_CPUS) -> Rows:
        """Check rows and convert them to what the file holds, on any thread."""
        return rows

    def write_ready(self, y_begin: int, y_end: int, rows: Rows) -> None:
        """Write rows that `ready` returned."""
        if self._failed is not None:
            raise self._failed
        if rows.shape != (y_end - y_begin, *self._shape) or y_begin != self._next_row:
            raise ValueError(
                f"rows must follow row {self._next_row} with shape (rows, {self._shape[0]}, "
                f"{self._shape[1]}), got rows {y_begin} to {y_end} with shape {rows.shape}"
            )
        if not self._output.write_scanlines(y_begin, y_end, 0, np.ascontiguousarray(rows)):
            self._failed = write_error(self._path, self._temporary, self._output.geterror())
            raise self._failed
        self._next_row = y_end

    def check_whole(self) -> None:
        """Read the last row back: the write of the last block fails silently on a full disk."""
        source = OpenImageIO.ImageInput.open(str(self._temporary))
        if source is None:
            raise write_error(self._path, self._temporary, OpenImageIO.geterror())
        last = None
        with suppress(RuntimeError):
            last = source.read_scanlines(self._height - 1, self._height, 0, 0, self._shape[1])
        source.close()
        if last is None:
            raise write_error(self._path, self._temporary, source.geterror())
