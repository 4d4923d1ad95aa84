"""``skybake sequence``: many maps of one world."""

from __future__ import annotations

import time
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands import (
    course,
    emit,
    maps,
    outcome,
    parameters,
    progress,
    report,
    request,
    world,
)
from skybake.commands.memory import check_memory
from skybake.commands.place import place_options
from skybake.errors import SkybakeError

if TYPE_CHECKING:
    from skybake.commands.gather import Products
    from skybake.sequence.frame import Look
    from skybake.sequence.plan import Plan
    from skybake.sequence.pool import Run
    from skybake.sequence.run import Result

SOME_FAILED = 3


@click.command(cls=emit.RememberingCommand)
@world.world_options
@click.option(
    "--sun",
    "sun_elevation",
    metavar="ANGLE[..ANGLE]",
    type=parameters.ramp(parameters.elevation),
    default="30deg",
    show_default=True,
    help="Geometric elevation of the sun's centre at the observer, from first to last frame.",
)
@click.option(
    "--sun-azimuth",
    metavar="ANGLE[..ANGLE]",
    type=parameters.ramp(parameters.bearing),
    default="180deg",
    show_default=True,
    help="Compass bearing of the sun: 0deg is north, 90deg east.",
)
@click.option(
    "--from",
    "start",
    metavar="TIME",
    help="Put the sun where it stands at --lat and --lon from here on: 2026-06-21T04:00Z, or "
    "sunrise-1h; on Mars at --site, or 04:00 with --ls.",
)
@click.option("--to", "end", metavar="TIME", help="Time of the last frame.")
@click.option(
    "--every",
    metavar="DURATION",
    type=parameters.duration,
    help="Time between frames, as 10min; by default --frames are spread evenly.",
)
@place_options
@click.option(
    "--altitude",
    metavar="LENGTH[..LENGTH]",
    type=parameters.ramp(parameters.altitude),
    default="0m",
    show_default=True,
    help="Of the observer above the ground.",
)
@click.option(
    "--frames",
    metavar="FRAMES",
    type=parameters.frames,
    help="Frame numbers, as 1-96, 1-100x5,150 or 0001-0096.",
)
@click.option(
    "--only",
    metavar="FRAMES",
    type=parameters.frames,
    help="Bake only these of them, as one machine of a farm does.",
)
@maps.map_options
@click.option(
    "--exposure-curve",
    metavar="FILE.csv",
    type=click.Path(path_type=Path),
    help="Let 1.0 stand for 1.2 * 2^ev cd/m2, with columns frame and ev, straight between rows.",
)
@click.option(
    *("-o", "--output"),
    metavar="PATTERN",
    type=click.Path(path_type=Path),
    callback=parameters.with_suffix(".exr", ".hdr"),
    show_default="NAME.####.exr",
    help="Maps to write. #### is the frame number in four digits, as is a single #; %04d, "
    "{frame:04d}, $F4 and @@@@ mean the same.",
)
@click.option(
    "--preview",
    is_flag=False,
    flag_value=request.BESIDE,
    metavar="[PATTERN.png]",
    type=click.Path(path_type=Path),
    callback=parameters.with_suffix(".png"),
    help="Also write pictures to look at; by default beside the maps.",
)
@click.option(
    "--preview-ev",
    metavar="auto|adapt|N",
    type=parameters.sequence_exposure,
    show_default="auto",
    help="Exposure value of all pictures at ISO 100; auto suits the frame with the highest sun, "
    "adapt finds one for each frame.",
)
@maps.view_option
@click.option(
    "--manifest",
    "manifests",
    metavar="FILE",
    type=click.Path(path_type=Path),
    multiple=True,
    callback=parameters.with_suffix(".json", ".csv", ".usda"),
    show_default="NAME.sequence.json beside the maps, without --only",
    help="Write times, sun, light, files and digests of all frames as .json, .csv or .usda.",
)
@click.option(
    "--contact-sheet",
    metavar="FILE.png",
    type=click.Path(path_type=Path),
    callback=parameters.with_suffix(".png"),
    help="Write one picture with all frames side by side.",
)
@click.option(
    "--animate",
    metavar="FILE.webp",
    type=click.Path(path_type=Path),
    callback=parameters.with_suffix(".webp", ".gif"),
    help="Write a moving picture, .webp or .gif; needs pip install 'skybake[animate]'.",
)
@click.option(
    "--fps",
    metavar="N",
    type=parameters.frame_rate,
    default="24",
    show_default=True,
    help="Frames per second of the moving picture and of USD.",
)
@click.option(
    "--skip-existing",
    is_flag=True,
    help="Leave frames alone whose files are as they were written for the same frame.",
)
@click.option(
    "--retry",
    metavar="N",
    type=click.IntRange(0, 100),
    default=0,
    show_default=True,
    help="How often a frame that failed is tried again.",
)
@click.option(
    "--workers",
    metavar="N",
    type=click.IntRange(1, 256),
    show_default="one for each CPU",
    help="Frames that are baked at once.",
)
@click.option(
    "--dask",
    metavar="ADDRESS",
    help="Bake on the workers of a Dask scheduler, as tcp://host:8786; "
    "needs pip install 'skybake[dask]'.",
)
@emit.emit_options
@click.option("--dry-run", is_flag=True, help="Print the frames and bake none.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option(
    "--progress",
    "style",
    type=click.Choice(progress.STYLES),
    default="auto",
    show_default=True,
    help="A bar, a line for each frame, or lines of the Open Job Description; auto is a bar on "
    "a terminal and lines elsewhere.",
)
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def sequence(**options: Any) -> None:
    """Bake a sky map for each frame of a day, a climb or a change of the air.

    A range A..B goes evenly from the first frame to the last: of --sun, --sun-azimuth, --altitude,
    and of a number in --set. With --from and --to the sun stands where it does at a place and time.

    \b
    Examples:
      skybake sequence --sun -6deg..90deg --frames 1-96 -o 'sky.####.exr'
      skybake sequence --lat 48.8566 --lon 2.3522 --tz Europe/Paris \\
          --from 2026-06-21T04:00 --to 2026-06-21T22:00 --every 10min
      skybake sequence --preset mars --site gale --ls 180 --from 04:00 --to 20:00 --every 15min
      skybake sequence --preset mars --set dust.optical_depth=0.3..2 --frames 1-48

    Exit status: 0 done, 1 failed, 2 wrong usage, 3 some frames failed, 130 interrupted.
    """
    check_memory()
    started = time.perf_counter()
    context = click.get_current_context()
    request.check_together(context)
    _check_effects(options)
    plan = course.plan_from_options(context)
    if emit.emit(context, [frame.number for frame in plan.frames]):
        return
    part = course.part_of(plan, options["only"])
    if options["dry_run"]:
        outcome.print_plan(part, as_json=options["as_json"])
        return

    from skybake.commands.gather import Products

    products = Products(plan, context)
    view = options["view"] or parameters.VIEWS[0]
    part.check(view, products.paths)
    products.check()
    result = _bake(plan, part, view, products, options)
    if result.failures:
        outcome.print_failures(result, openjd=options["style"] == "openjd")
    written = _write_products(products, result)
    seconds = time.perf_counter() - started
    if options["as_json"]:
        outcome.print_json(result, written, seconds)
    elif not options["quiet"]:
        outcome.print_summary(result, written, seconds)
    if result.failures:
        raise click.exceptions.Exit(SOME_FAILED)


