"""The options of every command that bakes maps: what kind, and how it is stored."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import choices, values
from skybake.commands.options.rules import Needs, options_together
from skybake.commands.options.written import (
    clamp_negative_option,
    compression_option,
    ev_option,
    fov_option,
    look_option,
    omit_exposure_option,
    pixel_option,
)
from skybake.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from skybake.image.settings import MapSettings
    from skybake.image.target import Target

_SHAPES = {
    "cube_layout": "layout",
    "cube_space": "space",
    "face_names": "face_names",
    "equirect_rows": "rows",
    "fov": "fov",
}
_ENCODINGS = (
    *("colorspace", "units", "ev", "pixel", "compression", "clamp_negative"),
    *("omit_exposure", "mips", "layers", "target", "method"),
    *("sun_disc", "sun_size", "sun_soft", "sun_strength", "below_horizon"),
)

map_options = options_together(
    click.option(
        "--target",
        metavar="NAME",
        type=click.Choice(choices.TARGETS),
        help="Program that the map is for, see skybake targets: sets projection, turn, format, "
        "scale and whether the sun is in the map, where other options do not.",
    ),
    click.option(
        "--projection",
        type=click.Choice(choices.PROJECTIONS),
        show_default="equirect",
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
    fov_option,
    look_option,
    click.option(
        "--cube-layout",
        type=click.Choice(choices.CUBE_LAYOUTS),
        show_default="faces",
        help="Six files px nx py ny pz nz, one horizontal or vertical cross, row or column, or one "
        "OpenEXR cube.",
    ),
    click.option(
        "--cube-space",
        type=click.Choice(choices.CUBE_SPACES),
        show_default="world",
        help="Axes of a cubemap: the map's own, or with x or z negated, for programs that negate "
        "it before they sample a cube, and for left-handed ones.",
    ),
    click.option(
        "--face-names",
        metavar="STYLE|A,B,C,D,E,F",
        show_default="px",
        help="How six files are named, in the place of {face} in --output or at the end: "
        "px nx .., posx negx .., +X -X .., right left top bottom front back, or six names for "
        "+X -X +Y -Y +Z -Z.",
    ),
    click.option(
        "--equirect-rows",
        type=click.Choice(choices.EQUIRECT_ROWS),
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
        "is opposite. With --target, that of what the program takes for north.",
    ),
    click.option(
        "--colorspace",
        type=click.Choice(choices.COLOUR_SPACES),
        default="lin_rec709",
        show_default=True,
        help="Linear, scene-referred space of the pixels.",
    ),
    click.option(
        "--units",
        type=click.Choice(choices.UNITS),
        show_default="ev15",
        help="What a pixel value of 1 stands for: 1.2 * 2^15 cd/m2, or 1 cd/m2.",
    ),
    ev_option,
    pixel_option,
    compression_option,
    click.option(
        "--mips",
        is_flag=True,
        help="Write smaller copies with the map, down to one pixel, as programs need that filter "
        "textures; of an equirect .exr or a cubemap whose size is a power of two.",
    ),
    click.option(
        "--layers",
        is_flag=True,
        help="Keep sky, clouds and sun in parts of an .exr besides what they add up to.",
    ),
    clamp_negative_option,
    omit_exposure_option,
    click.option(
        "--sun-disc",
        type=click.Choice(choices.SUN_DISCS),
        show_default="include",
        help="Whether the map holds the sun's disc, or nothing else, or as separate parts of an "
        ".exr.",
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
        "--below-horizon",
        type=click.Choice(choices.BELOW_HORIZON),
        default="ground",
        show_default=True,
        help="What is below the true horizon: the ground, the horizon's light softly extended "
        "downward, for scenes that bring a floor of their own, or black.",
    ),
    click.option(
        "--method",
        type=click.Choice(choices.METHODS),
        default="full",
        show_default=True,
        help="Light transport: all orders of scattering with polarised light, or as if light were "
        "not polarised, Hillaire's closure, or, as a check, single scattering by quadrature.",
    ),
)


def map_needs(options: Mapping[str, Any]) -> Needs:
    """Return what `map_options` need to have an effect, besides ``--output``.

    Raises
    ------
    click.UsageError
        If the format of the output cannot hold the map.
    """
    projection, suffix, disc = _projection(options), _suffix(options), _sun_disc(options)
    is_radiance = suffix == ".hdr"
    _check_suffix(suffix, options)
    return {
        **{
            name: (projection in having, f"needs --projection {' or '.join(having)}")
            for name, having in choices.PROJECTIONS_WITH.items()
        },
        "rotate": (
            projection not in choices.PROJECTIONS_WITH["look"],
            f"cannot be combined with --projection {projection}, which has --look",
        ),
        **dict.fromkeys(
            ("sun_size", "sun_soft", "sun_strength"),
            # Lights beside the map have them too.
            (
                disc != "exclude" or bool(options.get("lights")),
                "cannot be combined with --sun-disc exclude"
                if options["sun_disc"] is not None
                else f"needs --sun-disc include with --target {options['target']}",
            ),
        ),
        "omit_exposure": (is_radiance, "needs an .hdr output"),
        "pixel": (not is_radiance, "needs an .exr, .ktx2 or .dds output"),
        "compression": (suffix in {".exr", ".ktx2"}, "needs an .exr or .ktx2 output"),
        "mips": (not is_radiance, "needs an .exr, .ktx2 or .dds output"),
        "layers": (
            suffix == ".exr" and not options["mips"] and options["sun_disc"] != "only",
            "needs an .exr output that holds the sky, without --mips",
        ),
        "units": (options["ev"] is None, "cannot be combined with --ev"),
        "below_horizon": (disc != "only", "cannot be combined with --sun-disc only"),
    }


def _check_suffix(suffix: str, options: Mapping[str, Any]) -> None:
    layout = options["cube_layout"]
    if layout == "exr" and suffix != ".exr":
        raise click.UsageError("--cube-layout exr: needs an .exr output")
    if suffix in choices.CUBE_SUFFIXES:
        if _projection(options) != "cubemap":
            raise click.UsageError(f"--output: {suffix} needs --projection cubemap")
        if layout not in {None, "faces"}:
            raise click.UsageError(f"--cube-layout {layout}: needs an .exr or .hdr output")
        if options["compression"] not in {None, "zstd", "none"}:
            raise click.UsageError(
                f"--compression: of a .ktx2 must be zstd or none, got {options['compression']!r}"
            )
    if options["sun_disc"] == "separate" and (suffix != ".exr" or options["mips"]):
        problem = "cannot be combined with --mips" if options["mips"] else "needs an .exr output"
        raise click.UsageError(f"--sun-disc separate: {problem}")
    if options["pixel"] in {"rgb9e5", "r11g11b10"} and suffix != ".ktx2":
        raise click.UsageError(f"--pixel {options['pixel']}: needs a .ktx2 output")


def _target(options: Mapping[str, Any]) -> Target | None:
    if options["target"] is None:
        return None
    from skybake.image.target import find_target

    return find_target(options["target"])


def _projection(options: Mapping[str, Any]) -> str:
    """Return the projection that is asked for, or that of the target."""
    target, projection = _target(options), options["projection"]
    name: str = projection or ("equirect" if target is None else target.projection)
    return name


def _suffix(options: Mapping[str, Any]) -> str:
    """Return the suffix of the map's files.

    Raises
    ------
    click.UsageError
        If the target takes no such map or no such files.
    """
    target, projection = _target(options), _projection(options)
    output: Path | None = options["output"]
    if target is not None:
        try:
            target.check(projection, {})
            if output is None:
                return target.suffix(projection)
            target.check_suffix(projection, output.suffix)
        except InputError as error:
            raise click.UsageError(f"--{error}") from error
    return ".exr" if output is None else output.suffix.lower()


def _sun_disc(options: Mapping[str, Any]) -> str:
    """Return which of the sun and the sky the map shows."""
    target = _target(options)
    disc: str = options["sun_disc"] or ("include" if target is None else target.sun_disc)
    return disc


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

    given = given_settings(options)
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


def given_settings(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of light and storage that options give, by name."""
    given = {name: options.get(name) for name in _ENCODINGS}
    # Not by equality: 0 is an exposure value.
    return {
        name: value for name, value in given.items() if value is not None and value is not False
    }
