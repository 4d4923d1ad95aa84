"""The pictures that make up a map, each with what its rows show and what writes them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from skybake.formats.cube_file import is_cube_file
from skybake.formats.spec import MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.formats.writer import RowWriter, open_maps
from skybake.image.layers import Pixels
from skybake.image.raster import Raster
from skybake.image.settings import MapSettings
from skybake.jit.workers import Workers


class Picture(NamedTuple):
    """A picture of a map that is being written.

    Attributes
    ----------
    height : int
        Its rows.
    rows : callable
        Returns the pixels of rows first..last.
    writer : RowWriter
        What they are written with.
    """

    height: int
    rows: Callable[[int, int], Pixels]
    writer: RowWriter


@contextmanager
def open_pictures(
    rasters: Sequence[Raster],
    paths: Sequence[Path],
    spec: Callable[[Raster], MapSpec],
    settings: MapSettings,
    files: WholeFiles,
    workers: Workers,
) -> Iterator[list[Picture]]:
    """Open the files of a map for rows from top to bottom.

    Parameters
    ----------
    rasters : sequence of Raster
        What the map shows, a picture each.
    paths : sequence of Path
        Its files: one for each picture, or one for all.
    spec : callable
        Returns what the file of a picture holds besides.
    settings : MapSettings
        Of the map.
    files : WholeFiles
        The set that they are to appear with.
    workers : Workers
        Threads that do the work.

    Yields
    ------
    list of Picture
        In the order of `rasters`; when the block ends all rows must have been written.

    Raises
    ------
    InputError, OutputError
        As `skybake.formats.writer.open_maps`.
    """
    if is_cube_file(paths[0]) or settings.encoding.mips:
        from skybake.baking.held_pictures import HeldRows, write_held

        held = [HeldRows(raster.canvas.width, raster.canvas.height) for raster in rasters]
        yield [_picture(raster, one) for raster, one in zip(rasters, held, strict=True)]
        specs = [spec(raster) for raster in rasters]
        write_held(held, paths, specs, settings, files, workers)
        return
    each = {path: spec(raster) for path, raster in zip(paths, rasters, strict=True)}
    with open_maps(each, files) as writers:
        yield [_picture(raster, writers[path]) for raster, path in zip(rasters, each, strict=True)]


def _picture(raster: Raster, writer: RowWriter) -> Picture:
    return Picture(raster.canvas.height, raster.rows, writer)
