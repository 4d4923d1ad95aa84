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
from skybake.image.settings import MapSettings
from skybake.jit.workers import ALL_CPUS, Workers


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
    projection = settings.view.projection
    levels = [
        mip_levels(one.pixels, projection, number) if settings.encoding.mips else [one.pixels]
        for number, one in enumerate(held)
    ]
    if is_cube_file(paths[0]):
        cube = [np.stack(faces) for faces in zip(*levels, strict=True)]
        held[0].clamped = write_cube(paths[0], cube, specs[0], files, workers)
        return
    for path, spec, each in zip(paths, specs, levels, strict=True):
        write_exr_mips(path, each, spec, files, workers)
