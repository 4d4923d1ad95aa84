"""``skybake render``: the main job."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click

from skybake.commands import moment, parameters, report, request, world
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
@click.option(
    "--projection",
    type=click.Choice(parameters.PROJECTIONS),
    default="equirect",
    show_default=True,
    help="Kind of map.",
)
@click.option(
    "--size",
    metavar="WxH|EDGE",
    type=parameters.size,
    show_default="2048x1024, or 1024 for a cubemap",
    help="Width and height of an equirect map, 2:1, or edge of a cubemap's face.",
)
@click.option(
    "--cube-layout",
    type=click.Choice(parameters.CUBE_LAYOUTS),
    show_default="faces",
    help="Six files px nx py ny pz nz, one horizontal cross, or one OpenEXR cube.",
)
@click.option(
    "--colorspace",
    type=click.Choice(parameters.COLOUR_SPACES),
    default="lin_rec709",
    show_default=True,
    help="Linear, scene-referred space of the pixels.",
)
@click.option(
    "--units",
    type=click.Choice(parameters.UNITS),
    show_default="ev15",
    help="What a pixel value of 1 stands for: 1.2 * 2^15 cd/m2, or 1 cd/m2.",
)
@click.option(
    "--ev",
    metavar="N",
    type=float,
    help="Let a pixel value of 1 stand for 1.2 * 2^N cd/m2 instead.",
)
@click.option(
    "--pixel",
    type=click.Choice(parameters.PIXELS),
    show_default="auto",
    help="Stored type of an EXR; auto takes half where it holds every value.",
)
@click.option(
    "--compression",
    metavar="NAME[:LEVEL]",
    show_default="zip",
    help="Of an EXR: none, rle, zips, zip[:1-9], piz, pxr24, b44, b44a, dwaa[:0-135], ...",
)
@click.option("--clamp-negative", is_flag=True, help="Set negative values, out of gamut, to 0.")
@click.option(
    "--sun-disc",
    type=click.Choice(parameters.SUN_DISCS),
    default="include",
    show_default=True,
    help="Whether the map holds the sun's disc, or nothing else.",
)
@click.option(
    "--method",
    type=click.Choice(parameters.METHODS),
    default="full",
    show_default=True,
    help="Light transport: all orders of scattering, Hillaire's closure, or single scattering.",
)
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
@click.option(
    "--view",
    type=click.Choice(parameters.VIEWS),
    show_default=parameters.VIEWS[0],
    help="Its display transform: ACES 2.0, or that of ACES 1.3.",
)
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
    started = time.perf_counter()
    context = click.get_current_context()
    request.check_together(context)
    when = moment.moment(context)
    if when is not None:
        options |= {"sun_elevation": when.sun_elevation, "sun_azimuth": when.sun_azimuth}
    settings = request.map_settings(options)

    from skybake.baking import bake, companion, default_path

    planet = world.load_world(options["preset"], options)
    output = options["output"] or default_path(planet, settings)
    quiet = options["quiet"]
    if not quiet:
        report.announce(output)
    with companion.beside(), report.progress_bar(quiet=quiet) as progress:
        baked = bake(
            planet,
            output,
            settings,
            preview=request.preview_path(options["preview"], output),
            preview_ev=options["preview_ev"],
            preview_view=options["view"] or parameters.VIEWS[0],
            extra=None if when is None else when.attributes,
            progress=progress,
            notice=None if quiet else report.notice,
        )
    seconds = time.perf_counter() - started
    if options["as_json"]:
        report.print_json(baked, planet.name, settings, seconds, when)
    elif not quiet:
        report.print_summary(baked, seconds)
