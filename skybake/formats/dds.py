"""DDS files of cubemaps, for Direct3D.

References
----------
learn.microsoft.com/windows/win32/direct3ddds: dds-header, dds-header-dxt10,
dds-file-layout-for-cubic-environment-maps.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from skybake.formats.cube_levels import Level, check_levels
from skybake.formats.targets import faults_of
from skybake.formats.texels import TEXEL_FORMATS, TexelFormat, encode_texels
from skybake.formats.whole_files import WholeFiles
from skybake.jit.workers import ALL_CPUS, Workers

# Flags of what the header holds: sizes and format, the bytes of a row, the number of levels.
_CAPS_HEIGHT_WIDTH_FORMAT, _PITCH, _LEVEL_COUNT = 0x1007, 0x8, 0x20000
_TEXTURE, _COMPLEX, _MIPMAP = 0x1000, 0x8, 0x400000
_CUBEMAP_OF_SIX_FACES = 0xFE00
_FOUR_LETTERS = 0x4
_DXGI_FORMATS = {"half": 10, "float": 2}
_TEXTURE_2D, _TEXTURE_CUBE, _ONE_CUBE = 3, 0x4, 1


def write_dds(
    path: Path,
    levels: Sequence[Level],
    *,
    pixel: str = "half",
    files: WholeFiles | None = None,
    workers: Workers = ALL_CPUS,
) -> None:
    """Write a cubemap.

    Parameters
    ----------
    path : Path
        The file.
    levels : sequence of ndarray of float32, shape (6, n >> k, n >> k, 3)
        Linear RGB, the largest level first; faces in the order +X -X +Y -Y +Z -Z and the
        orientation in which they are to stand in the file, row 0 at the top.
    pixel : {"half", "float"}, optional
        How texels are stored, as R16G16B16A16 or R32G32B32A32.
    files : WholeFiles, optional
        The set that the file is to appear with; by default it appears at once.
    workers : Workers, optional
        Threads that do the work.

    Raises
    ------
    OutputError
        If the file cannot be written, or a value does not fit its type.
    ValueError
        If the shapes of levels are others, or the format does not have the type.
    """
    if pixel not in _DXGI_FORMATS:
        raise ValueError(f"pixel must be one of {', '.join(_DXGI_FORMATS)}, got {pixel!r}")
    edge, form = check_levels(levels), TEXEL_FORMATS[pixel]
    with ExitStack() as stack:
        if files is None:
            files = stack.enter_context(WholeFiles())
        temporary = files.add(path)
        with faults_of(path), temporary.open("wb") as file:
            file.write(_header(edge, form, len(levels)))
            for face in range(6):
                for level in levels:
                    file.write(encode_texels(level[face], form, path, workers)[0].tobytes())


def _header(edge: int, form: TexelFormat, levels: int) -> bytes:
    flags = _CAPS_HEIGHT_WIDTH_FORMAT | _PITCH | (_LEVEL_COUNT if levels > 1 else 0)
    caps = _TEXTURE | _COMPLEX | (_MIPMAP if levels > 1 else 0)
    return b"".join(
        (
            struct.pack("<4s7I", b"DDS ", 124, flags, edge, edge, edge * form.size, 0, levels),
            bytes(44),
            struct.pack("<2I4s5I", 32, _FOUR_LETTERS, b"DX10", 0, 0, 0, 0, 0),
            struct.pack("<5I", caps, _CUBEMAP_OF_SIX_FACES, 0, 0, 0),
            struct.pack("<5I", _DXGI_FORMATS[form.name], _TEXTURE_2D, _TEXTURE_CUBE, _ONE_CUBE, 0),
        )
    )
