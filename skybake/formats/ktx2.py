"""KTX 2 files of cubemaps, for graphics processors.

References
----------
KTX File Format Specification 2.0, registry.khronos.org/KTX/specs/2.0/ktxspec.v2.html.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import BinaryIO

from skybake.formats.cube_levels import Level, check_levels
from skybake.formats.ktx2_container import INDEX_AT, beginning, compress, index_entry
from skybake.formats.spec import Attribute
from skybake.formats.targets import faults_of
from skybake.formats.texels import TexelFormat, encode_texels, find_texel_format
from skybake.formats.whole_files import WholeFiles
from skybake.jit.workers import ALL_CPUS, Workers


def write_ktx2(
    path: Path,
    levels: Sequence[Level],
    *,
    pixel: str = "half",
    zstd: bool = True,
    attributes: Mapping[str, Attribute] | None = None,
    files: WholeFiles | None = None,
    workers: Workers = ALL_CPUS,
) -> int:
    """Write a cubemap.

    Parameters
    ----------
    path : Path
        The file.
    levels : sequence of ndarray of float32, shape (6, n >> k, n >> k, 3)
        Linear RGB, the largest level first; faces in the order +X -X +Y -Y +Z -Z and the
        orientation in which they are to stand in the file, row 0 at the top.
    pixel : {"half", "float", "rgb9e5", "r11g11b10"}, optional
        How texels are stored.
    zstd : bool, optional
        Compress each level.
    attributes : mapping of str to Attribute, optional
        Key/value pairs, as text; `colorInteropID` decides the primaries too, which are
        unspecified without it.
    files : WholeFiles, optional
        The set that the file is to appear with; by default it appears at once.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    int
        Negative values that became 0 since the format has no sign.

    Raises
    ------
    InputError
        For an unknown `pixel`.
    OutputError
        If the file cannot be written, or a value does not fit its type.
    ValueError
        If the shapes of levels are others, or an attribute has a name that KTX reserves.
    """
    form, edge = find_texel_format(pixel), check_levels(levels)
    start = beginning(
        form,
        (edge, edge, 0),
        faces=6,
        levels=len(levels),
        zstd=zstd,
        attributes=dict(attributes or {}),
    )
    with ExitStack() as stack:
        if files is None:
            files = stack.enter_context(WholeFiles())
        temporary = files.add(path)
        with faults_of(path), temporary.open("wb") as file:
            file.write(start)
            index, negative = _write_levels(file, path, levels, form, zstd, workers)
            file.seek(INDEX_AT)
            file.write(index)
    return negative


def _write_levels(
    file: BinaryIO,
    path: Path,
    levels: Sequence[Level],
    form: TexelFormat,
    zstd: bool,
    workers: Workers,
) -> tuple[bytes, int]:
    """Write texels, the smallest level first; returns the index, of which the largest is first."""
    entries: list[bytes] = []
    negative = 0
    for level in reversed(levels):
        faces = []
        for face in level:
            texels, lost = encode_texels(face, form, path, workers)
            faces.append(texels.tobytes())
            negative += lost
        plain = b"".join(faces)
        stored = compress(plain) if zstd else plain
        if not zstd:
            file.write(bytes(-file.tell() % math.lcm(form.size, 4)))
        entries.insert(0, index_entry(file.tell(), len(stored), len(plain)))
        file.write(stored)
    return b"".join(entries), negative
