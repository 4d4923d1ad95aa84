"""The options of every command that bakes maps: what kind, and how it is stored."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import values
from skybake.commands.options.rules import Needs, options_together
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.image.settings import MapSettings

_SHAPES = {"cube_layout": "layout", "equirect_rows": "rows", "fov": "fov"}
_ENCODINGS = (
    *("colorspace", "units", "ev", "pixel", "compression", "clamp_negative"),
    *("omit_exposure", "sun_disc", "sun_size", "sun_soft", "sun_strength", "method"),
)

map_options = options_together(
    click.option(
        "--projection",
        type=click.Choice(values.PROJECTIONS),
        default="equirect",
        show_default=True,
        help="Kind of map; fisheye is equidistant, perspective a camera's picture, angular a light "
        "probe.",
    ),
    click.option(
        "--size",
        metavar="WxH|EDGE",
        type=values.size,
        show_default="2048x1024 for equirect, 1920x1080 for perspective, 1024 for others",
        help="Width and height, 2:1 for an equirect map, whose width is enough, or edge of a "
        "cubemap's face or of a square map.",
    ),
    click.option(
        "--fov",
        metavar="ANGLE",
        type=values.field_of_view,
        show_default="180deg for a fisheye, 50deg for perspective",
        help="Angle that the width of a fisheye or perspective picture covers.",
    ),
    click.option(
        "--look",
        metavar="AZIMUTH,ELEVATION",
        type=values.look,
        show_default="180,90 for a fisheye, 180,0 for perspective",
        help="Where the middle of such a picture looks.",
    ),
    click.option(
        "--cube-layout",
        type=click.Choice(values.CUBE_LAYOUTS),
        show_default="faces",
        help="Six files px nx py ny pz nz, one horizontal or vertical cross, or one OpenEXR cube.",
    ),
    click.option(
        "--equirect-rows",
        type=click.Choice(values.EQUIRECT_ROWS),
        show_default="centres",
        help="Where the first and the last row look: half a row beside the zenith and the nadir, "
        "or at them, as Mitsuba and OpenEXR's programs read a map.",
    ),
    click.option(
        "--rotate",
        metavar="ANGLE",
        type=values.bearing,
        show_default="0deg",
        help="Compass bearing of the map's -Z, instead of north; the middle of an equirect map "
        "is opposite.",
    ),
    click.option(
        "--colorspace",
        type=click.Choice(values.COLOUR_SPACES),
        default="lin_rec709",
        show_default=True,
        help="Linear, scene-referred space of the pixels.",
    ),
    click.option(
        "--units",
        type=click.Choice(values.UNITS),
        show_default="ev15",
        help="What a pixel value of 1 stands for: 1.2 * 2^15 cd/m2, or 1 cd/m2.",
    ),
    click.option(
        "--ev",
        metavar="N",
        type=float,
        help="Let a pixel value of 1 stand for 1.2 * 2^N cd/m2 instead.",
    ),
    click.option(
        "--pixel",
        type=click.Choice(values.PIXELS),
        show_default="auto",
        help="Stored type of an EXR; auto takes half where it holds every value.",
    ),
    click.option(
        "--compression",
        metavar="NAME[:LEVEL]",
        show_default="zip",
        help="Of an EXR: none, rle, zips, zip[:1-9], piz, pxr24, b44, b44a, dwaa[:0-135], ...",
    ),
    click.option("--clamp-negative", is_flag=True, help="Set negative values (out of gamut) to 0."),
    click.option(
        "--omit-exposure",
        is_flag=True,
        help="Leave the line EXPOSURE out of a .hdr, for programs that divide by it.",
    ),
    click.option(
        "--sun-disc",
        type=click.Choice(values.SUN_DISCS),
        default="include",
        show_default=True,
        help="Whether the map holds the sun's disc, or nothing else.",
    ),
    click.option(
        "--sun-size",
        metavar="ANGLE",
        type=values.disc_diameter,
        show_default="the sun's own",
        help="Diameter of the disc, which keeps its light.",
    ),
    click.option(
        "--sun-soft",
        is_flag=True,
        help="Give the disc no edge and, without --sun-size, a size at which it fits half floats.",
    ),
    click.option(
        "--sun-strength",
        metavar="FACTOR",
        type=values.strength,
        show_default="1",
        help="Multiply the light of the disc, not of the sky.",
    ),
    click.option(
        "--method",
        type=click.Choice(values.METHODS),
        default="full",
        show_default=True,
        help="Light transport: all orders of scattering, Hillaire's closure, or, as a check, "
        "single scattering by direct quadrature.",
    ),
)


def map_needs(options: Mapping[str, Any]) -> Needs:
    """Return what `map_options` need to have an effect, besides ``--output``.

    Raises
    ------
    click.UsageError
        If the format of the output cannot hold the map.
    """
    is_radiance = options["output"] is not None and options["output"].suffix.lower() == ".hdr"
    if is_radiance and options["cube_layout"] == "exr":
        raise click.UsageError("--cube-layout exr: needs an .exr output")
    return {
        **{
            name: (options["projection"] in having, f"needs --projection {' or '.join(having)}")
            for name, having in values.PROJECTIONS_WITH.items()
        },
        "rotate": (
            options["projection"] not in values.PROJECTIONS_WITH["look"],
            f"cannot be combined with --projection {options['projection']}, which has --look",
        ),
        **dict.fromkeys(
            ("sun_size", "sun_soft", "sun_strength"),
            # Lights beside the map have them too.
            (
                options["sun_disc"] != "exclude" or bool(options.get("lights")),
                "cannot be combined with --sun-disc exclude",
            ),
        ),
        "omit_exposure": (is_radiance, "needs an .hdr output"),
        "pixel": (not is_radiance, "needs an .exr output"),
        "compression": (not is_radiance, "needs an .exr output"),
        "units": (options["ev"] is None, "cannot be combined with --ev"),
    }


def map_settings(options: Mapping[str, Any], **others: Any) -> MapSettings:
    """Return the settings of a map.

    Parameters
    ----------
    options : mapping
        With the values of `map_options`.
    **others
        Positions of the sun and the observer, and settings of clouds, as of
        `skybake.image.settings.map_settings`.

    Raises
    ------
    click.UsageError
        If a value is out of range.
    """
    from skybake.image import settings

    given = {name: options[name] for name in _ENCODINGS if options[name] is not None}
    shape = {own: options[name] for name, own in _SHAPES.items() if options[name] is not None}
    if options["look"] is not None:
        shape["azimuth"], shape["elevation"] = options["look"]
    if options["rotate"] is not None:
        others["rotation"] = options["rotate"]
    try:
        return settings.map_settings(
            options["projection"], options["size"], **shape, **given, **others
        )
    except InputError as error:
        raise click.UsageError(f"--{error}") from error
