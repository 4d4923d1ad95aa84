"""``skybake render``: the main job."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click

from skybake.commands import maps, moment, parameters, report, request, world
from skybake.commands.memory import check_memory
from skybake.commands.place import place_options


@click.command()
@world.world_options
@parameters.sun_option
@click.option(
    "--sun-azimuth",
    metavar="ANGLE",
    type=parameters.bearing,
    default="180deg",
    show_default=True,
    help="Compass bearing of the sun: 0deg is north, 90deg east.",
)
@moment.time_option
@place_options
@parameters.altitude_option
@maps.map_options
@click.option(
    *("-o", "--output"),
    metavar="FILE",
    type=click.Path(path_type=Path),
    callback=parameters.with_suffix(".exr", ".hdr"),
    show_default="a name that says what it is, in the current folder",
    help="Map to write, .exr or .hdr; {face} in it is replaced for six files.",
)
@click.option(
    "--preview",
    is_flag=False,
    flag_value=request.BESIDE,
    metavar="[FILE.png]",
    type=click.Path(path_type=Path),
    callback=parameters.with_suffix(".png"),
    help="Also write a picture to look at; by default beside the map.",
)
@click.option(
    "--preview-ev",
    metavar="auto|N",
    type=parameters.exposure,
    show_default="auto",
    help="Its exposure value at ISO 100; auto finds a legible one.",
)
@maps.view_option
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def render(**options: Any) -> None:
    """Bake a sky map.

    Angles are 5deg, 0.1rad, 30arcmin or bare degrees; lengths 2km, 1500m, 30000ft or bare metres.
    +Y is up and -Z north; azimuths are compass bearings, 0 = north, clockwise. The middle of an
    equirect map faces south, where the sun stands by default; its left half is the east.

    \b
    Examples:
      skybake render --sun 5deg --preset mars --preview
      skybake render --sun -4deg --altitude 2km --size 4096x2048 -o dusk.exr
      skybake render --lat 48.86 --lon 2.35 --tz Europe/Paris --date 2026-06-21 --time sunset-20min
      skybake render --preset mars --site gale --ls 180 --time 16:30
      skybake render --projection cubemap --size 512 --colorspace acescg --units nits
    """
    check_memory()
    started = time.perf_counter()
    context = click.get_current_context()
    request.check_together(context)
    when = moment.moment(context)
    if when is not None:
        options |= {"sun_elevation": when.sun_elevation, "sun_azimuth": when.sun_azimuth}
    settings = request.map_settings(options)

    from skybake.baking import bake, default_path, late_kernels

    planet = world.load_world(options["preset"], options)
    output = options["output"] or default_path(planet, settings)
    quiet = options["quiet"]
    if not quiet:
        report.announce(output)
    with late_kernels.compiled_in_background(), report.progress_bar(quiet=quiet) as progress:
        baked = bake(
            planet,
            output,
            settings,
            preview=request.preview_path(options["preview"], output),
            preview_ev=options["preview_ev"],
            preview_view=options["view"] or parameters.VIEWS[0],
            attributes=None if when is None else when.attributes,
            progress=progress,
            notice=None if quiet else report.notice,
        )
    seconds = time.perf_counter() - started
    if options["as_json"]:
        report.print_json(baked, planet.name, settings, seconds, when)
    elif not quiet:
        report.print_summary(baked, seconds)
