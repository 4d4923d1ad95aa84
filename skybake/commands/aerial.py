"""``skybake aerial``: the air between a camera and what a renderer has drawn."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options import choices, values
from skybake.commands.options.camera import (
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
from skybake.commands.options.observer import (
    altitude_option,
    positions,
    sun_azimuth_option,
    sun_distance_needs,
    sun_distance_option,
    sun_option,
)
from skybake.commands.options.rules import check_needs, options_together, some_of
from skybake.commands.options.times import moment_from_options, moment_needs, moment_options
from skybake.commands.options.world import world_from_options, world_options
from skybake.commands.printing.notices import announce_kernels, notice, warn
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.aerial.source import Reading, Source
    from skybake.projection.camera import Camera

_SUN = ("sun_disc", "sun_size", "sun_soft", "sun_strength")
NIGHT = math.radians(-18.0)
"""Elevation of the sun below which it leaves no light in the air."""

_EXR = values.with_suffix(".exr")


@click.command()
@click.option(
    "--beauty",
    metavar="IN.exr",
    type=click.Path(path_type=Path),
    callback=_EXR,
    required=True,
    help="Picture of a renderer, scene-linear, lit by the sky without the air before it.",
)
@click.option(
    "--depth",
    metavar="Z.exr",
    type=click.Path(path_type=Path),
    callback=_EXR,
    show_default="the file of --beauty",
    help="How far what it shows is.",
)
@click.option(
    *("-o", "--output"),
    metavar="OUT.exr",
    type=click.Path(path_type=Path),
    callback=_EXR,
    required=True,
    help="Picture to write, with all else that --beauty holds.",
)
@click.option(
    "--layer",
    metavar="NAME",
    show_default="R, G, B, or the only layer that has them",
    help="Layer or part of the picture: what is before .R, .G, .B.",
)
@click.option(
    "--depth-channel",
    metavar="NAME",
    show_default="Z, or the only depth",
    help="Channel of the depth.",
)
@click.option(
    "--depth-kind",
    type=click.Choice(choices.DEPTH_KINDS),
    default="planar",
    show_default=True,
    help="Whether depths are along the camera's axis, or distances along rays.",
)
@click.option(
    "--depth-units",
    type=click.Choice(choices.CAMERA_UNITS),
    default="m",
    show_default=True,
    help="Length of 1 in them.",
)
@click.option(
    "--depth-background",
    type=click.Choice(choices.DEPTH_BACKGROUNDS),
    help="What NaN and negative depths mean: infinitely far, or no air; else they are refused.",
)
@camera_option
@click.option(
    "--fov",
    metavar="ANGLE",
    type=values.field_of_view,
    help="Angle that the width covers, where the camera does not tell it.",
)
@camera_units_option
@camera_up_option
@click.option(
    "--sky",
    type=click.Choice(choices.SKIES_BEHIND),
    default="none",
    show_default=True,
    help="fill puts the sky behind what covers less than a whole pixel.",
)
@click.option(
    "--method",
    type=click.Choice(choices.AERIAL_METHODS),
    default="march",
    show_default=True,
    help="Look each pixel up among directions and distances, or among froxels as engines do.",
)
@world_options
@sun_option()
@sun_azimuth_option()
@moment_options
@sun_distance_option()
@click.option(
    "--moon",
    type=click.Choice(choices.MOONS_IN_AIR),
    show_default="include, with --time",
    help="Whether moonlight is in the air.",
)
@moonlight_options()
@altitude_option()
@clouds_options()
@click.option(
    "--colorspace",
    type=click.Choice(choices.COLOUR_SPACES),
    show_default="that of the picture's tags, or lin_rec709",
    help="Linear space of the picture.",
)
@click.option(
    "--units",
    type=click.Choice(choices.UNITS),
    show_default="the picture's whiteLuminance, or ev15",
    help="What a value of 1 stands for in the picture, which must be that of the sky it is lit by.",
)
@options_together(*some_of(map_options, "ev", *_SUN))
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def aerial(**options: Any) -> None:
    """Put the air between a camera and what it sees into a renderer's picture.

    Each pixel is dimmed by the air before it and gets the light that this air scatters, by its
    distance, up to the sky itself. The camera is in a .json, or in the picture's own attributes
    worldToCamera and worldToNDC; its height is added to --altitude. All other channels, parts and
    attributes stay as they are.

    \b
    Examples:
      skybake aerial --beauty in.exr --camera camera.json --sun 10deg -o out.exr
      skybake aerial --beauty in.exr --depth z.exr --depth-kind ray --sky fill -o out.exr
      skybake aerial --beauty in.exr --preset mars --sun 3deg --altitude 2km -o out.exr
    """
    check_memory()
    started = time.perf_counter()
    context = click.get_current_context()
    is_timed = options["time"] is not None
    fills = options["sky"] == "fill"
    by_moon = {**options, "night": None}
    check_needs(
        context,
        moment_needs(context),
        sun_distance_needs(options, is_timed=is_timed, time="--time"),
        moonlight_needs(by_moon, is_timed=is_timed, time="--time"),
        {
            "units": (options["ev"] is None, "cannot be combined with --ev"),
            **dict.fromkeys(_SUN, (fills, "needs --sky fill")),
        },
    )
    if options["sun_disc"] in {"only", "separate"}:
        raise click.UsageError(f"--sun-disc {options['sun_disc']}: must be include or exclude")
    moment = moment_from_options(context)
    where = positions(options, moment)

    from skybake.aerial.source import read_source

    # Files are unpacked while the rest of the program is loaded.
    with ThreadPoolExecutor(1) as thread:
        given = options["beauty"], options["depth"], _reading(options)
        reading = thread.submit(read_source, *given)

        from skybake.aerial.bake import bake_aerial
        from skybake.baking import late_kernels
        from skybake.image import settings as image_settings
        from skybake.image.scene import Scene
        from skybake.image.sun_distance import sun_distance
        from skybake.image.uneclipsed import check_uneclipsed

        planet = world_from_options(context)
        check_clouds(context, planet)
        if not options["quiet"]:
            announce_kernels()
        source = reading.result()
    camera = _camera(options, source)
    where["altitude"] = altitude_with(camera, where["altitude"])
    try:
        settings = image_settings.map_settings(
            None,
            **_scale(options, source),
            **where,
            moonlight=moonlight_from_options(by_moon, moment, where),
        )
    except InputError as error:
        raise click.UsageError(f"--{error}") from error
    distance = sun_distance(planet, moment, options["sun_distance"])
    settings = replace(settings, lighting=replace(settings.lighting, sun_distance=distance))
    check_uneclipsed(planet, settings, moment)
    scene = Scene(planet, settings)
    if settings.lighting.sun_elevation < NIGHT and scene.moonlit is None:
        warn(
            "sun is more than 18 degrees below the horizon: the air is dark, as the night's own "
            "light is not in it, and no Moon shines"
        )
    if not options["quiet"] and not scene.sky.is_solved:
        notice("solving for the light in this atmosphere, once")
    with late_kernels.compiled_in_background():
        clamped = bake_aerial(
            scene, source, camera, options["output"], method=options["method"], fills_sky=fills
        )
    if clamped:
        warn(f"{options['output']}: {clamped} values were too large for half floats")
    seconds = time.perf_counter() - started
    _print(options, source, where["altitude"], seconds)


def _reading(options: Mapping[str, Any]) -> Reading:
    from skybake.aerial.source import Reading
    from skybake.projection.camera_file import UNITS

    return Reading(
        layer=options["layer"],
        depth_channel=options["depth_channel"],
        depth_kind=options["depth_kind"],
        depth_unit=UNITS[options["depth_units"]],
        depth_background=options["depth_background"],
    )


def _camera(options: Mapping[str, Any], source: Source) -> Camera:
    """Return the camera of a file, or that of the picture itself."""
    _, _, width, height = source.part.window
    path: Path = options["camera"] or source.path
    given = options["camera_units"], options["camera_up"], options["fov"]
    return camera_from_file(path, *given, width / height)


def _scale(options: Mapping[str, Any], source: Source) -> dict[str, Any]:
    """Return the settings of light, with the space and the scale that the picture states."""
    from skybake.colour.exposure import ev_from_luminance
    from skybake.environment.tags import file_space, file_white

    given = given_settings({**options, "target": None, "method": None})
    attributes = source.part.attributes
    if options["colorspace"] is None:
        given["colorspace"] = file_space(source.path, attributes).name
    if options["units"] is None and options["ev"] is None:
        white = file_white(source.path, attributes)
        if white is not None:
            given["ev"] = ev_from_luminance(white)
    return given


def _print(options: Mapping[str, Any], source: Source, altitude: float, seconds: float) -> None:
    output: Path = options["output"]
    width, height = source.part.size
    if options["as_json"]:
        told = {
            "file": str(output),
            "width": width,
            "height": height,
            "channels": list(source.beauty.colours),
            "method": options["method"],
            "altitude_m": altitude * 1e3,
            "seconds": round(seconds, 3),
        }
        click.echo(json.dumps(told))
    elif not options["quiet"]:
        click.echo(output)
        channels = ", ".join(source.beauty.colours)
        click.echo(f"{width}x{height}, {channels} from {altitude * 1e3:.6g} m; {seconds:.2f} s")
