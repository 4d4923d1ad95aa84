"""Pictures that are written when all of their rows are there: cubes in one file, and levels."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from skybake.baking.mips import mip_levels
from skybake.formats.cube_file import is_cube_file, write_cube
from skybake.formats.exr_mips import write_exr_mips
from skybake.formats.scanlines import Rows
from skybake.formats.spec import MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.image.layers import Pixels
from skybake.image.settings import MapSettings
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.projection.chart import Projection


class HeldRows:
    """Rows that are kept until all of a picture is there.

    Parameters
    ----------
    width, height : int
        Of the picture. [pixel]

    Attributes
    ----------
    pixels : ndarray of float32, shape (row, column, 3)
        What was written so far.
    clamped : int
        Values that were changed because the format has no place for them.
    """

    def __init__(self, width: int, height: int) -> None:
        self.pixels = np.zeros((height, width, 3), np.float32)
        self.clamped = 0

    def ready(self, rows: Rows, _workers: Workers = ALL_CPUS) -> Rows:
        """Return rows as they are."""
        return rows

    def write_ready(self, y_begin: int, y_end: int, rows: Rows) -> None:
        """Keep rows that `ready` returned."""
        self.pixels[y_begin:y_end] = rows


def write_held(
    held: Sequence[HeldRows],
    paths: Sequence[Path],
    specs: Sequence[MapSpec],
    settings: MapSettings,
    files: WholeFiles,
    workers: Workers,
) -> None:
    """Write the pictures of a map, and their smaller copies if the settings ask for them.

    Parameters
    ----------
    held : sequence of HeldRows
        The pictures.
    paths : sequence of Path
        One for each of them, or one for all faces of a cube.
    specs : sequence of MapSpec
        What the file of each picture holds besides.
    settings : MapSettings
        Of the map.
    files : WholeFiles
        The set that the files are to appear with.
    workers : Workers
        Threads that do the work.

    Raises
    ------
    InputError, OutputError
        As of `write_cube` and `write_exr_mips`.
    """
    projection, mips = settings.view.projection, settings.encoding.mips
    pictures = [one.pixels for one in held]
    held[0].clamped = write_whole(pictures, projection, paths, specs, files, workers, mips=mips)


def write_whole(
    pictures: Sequence[Pixels],
    projection: Projection,
    paths: Sequence[Path],
    specs: Sequence[MapSpec],
    files: WholeFiles,
    workers: Workers,
    *,
    mips: bool,
) -> int:
    """Write whole pictures, and their smaller copies if they are wanted.

    Parameters
    ----------
    pictures : sequence of ndarray of float32, shape (row, column, 3)
        Of a map.
    projection : Projection
        Where its pixels look.
    paths, specs, files, workers
        As of `write_held`.
    mips : bool
        Whether smaller copies are wanted.

    Returns
    -------
    int
        Negative values that became 0 since the type has no sign.
    """
    levels = [
        mip_levels(pixels, projection, number) if mips else [pixels]
        for number, pixels in enumerate(pictures)
    ]
    if is_cube_file(paths[0]):
        cube = [np.stack(faces) for faces in zip(*levels, strict=True)]
        return write_cube(paths[0], cube, specs[0], files, workers)
    for path, spec, each in zip(paths, specs, levels, strict=True):
        write_exr_mips(path, each, spec, files, workers)
    return 0
