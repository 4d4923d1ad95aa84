"""``skybake luts``: tables that engines look the sky up in."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options import values
from skybake.commands.options.observer import (
    altitude_option,
    sun_azimuth_option,
    sun_distance_needs,
    sun_distance_option,
    sun_option,
)
from skybake.commands.options.rules import check_needs
from skybake.commands.options.tables import (
    scene_settings,
    table_camera,
    table_options,
    table_settings,
)
from skybake.commands.options.times import moment_from_options, moment_needs, moment_options
from skybake.commands.options.world import world_from_options, world_options
from skybake.commands.printing.notices import announce_kernels, notice, warn
from skybake.commands.printing.tables_summary import print_json, print_summary


@click.command()
@world_options
@sun_option()
@sun_azimuth_option()
@moment_options
@sun_distance_option()
@altitude_option()
@table_options
@click.option(
    *("-o", "--output"),
    metavar="FOLDER",
    required=True,
    type=values.folder,
    help="Where to write; a folder that exists, or a new one in it.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def luts(**options: Any) -> None:
    """Write tables that engines look the sky up in, and code that does.

    Transmittance, multiple scattering, the view of the sky and a volume of aerial perspective,
    as EXR and KTX 2; luts.json with every constant and formula; luts.glsl, .hlsl and .wgsl.

    \b
    Examples:
      skybake luts --sun 5deg --preset mars -o mars
      skybake luts --preset earth-hillaire2020 --altitude 2km --method hillaire -o paper
      skybake luts --look 180,10 --fov 75deg --aspect 16:9 --far 64km -o valley
      skybake luts --camera camera.json --sun 5deg -o shot
      skybake luts --parametrisation bruneton2017 --sky-view-size 256x128 -o sky
    """
    check_memory()
    started = time.perf_counter()
    context = click.get_current_context()
    is_timed, has_camera = options["time"] is not None, options["camera"] is not None
    check_needs(
        context,
        moment_needs(context),
        sun_distance_needs(options, is_timed=is_timed, time="--time"),
        {
            "units": (options["ev"] is None, "cannot be combined with --ev"),
            "look": (not has_camera, "cannot be combined with --camera, which has its own"),
            **dict.fromkeys(("camera_units", "camera_up"), (has_camera, "needs --camera")),
        },
    )
    camera = table_camera(options)
    settings = table_settings(options, camera)
    moment = moment_from_options(context)
    view = scene_settings(options, moment, camera)

    from skybake.image.scene import Scene
    from skybake.image.sun_distance import sun_distance
    from skybake.image.uneclipsed import check_uneclipsed
    from skybake.luts.bake import bake_tables, check_scene
    from skybake.sky.closure import closure_warning

    planet = world_from_options(context)
    distance = sun_distance(planet, moment, options["sun_distance"])
    view = replace(view, lighting=replace(view.lighting, sun_distance=distance))
    check_uneclipsed(planet, view, moment)
    scene = Scene(planet, view)
    check_scene(scene)
    if not options["quiet"]:
        announce_kernels()
        if not scene.sky.is_solved:
            notice("solving for the light in this atmosphere, once")
    baked = bake_tables(
        scene,
        Path(options["output"]),
        settings,
        attributes=None if moment is None else moment.attributes,
    )
    if options["method"] == "hillaire" and (warning := closure_warning(scene.sky.medium)):
        warn(warning)
    seconds = time.perf_counter() - started
    if options["as_json"]:
        print_json(baked, view, settings, seconds)
    elif not options["quiet"]:
        print_summary(baked, view, settings, seconds)
