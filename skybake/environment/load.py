"""Environments from files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from skybake.colour.space import ColourSpace, find_colour_space, luminance_weights
from skybake.environment.environment import Environment, Pixels
from skybake.environment.faces import TEMPLATE, face_files
from skybake.environment.tags import file_space, file_white, has_space
from skybake.errors import InputError
from skybake.formats.reader import ImageFile
from skybake.formats.spec import CAMERA
from skybake.projection import find_projection
from skybake.projection.chart import Projection, size_text
from skybake.projection.cubemap import Cubemap, parse_face_names
from skybake.projection.of_file import file_projection, file_recipe, sized

_SHAPES = "2:1, or a cube's cross, row or column, or be given by its projection"


def load_environment(
    path: Path | str,
    *,
    projection: Projection | str | None = None,
    rotation: float | None = None,
    space: ColourSpace | str | None = None,
    white_luminance: float | None = None,
) -> Environment:
    """Read a map of the light from all around.

    Parameters
    ----------
    path : Path or str
        An EXR or Radiance picture, ours or another, or one of integers; of a cubemap in six
        files any of them, or their name with ``{face}`` in place of the faces'. A sun that is a
        part of its own in a file of ours is added.
    projection : Projection or str, optional
        In which the map is, of any size, or its name; by default what its metadata or else its
        shape say.
    rotation : float, optional
        Compass bearing that its -Z looks to; by default what the metadata say, or 0. [rad]
    space : ColourSpace or str, optional
        Of the pixels, or its name; by default what tags say.
    white_luminance : float, optional
        Luminance that RGB (1, 1, 1) stands for; by default what tags say. [cd m⁻²]

    Returns
    -------
    Environment
        With a warning for each thing that may be wrong with the light in it: values below 0, and
        pictures that cannot hold the light of a sun.

    Raises
    ------
    InputError
        If a file is missing or damaged, holds NaN or infinity, or has no known layout, or if six
        faces differ in size.
    """
    path = Path(path)
    first = None if TEMPLATE in path.name else ImageFile(path, takes_integers=True)
    files = _files(path, first, projection)
    images = [
        first if first is not None and file == path else ImageFile(file, takes_integers=True)
        for file in files
    ]
    laid_out = _projection(files, images, projection)
    attributes = images[0].attributes
    known = find_colour_space(space) if isinstance(space, str) else space
    if known is None and CAMERA in attributes:
        raise InputError(
            f"{files[0]}: colours must be those of an eye, got a camera's ({attributes[CAMERA]})"
        )
    if known is None and has_space(attributes):
        known = file_space(files[0], attributes)
    pixels = tuple(
        _with_sun(file, np.concatenate(list(image.bands())), image.attributes)
        for file, image in zip(files, images, strict=True)
    )
    return Environment(
        pixels,
        laid_out,
        _rotation(attributes) if rotation is None else rotation,
        known,
        file_white(files[0], attributes) if white_luminance is None else white_luminance,
        attributes,
        tuple(_warnings(files, images, pixels, known)),
    )


def _with_sun(path: Path, pixels: Pixels, attributes: Mapping[str, Any]) -> Pixels:
    """Add the disc that a file of ours holds in a part of its own."""
    shown = file_recipe(attributes).get("map")
    if not isinstance(shown, dict) or shown.get("sun_disc") != "separate":
        return pixels
    total: Pixels = pixels + np.concatenate(list(ImageFile(path, part="sun").bands()))
    return total


def _files(path: Path, image: ImageFile | None, given: Projection | str | None) -> tuple[Path, ...]:
    if image is None:
        found = face_files(path)
        return found if found is not None else (path,)
    shown = file_recipe(image.attributes).get("map")
    says_faces = isinstance(shown, dict) and shown.get("cube_layout") == "faces"
    name = given.name if isinstance(given, Projection) else given
    if name not in {None, Cubemap.name} or image.width != image.height:
        return (path,)
    if isinstance(shown, dict) and not says_faces and given is None:
        return (path,)
    names = None
    if isinstance(shown, dict) and says_faces and isinstance(shown.get("face_names"), str):
        with suppress(InputError):
            names = parse_face_names(shown["face_names"])
    return face_files(path, names, is_face=says_faces or given is not None) or (path,)


def _projection(
    files: tuple[Path, ...], images: list[ImageFile], given: Projection | str | None
) -> Projection:
    width, height = images[0].width, images[0].height
    for file, image in zip(files, images, strict=True):
        if (image.width, image.height) != (width, height):
            raise InputError(
                f"{file}: all faces must be as large as {files[0].name}, {width}x{height}, "
                f"got {image.width}x{image.height}"
            )
    wanted = find_projection(given) if isinstance(given, str) else given
    found: Projection | None
    if len(files) > 1:
        if width != height:
            raise InputError(f"{files[0]}: faces must be square, got {size_text((width, height))}")
        shown = wanted or file_projection(images[0].attributes, width, height)
        base = shown if isinstance(shown, Cubemap) else Cubemap()
        found = replace(base, edge=width, layout="faces")
    elif wanted is not None:
        found = sized(_fitting(wanted, width, height), width, height)
    else:
        found = file_projection(images[0].attributes, width, height)
    if found is None:
        needs = _SHAPES if wanted is None else f"that of the projection {wanted.name}"
        raise InputError(f"{files[0]}: shape must be {needs}, got {size_text((width, height))}")
    return found


def _fitting(wanted: Projection, width: int, height: int) -> Projection:
    """Return a cubemap in the layout of a picture's shape, and other projections as they are."""
    if not isinstance(wanted, Cubemap):
        return wanted
    by_shape = file_projection({}, width, height)
    is_cube = isinstance(by_shape, Cubemap) and wanted.layout == "faces"
    return replace(wanted, layout=by_shape.layout) if is_cube else wanted  # type: ignore[union-attr]


