"""Writes the picture of directions as a map would be written."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.angles import direction_from_angles
from skybake.baking.checks import check_targets
from skybake.baking.held_pictures import HeldRows, write_held
from skybake.baking.paths import map_paths
from skybake.baking.pixel_type import fitting_pixel
from skybake.colour.exposure import luminance_from_ev
from skybake.formats.cube_file import is_cube_file
from skybake.formats.spec import Attribute, MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.formats.writer import open_maps
from skybake.image.orientation import Orientation
from skybake.image.recipe import target_attributes
from skybake.image.settings import MapSettings
from skybake.jit.workers import ALL_CPUS
from skybake.projection.chart import Canvas

CHART_LUMINANCE = luminance_from_ev(15.0)
"""Luminance of the brightest colour, whatever the scale of the file. [cd m⁻²]"""

_BAND_ROWS = 128


def bake_orientation_chart(
    output: Path | str, settings: MapSettings, *, is_lettered: bool = True
) -> tuple[Path, ...]:
    """Write a picture of directions by the projection and the writer of a map.

    Parameters
    ----------
    output : Path or str
        As of `skybake.baking.bake`.
    settings : MapSettings
        Of the map whose place it takes.
    is_lettered : bool, optional
        Draw points of the compass, axes and the sun; without, the pixels hold
        1/2 + d / 2 of the direction d and nothing else, see `Orientation`.

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    SkybakeError
        If a setting or the target cannot be used; no file is left then.
    """
    output = Path(output)
    check_targets(output, settings)
    paths, canvases = map_paths(output, settings), settings.view.projection.canvases()
    brightest = np.float32(CHART_LUMINANCE / settings.encoding.white_luminance)
    picture = Orientation(settings, is_lettered=is_lettered)
    pictures = [_pixels(picture, canvas) * brightest for canvas in canvases]
    specs = [_spec(settings, canvas, float(brightest)) for canvas in canvases]
    with WholeFiles() as files:
        if is_cube_file(output) or settings.encoding.mips:
            held = [_held(pixels) for pixels in pictures]
            write_held(held, paths, specs, settings, files, ALL_CPUS)
            return paths
        with open_maps(dict(zip(paths, specs, strict=True)), files) as writers:
            for path, pixels in zip(paths, pictures, strict=True):
                for first, last in _bands(len(pixels)):
                    writers[path].write_rows(first, last, pixels[first:last])
    return paths


def _held(pixels: npt.NDArray[np.float32]) -> HeldRows:
    height, width = pixels.shape[:2]
    held = HeldRows(width, height)
    held.write_ready(0, height, pixels)
    return held


def _spec(settings: MapSettings, canvas: Canvas, brightest: float) -> MapSpec:
    encoding = settings.encoding
    return MapSpec(
        canvas.width,
        canvas.height,
        encoding.space,
        encoding.white_luminance,
        pixel=fitting_pixel(encoding.pixel, brightest, brightest),
        compression=encoding.compression,
        envmap=canvas.envmap,
        states_exposure=not encoding.omit_exposure,
        attributes=_attributes(settings),
    )


def _pixels(picture: Orientation, canvas: Canvas) -> npt.NDArray[np.float32]:
    """Return a canvas filled, shape (row, column, 3)."""
    pixels = np.zeros((canvas.height, canvas.width, 3), np.float32)
    for part in canvas.parts:
        chart = part.chart
        place = pixels[part.row : part.row + chart.height, part.column : part.column + chart.width]
        if part.flip in {"rows", "both"}:
            place = place[::-1]
        if part.flip in {"columns", "both"}:
            place = place[:, ::-1]
        for first, last in _bands(chart.height):
            place[first:last] = picture.rows(chart, first, last)
    return pixels


def _bands(height: int) -> Iterator[tuple[int, int]]:
    for first in range(0, height, _BAND_ROWS):
        yield first, min(first + _BAND_ROWS, height)


def _attributes(settings: MapSettings) -> dict[str, Attribute]:
    lighting, rotation = settings.lighting, settings.view.rotation
    toward_sun = direction_from_angles(lighting.sun_azimuth - rotation, lighting.sun_elevation)
    return {
        "skybake:chart": "orientation",
        "skybake:recipe": json.dumps({"map": settings.recipe()}),
        "skybake:sunDirection": tuple(toward_sun.tolist()),
        **target_attributes(settings),
    }
