"""One way to write a map, whichever format its name asks for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from skybake.errors import InputError
from skybake.formats.exr import ExrWriter
from skybake.formats.hdr import HdrWriter
from skybake.formats.partial import replace_when_whole
from skybake.formats.spec import MapSpec

MapWriter = ExrWriter | HdrWriter

_WRITERS: dict[str, type[ExrWriter] | type[HdrWriter]] = {".exr": ExrWriter, ".hdr": HdrWriter}


@contextmanager
def open_map(path: Path, spec: MapSpec) -> Iterator[MapWriter]:
    """Open a map file for rows from top to bottom; it appears when all are written.

    Parameters
    ----------
    path : Path
        ``.exr`` or ``.hdr``.
    spec : MapSpec
        What the file holds beside its pixels.

    Yields
    ------
    MapWriter
        With ``write_rows(y_begin, y_end, rows)``, float32 or float16, and `clamped`.
        Calls hold no lock of the interpreter, so that rows can be computed meanwhile;
        bands of 256 rows keep every compression's threads busy.

    Raises
    ------
    InputError
        If the suffix or the spec asks for something that cannot be written.
    OutputError
        If the file cannot be written whole; the target is then as it was before.
    """
    writer = _WRITERS.get(path.suffix.lower())
    if writer is None:
        raise InputError(f"{path}: suffix must be one of .exr, .hdr, got {path.suffix!r}")
    with replace_when_whole(path) as temporary, writer(path, temporary, spec) as opened:
        yield opened