def _rotation(attributes: Mapping[str, Any]) -> float:
    """Bearing of a map's -Z by the recipe of a file of ours; 0 of another. [rad]"""
    shown = file_recipe(attributes).get("map")
    degrees = shown.get("rotate_deg", 0.0) if isinstance(shown, dict) else 0.0
    is_number = isinstance(degrees, int | float) and math.isfinite(degrees)
    return math.radians(degrees) if is_number else 0.0


def _warnings(
    files: tuple[Path, ...],
    images: list[ImageFile],
    pictures: tuple[Pixels, ...],
    space: ColourSpace | None,
) -> list[str]:
    found = []
    if "spectralLayoutVersion" in images[0].attributes:
        found.append(f"{files[0]}: the spectrum is left out, and R, G and B are read")
    for file, image, pixels in zip(files, images, pictures, strict=True):
        count = _negative(pixels, space, is_ours=bool(file_recipe(image.attributes)))
        if count:
            found.append(
                f"{file}: {count} pixels are negative and take light away "
                f"(the least is {float(pixels.min()):g})"
            )
        if image.is_integer:
            found.append(
                f"{file}: a picture of integers holds no light beyond its white; that of a sun or "
                "a lamp is lost"
            )
        elif float(pixels.max()) == 1.0:
            found.append(
                f"{file}: values end at 1; light beyond it, as of a sun or a lamp, is lost"
            )
    return found


def _negative(pixels: Pixels, space: ColourSpace | None, *, is_ours: bool) -> int:
    """Count negative pixels; of ours only those of negative luminance.

    Colours of ours that are outside their space are negative in a channel.
    """
    if not float(pixels.min()) < 0.0:
        return 0
    if is_ours and space is not None:
        luminance = pixels @ luminance_weights(space).astype(np.float32)
        return int(np.count_nonzero(luminance < 0.0))
    return int(np.count_nonzero((pixels < 0.0).any(axis=-1)))
