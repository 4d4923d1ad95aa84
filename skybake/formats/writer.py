"""One way to write a map, whichever format its name asks for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, Protocol

from skybake.errors import InputError
from skybake.formats.cube_file import CUBE_SUFFIXES
from skybake.formats.exr import ExrWriter
from skybake.formats.hdr import HdrWriter
from skybake.formats.spec import MapSpec
from skybake.formats.targets import check_target
from skybake.formats.whole_files import WholeFiles
from skybake.jit.workers import Workers

MapWriter = ExrWriter | HdrWriter


class RowWriter(Protocol):
    """What takes the rows of a picture from top to bottom.

    Attributes
    ----------
    clamped : int
        Values so far that were changed because the format has no place for them.
    """

    clamped: int

    def ready(self, rows: Any, workers: Workers, /) -> Any:
        """Check rows, or those of each part, and convert them to what the file holds.

        It is called on any thread.
        """

    def write_ready(self, y_begin: int, y_end: int, rows: Any, /) -> None:
        """Write rows that `ready` returned, those from `y_begin` up to `y_end`."""


_WRITERS: dict[str, type[ExrWriter] | type[HdrWriter]] = {".exr": ExrWriter, ".hdr": HdrWriter}


@contextmanager
def open_map(path: Path, spec: MapSpec) -> Iterator[MapWriter]:
    """Open a map file for rows from top to bottom; it appears when all are written.

    Parameters
    ----------
    path : Path
        ``.exr`` or ``.hdr``.
    spec : MapSpec
        What the file holds besides its pixels.

    Yields
    ------
    MapWriter
        With ``write_rows(y_begin, y_end, rows)``, float32 or float16, or its halves `ready`
        and `write_ready`, and `clamped`.
        Calls release the interpreter's lock, so that rows can be computed meanwhile;
        bands of 256 rows keep every compression's threads busy.

    Raises
    ------
    InputError
        If the suffix or the spec describes something that cannot be written.
    OutputError
        If the file cannot be written completely; the target is then as it was before.
    """
    with open_maps({path: spec}) as writers:
        yield writers[path]


@contextmanager
def open_maps(
    specs: Mapping[Path, MapSpec], files: WholeFiles | None = None
) -> Iterator[dict[Path, MapWriter]]:
    """Open several map files, which appear when all of them are written.

    Parameters
    ----------
    specs : mapping of Path to MapSpec
        The files, see `open_map`.
    files : WholeFiles, optional
        The set that they are to appear with, and when; by default they appear when the
        block ends.

    Yields
    ------
    dict of Path to MapWriter
        In the same order.

    Raises
    ------
    InputError, OutputError
        As `open_map`; all targets are then as they were before.
    """
    for path in specs:
        check_map_path(path)
    with ExitStack() as stack:
        whole_files = stack.enter_context(WholeFiles()) if files is None else files
        # Left in reverse: every file is closed and checked before the first takes its name.
        writers: dict[Path, MapWriter] = {}
        for path, spec in specs.items():
            temporary = whole_files.add(path)
            writer: MapWriter = _WRITERS[path.suffix.lower()](path, temporary, spec)
            writers[path] = writer
            stack.enter_context(writer)
        yield writers


def check_map_path(path: Path) -> None:
    """Raise the errors of a map's path that can be found before anything is computed.

    Raises
    ------
    InputError
        If the suffix names no format.
    OutputError
        If a file cannot be written under that name.
    """
    known = (*_WRITERS, *CUBE_SUFFIXES)
    if path.suffix.lower() not in known:
        raise InputError(f"{path}: suffix must be one of {', '.join(known)}, got {path.suffix!r}")
    check_target(path)
