"""``skybake shot``: what a camera sees of a world."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options import values
from skybake.commands.options.camera import (
    aim_option,
    altitude_with,
    camera_from_file,
    camera_option,
    camera_units_option,
    camera_up_option,
)
from skybake.commands.options.clouds import check_clouds, clouds_options
from skybake.commands.options.maps import given_settings, map_options
from skybake.commands.options.moonlight import (
    moonlight_from_options,
    moonlight_needs,
    moonlight_options,
)
from skybake.commands.options.night import (
    lst_option,
    night_from_options,
    night_needs,
    night_options,
    scaled_for_night,
)
from skybake.commands.options.observer import (
    altitude_option,
    moon_from_options,
    moon_needs,
    moon_options,
    positions,
    sun_azimuth_option,
    sun_distance_needs,
    sun_distance_option,
    sun_option,
)
from skybake.commands.options.previews import (
    BESIDE,
    picture_from_options,
    preview_option,
    preview_options,
)
from skybake.commands.options.rules import Needs, check_needs, options_together, some_of
from skybake.commands.options.times import moment_from_options, moment_needs, moment_options
from skybake.commands.options.world import world_from_options, world_options
from skybake.commands.printing import render_summary
from skybake.commands.printing.notices import announce, notice, warn
from skybake.commands.printing.progress import map_progress
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.lit_moon import LitMoon
    from skybake.preset import Planet
    from skybake.projection import Perspective

SIZE = (1920, 1080)

_STORED = (
    *("colorspace", "units", "ev", "pixel", "compression", "layers", "clamp_negative"),
    *("sun_disc", "sun_size", "sun_soft", "sun_strength", "method"),
)


@click.command()
@world_options
@sun_option()
@sun_azimuth_option()
@moment_options
@sun_distance_option()
@moon_options("--time")
@moonlight_options()
@altitude_option()
@night_options
@lst_option
@clouds_options()
@aim_option
@click.option(
    "--fov",
    metavar="ANGLE",
    type=values.field_of_view,
    show_default="50deg, or what frames the planet or the limb",
    help="Angle that the width covers.",
)
@click.option(
    "--roll",
    metavar="ANGLE",
    type=values.bearing,
    show_default="0deg",
    help="Turn the camera clockwise.",
)
@camera_option
@camera_units_option
@camera_up_option
@click.option(
    "--size",
    metavar="WxH",
    type=values.size,
    show_default="1920x1080, or 1920 wide in the camera's proportions",
    help="Width and height.",
)
@options_together(*some_of(map_options, *_STORED))
@click.option(
    *("-o", "--output"),
    metavar="FILE",
    type=click.Path(path_type=Path),
    callback=values.with_suffix(".exr", ".hdr"),
    show_default="a name that says what it is, in the current folder",
    help="Picture of the light, .exr or .hdr.",
)
@preview_option("[FILE.png]", "Picture to look at; by default beside the picture of the light.")
@click.option("--no-preview", is_flag=True, help="Write no picture to look at.")
@options_together(*some_of(preview_options, "preview_ev", "vision", "white_balance", "view"))
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def shot(**options: Any) -> None:
    """Take a picture of a world as a camera sees it.

    The camera stands at --altitude and looks at what --look names, or is that of a file, whose
    height above the ground is added. Writes the light, and a picture to look at.

    \b
    Examples:
      skybake shot --altitude 400km --sun=-19deg --look limb
      skybake shot --altitude 36000km --sun 30deg --look planet -o globe.exr
      skybake shot --preset mars --sun 3deg --look sun --fov 30deg
      skybake shot --camera camera.json --sun 20deg --size 1998x1080
    """
    check_memory()
    started = time.perf_counter()
    context = click.get_current_context()
    is_timed = options["time"] is not None
    check_needs(
        context,
        moment_needs(context),
        sun_distance_needs(options, is_timed=is_timed, time="--time"),
        moon_needs(options, is_timed=is_timed, time="--time"),
        night_needs(options, is_timed=is_timed, time="--time"),
        moonlight_needs(options, is_timed=is_timed, time="--time"),
        _needs(options),
    )
    moment = moment_from_options(context)
    where = positions(options, moment)

    from skybake.baking import bake, default_path, late_kernels
    from skybake.baking.paths import preview_beside
    from skybake.image import settings as image_settings
    from skybake.image.sun_distance import sun_distance

    planet = world_from_options(context)
    check_clouds(context, planet)
    moonlight = moonlight_from_options(options, moment, where)
    projection = _projection(options, planet, where, moonlight.moon)
    try:
        settings = image_settings.map_settings(
            projection,
            **given_settings(options),
            **where,
            night=night_from_options(options, moment),
            moonlight=moonlight,
        )
    except InputError as error:
        raise click.UsageError(f"--{error}") from error
    distance = sun_distance(planet, moment, options["sun_distance"])
    moon = moon_from_options(options, planet, moment, distance)
    lighting = replace(settings.lighting, sun_distance=distance, moon=moon)
    settings = scaled_for_night(options, replace(settings, lighting=lighting))
    output = options["output"] or default_path(planet, settings)
    preview = options["preview"] or BESIDE
    if options["no_preview"]:
        preview = None
    elif preview == BESIDE:
        preview = preview_beside(output)
    quiet = options["quiet"]
    if not quiet:
        announce(output)
    with late_kernels.compiled_in_background(), map_progress(quiet=quiet) as progress:
        baked = bake(
            planet,
            output,
            settings,
            preview=preview,
            picture=picture_from_options(options, options["preview_ev"]) if preview else None,
            attributes=None if moment is None else moment.attributes,
            lights=[] if options["as_json"] else None,
            progress=progress,
            stage=None if progress is None else progress.begin,
            notice=None if quiet else notice,
        )
    for warning in baked.warnings:
        warn(warning)
    seconds = time.perf_counter() - started
    if options["as_json"]:
        render_summary.print_json(baked, settings, seconds, moment)
    elif not quiet:
        render_summary.print_summary(baked, settings, seconds)


def _needs(options: Mapping[str, Any]) -> Needs:
    output: Path | None = options["output"]
    is_radiance = output is not None and output.suffix.lower() == ".hdr"
    has_camera, has_preview = options["camera"] is not None, not options["no_preview"]
    has_disc = options["sun_disc"] != "exclude"
    return {
        **dict.fromkeys(
            ("look", "roll"),
            (not has_camera, "cannot be combined with --camera, which has its own"),
        ),
        **dict.fromkeys(("camera_units", "camera_up"), (has_camera, "needs --camera")),
        **dict.fromkeys(
            ("preview", "preview_ev", "vision", "white_balance", "view"),
            (has_preview, "cannot be combined with --no-preview"),
        ),
        **dict.fromkeys(
            ("pixel", "compression", "layers"), (not is_radiance, "needs an .exr output")
        ),
        **dict.fromkeys(
            ("sun_size", "sun_soft", "sun_strength"),
            (has_disc, "cannot be combined with --sun-disc exclude"),
        ),
        "units": (options["ev"] is None, "cannot be combined with --ev"),
    }


def _projection(
    options: Mapping[str, Any], planet: Planet, where: dict[str, Any], moon: LitMoon | None
) -> Perspective:
    """Return what the camera sees; a height of its own is added to the altitude in `where`."""
    from skybake.image.aim import Aim, Lookout, aimed

    size = options["size"]
    if size is not None and len(size) != 2:
        raise click.UsageError(f"--size: must be a width and a height, got {size[0]}")
    if options["camera"] is not None:
        return _of_camera(options, size, where)
    try:
        name, azimuth, elevation = options["look"] or ("horizon", None, 0.0)
        return aimed(
            Aim(name, azimuth, elevation),
            Lookout(planet, where["altitude"], where["sun_azimuth"], where["sun_elevation"], moon),
            size or SIZE,
            fov=options["fov"],
            roll=options["roll"] or 0.0,
        )
    except InputError as error:
        raise click.UsageError(f"--{error}") from error


def _of_camera(
    options: Mapping[str, Any], size: tuple[int, int] | None, where: dict[str, Any]
) -> Perspective:
    from skybake.projection import Perspective

    width, height = size or SIZE
    camera = camera_from_file(
        options["camera"],
        options["camera_units"],
        options["camera_up"],
        options["fov"],
        width / max(height, 1),
    )
    where["altitude"] = altitude_with(camera, where["altitude"])
    picture = Perspective.of_camera(camera, width)
    if size is not None and abs(picture.height - height) > 1:
        raise InputError(
            f"size: must have the camera's proportions, such as {width}x{picture.height}, "
            f"got {width}x{height}"
        )
    return picture if size is None else replace(picture, height=height)
