"""The options of tables that engines look up: their mappings, sizes and camera, and their scale."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import choices, values
from skybake.commands.options.camera import (
    altitude_with,
    camera_from_file,
    camera_option,
    camera_units_option,
    camera_up_option,
)
from skybake.commands.options.rules import options_together
from skybake.commands.options.written import ev_option
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment
    from skybake.image.settings import MapSettings
    from skybake.luts.settings import TableSettings
    from skybake.projection.camera import Camera

ASPECT = 16.0 / 9.0
"""Width over height of the camera's picture, unless it is told."""

_SIZES = ("transmittance_size", "multiple_scattering_size", "sky_view_size", "aerial_size")


def _texels(text: str) -> tuple[int, ...]:
    if not re.fullmatch(r"\d{1,6}(x\d{1,6}){1,2}", text, re.ASCII):
        raise click.BadParameter(f"must be numbers of texels such as 192x108, got {text!r}")
    return tuple(int(number) for number in text.split("x"))


def _aspect(text: str) -> float:
    parts = text.split(":")
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2) or not all(0.0 < one < math.inf for one in numbers):
        raise click.BadParameter(f"must be such as 16:9 or 1.778, got {text!r}")
    return numbers[0] / (numbers[1] if len(numbers) > 1 else 1.0)


def _size_option(name: str, metavar: str, default: str, text: str) -> Any:
    return click.option(name, metavar=metavar, type=_texels, show_default=default, help=text)


table_options = options_together(
    click.option(
        "--parametrisation",
        type=click.Choice(choices.PARAMETRISATIONS),
        default="hillaire2020",
        show_default=True,
        help="How places and directions are spread over the tables.",
    ),
    _size_option("--transmittance-size", "WxH", "256x64", "Width and height of that table."),
    _size_option("--multiple-scattering-size", "WxH", "32x32", "Width and height of that table."),
    _size_option(
        *("--sky-view-size", "WxH", "192x108"),
        "Width and height of that table, whose lower half is below the horizon.",
    ),
    _size_option("--aerial-size", "WxHxD", "32x32x32", "Width, height and depth of the volume."),
    click.option(
        "--fov",
        metavar="ANGLE",
        type=values.field_of_view,
        show_default="60deg",
        help="Angle that the width of the volume's camera covers; in place of what --camera tells.",
    ),
    click.option(
        "--aspect",
        metavar="W:H",
        type=_aspect,
        show_default="16:9",
        help="Width over height of its picture, where --camera does not tell it.",
    ),
    click.option(
        "--look",
        metavar="AZIMUTH,ELEVATION",
        type=values.look,
        show_default="180,0",
        help="Where it looks.",
    ),
    camera_option,
    camera_units_option,
    camera_up_option,
    click.option(
        "--far",
        metavar="LENGTH",
        type=values.length,
        show_default="128km",
        help="Distance of the volume's far end.",
    ),
    click.option(
        "--colorspace",
        type=click.Choice(choices.COLOUR_SPACES),
        default="lin_rec709",
        show_default=True,
        help="Linear space of the colours.",
    ),
    click.option(
        "--units",
        type=click.Choice(choices.UNITS),
        show_default="ev15",
        help="What a radiance of 1 stands for: 1.2 * 2^15 cd/m2, or 1 cd/m2.",
    ),
    ev_option,
    click.option(
        "--pixel",
        type=click.Choice(choices.TABLE_PIXELS),
        default="float",
        show_default=True,
        help="Stored type.",
    ),
    click.option(
        "--method",
        type=click.Choice(choices.TABLE_METHODS),
        default="full",
        show_default=True,
        help="All orders of scattering with polarised light, or as if light were not polarised, or "
        "Hillaire's closure, in all tables.",
    ),
)


def table_camera(options: Mapping[str, Any]) -> Camera | None:
    """Return the camera of a file, if one is given.

    Raises
    ------
    click.UsageError, InputError
        As of `camera_from_file`.
    """
    if options["camera"] is None:
        return None
    path: Path = options["camera"]
    given = options["camera_units"], options["camera_up"], options["fov"]
    return camera_from_file(path, *given, options["aspect"] or _proportions(path))


def _proportions(path: Path) -> float:
    """Return the width over the height of the picture that a camera's file holds."""
    if path.suffix.lower() != ".exr":
        return ASPECT
    from skybake.formats.reader import open_image

    picture = open_image(path)
    spec = picture.spec()
    picture.close()
    return float(spec.full_width / max(spec.full_height, 1))


def table_settings(options: Mapping[str, Any], camera: Camera | None) -> TableSettings:
    """Return what the tables are like.

    Raises
    ------
    click.UsageError
        If a value is out of range.
    InputError
        If one of the camera's is.
    """
    from skybake.luts.settings import TableSettings

    own = ("fov", "aspect") if camera is None else ()
    names = (*_SIZES, "parametrisation", *own, "far", "pixel")
    given = {name: options[name] for name in names if options[name] is not None}
    if options["look"] is not None:
        given["azimuth"], given["elevation"] = options["look"]
    try:
        settings = TableSettings(**given)
    except InputError as error:
        where, colon, problem = str(error).partition(":")
        raise click.UsageError(f"--{where.replace(' ', '-')}{colon}{problem}") from error
    if camera is None:
        return settings
    try:
        return settings.seen_by(camera)
    except InputError as error:
        raise InputError(f"{options['camera']}: {error}") from error


def scene_settings(
    options: Mapping[str, Any], moment: Moment | None, camera: Camera | None
) -> MapSettings:
    """Return where observer and sun are, and what the numbers mean.

    Raises
    ------
    click.UsageError
        If a value is out of range.
    """
    from skybake.image import settings

    given = {name: options[name] for name in ("units", "ev") if options[name] is not None}
    altitude = options["altitude"] if camera is None else altitude_with(camera, options["altitude"])
    try:
        return settings.map_settings(
            sun_elevation=options["sun_elevation"] if moment is None else moment.sun_elevation,
            sun_azimuth=options["sun_azimuth"] if moment is None else moment.sun_azimuth,
            altitude=altitude,
            colorspace=options["colorspace"],
            method=options["method"],
            **given,
        )
    except InputError as error:
        raise click.UsageError(f"--{error}") from error