def _check_effects(options: dict[str, Any]) -> None:
    """Refuse options that would have no effect beside others, or spoil what they print."""
    emits = emit.is_asked(options)
    if options["chunk_size"] is not None and not emits:
        raise click.UsageError("--chunk-size: needs --emit-commands or --emit-openjd")
    if options["dry_run"] and emits:
        raise click.UsageError("--dry-run: needs no --emit-commands or --emit-openjd beside it")
    if options["workers"] is not None and options["dask"] is not None and not emits:
        raise click.UsageError("--workers: needs no --dask beside it, which has workers of its own")
    if options["as_json"] and options["style"] == "openjd":
        raise click.UsageError("--json: needs no --progress openjd beside it, also on stdout")


def _write_products(products: Products, result: Result) -> list[Path]:
    """Write them; where frames failed, their failure stays the one that counts."""
    try:
        return products.write(result)
    except SkybakeError as error:
        if not result.failures:
            raise
        report.notice(str(error))
        return []


def _bake(plan: Plan, part: Plan, view: str, products: Products, options: dict[str, Any]) -> Result:
    from skybake.baking import companion
    from skybake.sequence.run import bake_sequence

    quiet = options["quiet"]
    if not quiet:
        report.announce_kernels()
    with (
        companion.beside(),
        _pool(plan, part, view, options) as run,
        progress.progress(options["style"], len(part.frames), quiet=quiet) as tell,
    ):
        return bake_sequence(part, run, retries=options["retry"], tell=tell, keep=products.keep)


def _pool(
    plan: Plan, part: Plan, view: str, options: dict[str, Any]
) -> AbstractContextManager[Run]:
    """Return what bakes frames: workers of a cluster, or threads of this process."""
    if options["dask"] is not None:
        from skybake.sequence.dask import dask_pool

        return dask_pool(part, _look(plan, view, options), options["dask"])

    from skybake.sequence.pool import local_pool
    from skybake.sequence.run import prepare

    # First, because an exposure is found with the same tables, and without a word of them.
    prepare(part, None if options["quiet"] else report.notice)
    return local_pool(part, _look(plan, view, options), options["workers"])


def _look(plan: Plan, view: str, options: dict[str, Any]) -> Look:
    """How frames are shown; of a part of a sequence as all of it would be."""
    from skybake.sequence.animation import STILL_WIDTH
    from skybake.sequence.frame import Look
    from skybake.sequence.run import common_ev
    from skybake.sequence.sheet import TILE_WIDTH

    ev = options["preview_ev"] or "auto"
    has_pictures = any(options[name] is not None for name in request.PICTURES)
    if ev == "auto" and has_pictures and options["exposure_curve"] is None:
        ev = common_ev(plan)
    widths = {"contact_sheet": TILE_WIDTH, "animate": STILL_WIDTH}
    return Look(
        view=view,
        ev=ev if isinstance(ev, float) else None,
        follows_map=ev == "auto" and options["exposure_curve"] is not None,
        thumbnail_widths=tuple(widths[name] for name in widths if options[name] is not None),
        skip_existing=options["skip_existing"],
    )
