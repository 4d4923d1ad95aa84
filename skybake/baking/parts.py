"""Maps whose sky, clouds and sun are parts of one file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from skybake.baking.pictures import Picture
from skybake.baking.pixel_type import fitting_pixel, value_range
from skybake.errors import InputError
from skybake.formats.exr_parts import PartsWriter
from skybake.formats.spec import MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.image.parts import band_parts, part_channels
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings

_LOSSY = ("b44", "b44a", "dwaa", "dwab")
_LOSSLESS = "zip"


def check_parts(path: Path, settings: MapSettings) -> None:
    """Refuse parts that a file cannot have, or that a map has not.

    Raises
    ------
    InputError
        Unless the file is an OpenEXR file without smaller copies, and the map holds the sky.
    """
    lighting, encoding = settings.lighting, settings.encoding
    what = "a separate disc" if lighting.sun_disc == "separate" else "layers"
    if path.suffix.lower() != ".exr":
        raise InputError(f"{path}: {what} must be in .exr")
    if encoding.mips:
        raise InputError(f"{path}: {what} must be without mips")
    if lighting.sun_disc == "only":
        raise InputError(f"{path}: layers must be of a map with the sky, got only the disc")
    if settings.night.stars == "only":
        raise InputError(f"{path}: layers must be of a map with the sky, got only stars")


@contextmanager
def open_parts(
    scene: Scene,
    names: Sequence[str],
    rasters: Sequence[Raster],
    paths: Sequence[Path],
    spec: Callable[[Raster], MapSpec],
    files: WholeFiles,
) -> Iterator[list[Picture]]:
    """Open files of several parts, see `skybake.baking.pictures.open_pictures`.

    Parameters
    ----------
    scene : Scene
        What the map shows.
    names : sequence of str
        The parts, see `skybake.image.parts.part_names`.
    rasters, paths, spec, files
        As of `open_pictures`.
    """
    pixels = _part_pixels(scene)
    with ExitStack() as stack:
        pictures = []
        for raster, path in zip(rasters, paths, strict=True):
            whole = spec(raster)
            specs = {name: _part_spec(name, whole, pixels) for name in names}
            writer = stack.enter_context(PartsWriter(path, files.add(path), specs))
            rows = partial(band_parts, raster, scene)
            pictures.append(Picture(raster.canvas.height, rows, writer))
        yield pictures


def _part_spec(name: str, whole: MapSpec, pixels: dict[str, str]) -> MapSpec:
    compression = whole.compression
    # Ringing around the disc would fill its blocks, and that of a transmittance exceed 1.
    is_sharp = name in {"sun", "moon", "stars", "transmittance"}
    if is_sharp and compression.partition(":")[0] in _LOSSY:
        compression = _LOSSLESS
    return replace(
        whole,
        pixel=pixels.get(name, whole.pixel),
        channels=part_channels(name),
        compression=compression,
    )


def _part_pixels(scene: Scene) -> dict[str, str]:
    """Return the types of parts; the beauty has that of the map."""
    wanted = scene.settings.encoding.pixel
    largest, smallest = value_range(scene, 0.0)
    toward_sun = scene.evaluate_clear(np.array([[scene.sun_zenith]]), np.zeros((1, 1)), 1e-9)
    sky = fitting_pixel(wanted, max(largest, 1.1 * float(np.abs(toward_sun).max())), smallest)
    return {
        "sky": sky,
        "clouds": sky,
        **dict.fromkeys(("sun", "moon", "stars"), "float" if wanted == "auto" else wanted),
        "transmittance": "half" if wanted == "auto" else wanted,
    }
