"""``skybake render``: the main job."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from skybake.commands.memory import check_memory
from skybake.commands.options import choices, values
from skybake.commands.options.clouds import check_clouds, clouds_options
from skybake.commands.options.maps import map_needs, map_options, map_settings
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
    preview_needs,
    preview_options,
)
from skybake.commands.options.rules import check_needs, is_given
from skybake.commands.options.sensor import sensor_from_options, sensor_needs, sensor_options
from skybake.commands.options.times import moment_from_options, moment_needs, moment_options
from skybake.commands.options.world import world_from_options, world_options
from skybake.commands.printing import render_summary
from skybake.commands.printing.notices import announce, notice, warn
from skybake.commands.printing.progress import map_progress

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment
    from skybake.image.settings import MapSettings
    from skybake.preset import Planet


class RequestedMap(NamedTuple):
    """What a command line asks to be baked.

    Attributes
    ----------
    planet : Planet
        The world, with its changes.
    settings : MapSettings
        Of the map.
    moment : Moment or None
        When, if a time is given.
    leaves_disc_out : bool
        Whether the map has no disc because lights are written besides.
    """

    planet: Planet
    settings: MapSettings
    moment: Moment | None
    leaves_disc_out: bool


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
@map_options
@sensor_options
@click.option(
    *("-o", "--output"),
    metavar="FILE",
    type=click.Path(path_type=Path),
    callback=values.with_suffix(*choices.MAP_SUFFIXES),
    show_default="a name that says what it is, in the current folder",
    help="Map to write, .exr or .hdr, or for all faces of a cubemap .ktx2 or .dds; {face} in it is "
    "replaced for six files.",
)
@click.option(
    "--lights",
    metavar="FILE",
    type=click.Path(path_type=Path),
    multiple=True,
    callback=values.with_suffix(".json", ".usda", ".py"),
    help="Write sky and sun as lights: .json, .usda for USD, .py for Blender. The map then "
    "leaves the disc out, unless --sun-disc says otherwise. May be repeated.",
)
@preview_options
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def render(**options: Any) -> None:
    """Bake a sky map.

    Angles are 5deg, 0.1rad, 30arcmin or bare degrees; lengths 2km, 1500m or 30000ft.
    +Y is up and -Z north; azimuths are compass bearings, 0 = north, clockwise. The middle of an
    equirect map faces south, where the sun is by default; its left half is the east.

    \b
    Examples:
      skybake render --sun 5deg --preset mars --preview
      skybake render --sun -4deg --altitude 2km --size 4096x2048 -o dusk.exr
      skybake render --lat 48.86 --lon 2.35 --tz Europe/Paris --date 2026-06-21 --time sunset-20min
      skybake render --preset mars --site gale --ls 180 --time 16:30
      skybake render --projection cubemap --size 512 --colorspace acescg --units nits
      skybake render --sun 20deg -o sky.exr --lights sky.usda --lights sky.light.json
    """
    check_memory()
    started = time.perf_counter()
    _bake(click.get_current_context(), options, started)


def requested_map(
    context: click.Context, load_world: Callable[[click.Context], Planet] = world_from_options
) -> RequestedMap:
    """Return the map that the options of a command line ask for.

    Parameters
    ----------
    context : click.Context
        With the options of `render`.
    load_world : callable, optional
        Loads the world, which may be known already.

    Raises
    ------
    click.UsageError
        If an option is out of its range, or would have no effect with the others.
    SkybakeError
        If the preset cannot be used.
    """
    options = dict(context.params)
    is_timed = options["time"] is not None
    check_needs(
        context,
        moment_needs(context),
        sun_distance_needs(options, is_timed=is_timed, time="--time"),
        moon_needs(options, is_timed=is_timed, time="--time"),
        night_needs(options, is_timed=is_timed, time="--time"),
        moonlight_needs(options, is_timed=is_timed, time="--time"),
        map_needs(options),
        sensor_needs(options),
        preview_needs(options),
    )
    leaves_disc_out = bool(options["lights"]) and not is_given(context, "sun_disc")
    if leaves_disc_out:
        # A renderer that took the disc and the light would count the sun twice.
        options["sun_disc"] = "exclude"
    moment = moment_from_options(context)
    where = positions(options, moment)
    settings = map_settings(
        options,
        **where,
        night=night_from_options(options, moment),
        sensor=sensor_from_options(options),
        moonlight=moonlight_from_options(options, moment, where),
    )

    from skybake.image.sun_distance import sun_distance

    planet = load_world(context)
    check_clouds(context, planet)
    distance = sun_distance(planet, moment, options["sun_distance"])
    moon = moon_from_options(options, planet, moment, distance)
    lighting = replace(settings.lighting, sun_distance=distance, moon=moon)
    settings = scaled_for_night(options, replace(settings, lighting=lighting))
    return RequestedMap(planet, settings, moment, leaves_disc_out)


def _bake(context: click.Context, options: dict[str, Any], started: float) -> None:
    requested = requested_map(context)
    planet, settings, moment = requested.planet, requested.settings, requested.moment

    from skybake.baking import bake, default_path, late_kernels
    from skybake.baking.paths import preview_beside

    output = options["output"] or default_path(planet, settings)
    preview = preview_beside(output) if options["preview"] == BESIDE else options["preview"]
    quiet = options["quiet"]
    if not quiet:
        announce(output)
        if requested.leaves_disc_out:
            notice("the map leaves out the sun's disc, which is a light of its own")
    with late_kernels.compiled_in_background(), map_progress(quiet=quiet) as progress:
        baked = bake(
            planet,
            output,
            settings,
            preview=preview,
            picture=picture_from_options(options, options["preview_ev"]) if preview else None,
            attributes=None if moment is None else moment.attributes,
            lights=options["lights"] if options["lights"] or options["as_json"] else None,
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
