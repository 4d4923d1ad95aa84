"""The pictures that make up a map, each with what its rows show and what writes them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from skybake.baking.losses import HalfLoss
from skybake.formats.cube_file import is_cube_file
from skybake.formats.spec import MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.formats.writer import RowWriter, open_maps
from skybake.image.layers import Pixels
from skybake.image.parts import part_names
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.jit.workers import Workers

BAND_ROWS = 128

Band = Pixels | tuple[Pixels, ...]


class Picture(NamedTuple):
    """A picture of a map that is being written.

    Attributes
    ----------
    height : int
        Its rows.
    rows : callable
        Returns the pixels of rows first..last, or those of each part of the file.
    writer : RowWriter
        What they are written with.
    """

    height: int
    rows: Callable[[int, int], Band]
    writer: RowWriter


@contextmanager
def open_pictures(
    scene: Scene,
    rasters: Sequence[Raster],
    paths: Sequence[Path],
    spec: Callable[[Raster], MapSpec],
    files: WholeFiles,
) -> Iterator[list[Picture]]:
    """Open the files of a map for rows from top to bottom.

    Parameters
    ----------
    scene : Scene
        What the map shows.
    rasters : sequence of Raster
        Its pictures.
    paths : sequence of Path
        Its files: one for each picture, or one for all.
    spec : callable
        Returns what the file of a picture holds besides.
    files : WholeFiles
        The set that they are to appear with.

    Yields
    ------
    list of Picture
        In the order of `rasters`; when the block ends all rows must have been written.

    Raises
    ------
    InputError, OutputError
        As `skybake.formats.writer.open_maps`.
    """
    settings = scene.settings
    if is_cube_file(paths[0]) or settings.encoding.mips:
        from skybake.baking.held_pictures import HeldRows, write_held

        held = [HeldRows(raster.canvas.width, raster.canvas.height) for raster in rasters]
        yield [_picture(raster, one) for raster, one in zip(rasters, held, strict=True)]
        specs = [spec(raster) for raster in rasters]
        write_held(held, paths, specs, settings, files, scene.workers)
        return
    names = part_names(scene)
    if len(names) > 1:
        from skybake.baking.parts import open_parts

        with open_parts(scene, names, rasters, paths, spec, files) as pictures:
            yield pictures
        return
    each = {path: spec(raster) for path, raster in zip(paths, rasters, strict=True)}
    with open_maps(each, files) as writers:
        yield [_picture(raster, writers[path]) for raster, path in zip(rasters, each, strict=True)]


def kept_picture(picture: Picture, width: int) -> tuple[Picture, Pixels]:
    """Return the same picture, and where its rows are kept as they are computed, RGB."""
    kept = np.empty((picture.height, width, 3), np.float32)

    def rows(first: int, last: int) -> Band:
        band = picture.rows(first, last)
        kept[first:last] = band[0] if isinstance(band, tuple) else band[..., :3]
        return band

    return picture._replace(rows=rows), kept


def write_pictures(
    pictures: Sequence[Picture],
    workers: Workers,
    progress: Callable[[float], None] | None,
    loss: HalfLoss | None,
) -> None:
    """Write pictures band after band, each of which is computed while the last is written.

    Parameters
    ----------
    pictures : sequence of Picture
        Of `open_pictures`.
    workers : Workers
        Threads that do the work.
    progress : callable or None
        Called with the share that is done, from 0 to 1.
    loss : HalfLoss or None
        Counts what files lose of the values.
    """
    bands = [
        (picture, first, min(first + BAND_ROWS, picture.height))
        for picture in pictures
        for first in range(0, picture.height, BAND_ROWS)
    ]

    def compute(band: tuple[Picture, int, int]) -> Any:
        picture, first, last = band
        rows = picture.rows(first, last)
        if loss is not None:
            loss.add(rows[0] if isinstance(rows, tuple) else rows)
        return picture.writer.ready(rows, workers)

    computed = workers.ahead(compute, bands)
    for i, ((picture, first, last), rows) in enumerate(zip(bands, computed, strict=True)):
        picture.writer.write_ready(first, last, rows)
        if progress is not None:
            progress((i + 1) / len(bands))


def _picture(raster: Raster, writer: RowWriter) -> Picture:
    return Picture(raster.canvas.height, raster.rows, writer)
