"""OpenEXR maps with smaller and smaller copies of themselves, in tiles, as textures are read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.formats.exr import image_spec, stored_rows
from skybake.formats.exr_chunks import find_fault
from skybake.formats.spec import MapSpec
from skybake.formats.targets import faults_of, write_error
from skybake.formats.whole_files import WholeFiles
from skybake.jit.workers import ALL_CPUS, Workers

TILE = 64
"""Width and height of tiles. [pixel]"""

_MIPMAP_LEVELS, _ROUND_DOWN = 1, 0


def write_exr_mips(
    path: Path,
    levels: Sequence[npt.NDArray[np.float32]],
    spec: MapSpec,
    files: WholeFiles,
    workers: Workers = ALL_CPUS,
) -> None:
    """Write a map with its levels.

    Parameters
    ----------
    path : Path
        ``.exr``.
    levels : sequence of ndarray of float32, shape (row, column, 3)
        The largest first, each half as wide and high as the one before, rounded down, to one pixel.
    spec : MapSpec
        Of the largest.
    files : WholeFiles
        The set that the file is to appear with.
    workers : Workers, optional
        Threads that do the work.

    Raises
    ------
    InputError
        If the compression is one that has no tiles.
    OutputError
        If the file cannot be written, or a value does not fit its type.
    """
    temporary = files.add(path)
    _write_levels(path, temporary, levels, spec, workers)
    with faults_of(path):
        fault = find_fault(temporary)
    if fault is not None:
        raise write_error(path, temporary, fault)


def _write_levels(
    path: Path,
    temporary: Path,
    levels: Sequence[npt.NDArray[np.float32]],
    spec: MapSpec,
    workers: Workers,
) -> None:
    # OpenImageIO finishes a file of levels when the output is gone, not when it is closed.
    output = OpenImageIO.ImageOutput.create(str(temporary))
    if output is None:
        raise write_error(path, temporary, OpenImageIO.geterror())
    for number, level in enumerate(levels):
        rows = stored_rows(level, spec, path, workers)
        header = _level_spec(spec, level.shape[1], level.shape[0])
        mode = "AppendMIPLevel" if number else "Create"
        if not output.open(str(temporary), header, mode) or not output.write_image(rows):
            raise write_error(path, temporary, output.geterror())
    output.close()
    message = output.geterror()
    if message:
        raise write_error(path, temporary, message)


def _level_spec(spec: MapSpec, width: int, height: int) -> OpenImageIO.ImageSpec:
    header = image_spec(spec)
    header.width = header.full_width = width
    header.height = header.full_height = height
    header.tile_width = header.tile_height = TILE
    if spec.envmap is None:
        header["textureformat"] = "Plain Texture"
    header["openexr:levelmode"] = _MIPMAP_LEVELS
    header["openexr:roundingmode"] = _ROUND_DOWN
    return header
