"""``skybake ibl``: lighting maps, for engines that light surfaces by a sky."""

from __future__ import annotations

import os
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options.clouds import check_clouds, clouds_options
from skybake.commands.options.lighting import lighting_needs, lighting_options
from skybake.commands.options.lighting_settings import (
    lighting_from_options,
    program_from_options,
    sky_settings,
)
from skybake.commands.options.night import (
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
from skybake.commands.options.rules import check_needs, options_together, some_of
from skybake.commands.options.times import moment_from_options, moment_needs, moment_options
from skybake.commands.options.world import world_from_options, world_options
from skybake.commands.printing.lighting_summary import print_json, print_summary
from skybake.commands.printing.notices import announce, announce_kernels, notice, warn

if TYPE_CHECKING:
    from skybake.ibl.bake import BakedLighting
    from skybake.ibl.files import FileForm
    from skybake.ibl.program import Program
    from skybake.ibl.settings import LightingMaps

_OF_FILES = (
    *("source", "output", "as_json", "quiet", "target", "parts", "specular_size", "mips"),
    *("mip_roughness", "samples", "diffuse_size", "dfg_size", "dfg_multiscatter", "sun_disc"),
    *("rotate", "file_format", "pixel", "cube_space", "face_names"),
)
"""Options that have an effect on maps from files."""

_SUFFIXES = (".exr", ".hdr", ".ktx2", ".dds", ".json", ".txt")


def _prefix(_: click.Context, __: click.Parameter, value: str | None) -> Path | None:
    if value is None:
        return None
    path = Path(value)
    if value.endswith((os.sep, "/")) and not path.is_dir():
        raise click.BadParameter(f"must be a folder that exists, got {value!r}")
    if path.suffix.lower() in _SUFFIXES and not path.is_dir():
        raise click.BadParameter(
            f"must be what the names of several files begin with, got {value!r}"
        )
    return path


@click.command()
@world_options
@sun_option()
@sun_azimuth_option()
@moment_options
@sun_distance_option()
@moon_options("--time", is_light=False)
@altitude_option()
@options_together(*some_of(night_options, "night", "airglow", "zodiacal", "light_pollution"))
@clouds_options()
@click.option(
    "--input",
    "source",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Light by a map instead of a sky: an .exr or .hdr, equirect or a cube, whose small bright "
    "spots, such as a sun, are convolved exactly.",
)
@lighting_options
@click.option(
    *("-o", "--output"),
    metavar="PREFIX|FOLDER",
    callback=_prefix,
    show_default="a name that says what it is, in the current folder",
    help="What the names of the files begin with, or a folder that exists.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def ibl(**options: Any) -> None:
    """Bake image-based lighting: what surfaces of any roughness receive from a sky.

    Writes a specular cube with mips (GGX), a diffuse cube (irradiance over pi), spherical
    harmonics of three bands and the split sum's table. The sun is convolved exactly, or left to a
    light of the program.

    \b
    Examples:
      skybake ibl --sun 30deg -o sky
      skybake ibl --sun 5deg --preset mars --target bevy -o assets/mars
      skybake ibl --input studio.hdr --specular-size 512 --mips 8 -o studio
      skybake ibl --input sky.exr --target filament --parts specular,sh -o folder/
    """
    check_memory()
    started = time.perf_counter()
    context = click.get_current_context()
    is_timed = options["time"] is not None
    program = program_from_options(options)
    from_file = options["source"] is not None
    of_sky = [] if not from_file else [name for name in options if name not in _OF_FILES]
    check_needs(
        context,
        dict.fromkeys(of_sky, (False, "cannot be combined with --input")),
        moment_needs(context),
        sun_distance_needs(options, is_timed=is_timed, time="--time"),
        moon_needs(options, is_timed=is_timed, time="--time"),
        night_needs(options, is_timed=is_timed, time="--time"),
        lighting_needs(options, program),
    )
    maps, form = lighting_from_options(options, program)
    if from_file:
        baked = _of_file(context, program, maps, form)
    else:
        baked = _of_sky(context, program, maps, form)
    for warning in baked.warnings:
        warn(warning)
    seconds = time.perf_counter() - started
    if options["as_json"]:
        print_json(baked, maps, form, seconds)
    elif not options["quiet"]:
        print_summary(baked, maps, seconds)


def _of_file(
    context: click.Context, program: Program, maps: LightingMaps, form: FileForm
) -> BakedLighting:
    from skybake.ibl.bake_file import bake_lighting_of_file

    options = context.params
    source: Path = options["source"]
    if not options["quiet"]:
        announce_kernels()
    return bake_lighting_of_file(
        source,
        options["output"] or Path(source.name.replace("{face}", "")).with_suffix(""),
        maps,
        form,
        keeps_sun=(options["sun_disc"] or program.sun_disc) == "include",
        rotation=options["rotate"] or 0.0,
    )


def _of_sky(
    context: click.Context, program: Program, maps: LightingMaps, form: FileForm
) -> BakedLighting:
    options = context.params
    moment = moment_from_options(context)
    settings = sky_settings(
        options,
        program,
        maps.source_edge,
        **positions(options, moment),
        # As points they are too many, and too faint to light anything.
        night=night_from_options({**options, "stars": "exclude"}, moment),
    )

    from skybake.baking import default_path, late_kernels
    from skybake.ibl.bake import bake_lighting
    from skybake.image.scene import Scene
    from skybake.image.sun_distance import sun_distance

    planet = world_from_options(context)
    check_clouds(context, planet)
    distance = sun_distance(planet, moment, options["sun_distance"])
    moon = moon_from_options(options, planet, moment, distance)
    lighting = replace(settings.lighting, sun_distance=distance, moon=moon)
    settings = scaled_for_night(options, replace(settings, lighting=lighting))
    output = options["output"] or _default_prefix(default_path(planet, settings))
    if not options["quiet"]:
        announce(output)
    scene = Scene(planet, settings)
    if not options["quiet"] and not scene.sky.is_solved:
        notice("solving for the light in this atmosphere, once")
    with late_kernels.compiled_in_background():
        return bake_lighting(
            scene, output, maps, form, attributes=None if moment is None else moment.attributes
        )


def _default_prefix(path: Path) -> Path:
    return path.with_name(path.name.removesuffix(path.suffix).removesuffix("_cubemap"))
