"""OpenEXR files of several parts, each a picture of its own with its own channels and type."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import OpenImageIO

from skybake.formats.exr import image_spec, stored_rows
from skybake.formats.exr_chunks import find_fault
from skybake.formats.fork import end_threads_before_forks
from skybake.formats.scanlines import Rows
from skybake.formats.spec import MapSpec
from skybake.formats.targets import faults_of, write_error
from skybake.jit.workers import ALL_CPUS, Workers

end_threads_before_forks()


class PartsWriter:
    """Writes the parts of a file side by side, from their first rows to their last.

    The library writes one part after another, so all but the first are held in memory, as they
    are stored.

    Parameters
    ----------
    path, temporary : Path
        The target, for messages, and the file to write.
    specs : mapping of str to MapSpec
        What each part holds, by its name, in the order of the file. All are of one size.

    Attributes
    ----------
    clamped : int
        0: the format has a sign.

    Raises
    ------
    OutputError
        Here and from each method, if the library refuses or cannot write, or a value does not fit
        its type.
    """

    clamped: int = 0

    def __init__(self, path: Path, temporary: Path, specs: Mapping[str, MapSpec]) -> None:
        self._path, self._temporary = path, temporary
        self._specs = tuple(specs.values())
        self._headers = [_part_spec(name, spec) for name, spec in specs.items()]
        self._held: list[list[Rows]] = [[] for _ in self._specs]
        self._next_row = 0
        self._output: Any = OpenImageIO.ImageOutput.create(str(temporary))
        if self._output is None:
            raise write_error(path, temporary, OpenImageIO.geterror())
        self._check(self._output.open(str(temporary), self._headers))

    def __enter__(self) -> Self:
        """Return itself; the file is open."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Write the other parts and close, and if all went well check that the file is complete."""
        if kind is None:
            self._write_held()
        self._output.close()
        if kind is not None:
            return
        self._check(not self._output.has_error)
        with faults_of(self._path):
            fault = find_fault(self._temporary)
        if fault is not None:
            raise write_error(self._path, self._temporary, fault)

    def ready(self, parts: Sequence[Rows], workers: Workers = ALL_CPUS) -> tuple[Rows, ...]:
        """Check rows of all parts and convert them to what the file holds, on any thread."""
        return tuple(
            stored_rows(rows, spec, self._path, workers)
            for rows, spec in zip(parts, self._specs, strict=True)
        )

    def write_ready(self, y_begin: int, y_end: int, parts: Sequence[Rows]) -> None:
        """Write rows that `ready` returned, those from `y_begin` up to `y_end`."""
        first, *others = parts
        if y_begin != self._next_row or len(first) != y_end - y_begin:
            raise ValueError(f"rows must follow row {self._next_row}, got {y_begin} to {y_end}")
        self._check(self._output.write_scanlines(y_begin, y_end, 0, np.ascontiguousarray(first)))
        for held, rows in zip(self._held[1:], others, strict=True):
            held.append(rows)
        self._next_row = y_end

    def _write_held(self) -> None:
        if self._next_row != self._specs[0].height:
            raise ValueError(
                f"rows must be written to {self._specs[0].height}, got {self._next_row}"
            )
        for header, bands in zip(self._headers[1:], self._held[1:], strict=True):
            self._check(self._output.open(str(self._temporary), header, "AppendSubimage"))
            row = 0
            for rows in bands:
                whole = np.ascontiguousarray(rows)
                self._check(self._output.write_scanlines(row, row + len(rows), 0, whole))
                row += len(rows)
            bands.clear()

    def _check(self, is_done: bool) -> None:
        if not is_done:
            raise write_error(self._path, self._temporary, self._output.geterror())


def _part_spec(name: str, spec: MapSpec) -> OpenImageIO.ImageSpec:
    header = image_spec(spec)
    header["oiio:subimagename"] = name
    if "A" in spec.channels:
        header.alpha_channel = spec.channels.index("A")
    return header
