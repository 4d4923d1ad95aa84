"""``skybake sequence``: many maps of one world."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options import choices, values
from skybake.commands.options.clouds import check_clouds, clouds_options
from skybake.commands.options.emit import (
    RememberingCommand,
    emit,
    emit_needs,
    emit_options,
    is_asked,
)
from skybake.commands.options.maps import map_needs, map_options, map_settings
from skybake.commands.options.moonlight import (
    moon_path_from_options,
    moonlight_needs,
    moonlight_of_sequence,
    moonlight_options,
)
from skybake.commands.options.night import (
    is_scale_open,
    night_from_options,
    night_needs,
    night_options,
)
from skybake.commands.options.observer import (
    altitude_option,
    moon_by_place,
    moon_needs,
    moon_options,
    sun_azimuth_option,
    sun_distance_needs,
    sun_distance_option,
    sun_option,
)
from skybake.commands.options.previews import (
    BESIDE,
    picture_from_options,
    preview_needs,
    sequence_preview_options,
)
from skybake.commands.options.products import product_options, products_from_options
from skybake.commands.options.rules import Needs, check_needs, usage_faults
from skybake.commands.options.sensor import sensor_from_options, sensor_needs, sensor_options
from skybake.commands.options.times import span_from_options, span_needs, span_options
from skybake.commands.options.world import changes_from_options, world_options
from skybake.commands.printing import sequence_summary
from skybake.commands.printing.notices import announce_kernels, notice
from skybake.commands.printing.progress import STYLES, frame_progress
from skybake.errors import SkybakeError

if TYPE_CHECKING:
    from skybake.sequence.plan import Plan
    from skybake.sequence.products import Products
    from skybake.sequence.run import SequenceResult

SOME_FAILED = 3


@click.command(cls=RememberingCommand)
@world_options
@sun_option(is_range=True)
@sun_azimuth_option(is_range=True)
@span_options
@sun_distance_option()
@moon_options("--from and --to")
@moonlight_options(is_range=True)
@altitude_option(is_range=True)
@night_options
@clouds_options(is_range=True)
@click.option(
    "--frames",
    metavar="FRAMES",
    type=values.frames,
    help="Frame numbers, such as 1-96, 1-100x5,150 or 0001-0096.",
)
@click.option(
    "--only",
    metavar="FRAMES",
    type=values.frames,
    help="Bake only these of them, as one machine of a farm does.",
)
@map_options
@sensor_options
@click.option(
    "--exposure-curve",
    metavar="FILE.csv",
    type=click.Path(path_type=Path),
    help="Let 1.0 stand for 1.2 * 2^ev cd/m2, with columns frame and ev, linear between rows.",
)
@click.option(
    *("-o", "--output"),
    metavar="PATTERN",
    type=click.Path(path_type=Path),
    callback=values.with_suffix(*choices.MAP_SUFFIXES),
    show_default="NAME.####.exr",
    help="Maps to write. #### is the frame number in four digits, as is a single #; %04d, "
    "{frame:04d}, $F4 and @@@@ mean the same.",
)
@sequence_preview_options
@product_options
@click.option(
    "--skip-existing",
    is_flag=True,
    help="Skip frames whose files are as they were written for the same frame.",
)
@click.option(
    "--retry",
    metavar="N",
    type=click.IntRange(0, 100),
    default=0,
    show_default=True,
    help="How often a failed frame is tried again.",
)
@click.option(
    "--workers",
    metavar="N",
    type=click.IntRange(1, 256),
    show_default="one for each CPU",
    help="Frames that are baked at the same time.",
)
@click.option(
    "--dask",
    metavar="ADDRESS",
    help="Bake on the workers of a Dask scheduler, such as tcp://host:8786; "
    "needs pip install distributed.",
)
@emit_options
@click.option("--dry-run", is_flag=True, help="Print the frames and bake nothing.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option(
    "--progress",
    "style",
    type=click.Choice(STYLES),
    default="auto",
    show_default=True,
    help="A bar, a line for each frame, or lines of the Open Job Description; auto is a bar on "
    "a terminal and lines elsewhere.",
)
@click.option("-q", "--quiet", is_flag=True, help="Print no progress and no summary.")
def sequence(**options: Any) -> None:
    """Bake a sky map for each frame of a day, a climb or a change of the atmosphere.

    A range A..B runs evenly from the first frame to the last; places of sun and Moon, --altitude
    and numbers in --set can have one. With --from and --to the sun follows its path at a place.

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
    is_timed, times = options["start"] is not None, "--from and --to"
    check_needs(
        context,
        span_needs(context),
        sun_distance_needs(options, is_timed=is_timed, time=times),
        moon_needs(options, is_timed=is_timed, time=times),
        night_needs(options, is_timed=is_timed, time=times),
        moonlight_needs(options, is_timed=is_timed, time=times),
        map_needs(options),
        sensor_needs(options),
        preview_needs(options),
        emit_needs(options),
        _needs(options),
    )
    if options["frames"] is None and options["start"] is None:
        # Reported before the engine is imported, which takes longer than all checks.
        raise click.UsageError("--frames: is required, such as 1-96")
    plan = _plan_from_options(context)
    if is_asked(options):
        emit(context, plan)
        return
    with usage_faults(context):
        part = plan if options["only"] is None else plan.only(options["only"])
    if options["dry_run"]:
        sequence_summary.print_plan(part, as_json=options["as_json"])
        return
    products = products_from_options(context, plan)
    result = _bake(plan, part, products, options)
    sequence_summary.print_warnings(result)
    if result.failures:
        sequence_summary.print_failures(result, openjd=options["style"] == "openjd")
    written = _write_products(products, result)
    seconds = time.perf_counter() - started
    if options["as_json"]:
        sequence_summary.print_json(result, written, seconds)
    elif not options["quiet"]:
        sequence_summary.print_summary(result, written, seconds)
    if result.failures:
        raise click.exceptions.Exit(SOME_FAILED)


def _needs(options: Mapping[str, Any]) -> Needs:
    needs: dict[str, tuple[bool, str]] = {
        "workers": (
            options["dask"] is None or is_asked(options),
            "cannot be combined with --dask, which has workers of its own",
        ),
        "as_json": (
            options["style"] != "openjd",
            "cannot be combined with --progress openjd, which prints to stdout too",
        ),
    }
    has_curve = options["exposure_curve"] is not None
    return needs | dict.fromkeys(
        ("units", "ev"), (not has_curve, "cannot be combined with --exposure-curve")
    )


def _plan_from_options(context: click.Context) -> Plan:
    """Return all frames that the options ask for.

    Raises
    ------
    click.UsageError
        If options contradict each other or leave the frames open.
    SkybakeError
        If a value, the preset, or a file that an option names cannot be used.
    """
    options = context.params
    times = span_from_options(context)
    settings = map_settings(
        options,
        clouds_quality=options["clouds_quality"],
        moon=moon_by_place(options),
        night=night_from_options(options),
        sensor=sensor_from_options(options),
        moonlight=moonlight_of_sequence(options),
    )
    changes = changes_from_options(context)

    from skybake.sequence.planning import plan_sequence

    ranges = tuple((key, values.number_range(value)) for key, value in changes.values)
    with usage_faults(context, times="--from and --to"):
        plan = plan_sequence(
            options["preset"],
            frames=options["frames"],
            times=times,
            sun_elevation=options["sun_elevation"] if times is None else None,
            sun_azimuth=options["sun_azimuth"] if times is None else None,
            altitude=options["altitude"],
            sun_distance=options["sun_distance"],
            eclipses=options["eclipse"] != "off",
            changes=replace(changes, values=ranges),
            settings=settings,
            exposure_curve=options["exposure_curve"],
            cloud_time=options["cloud_time"],
            moon_path=moon_path_from_options(options),
            output=options["output"],
            preview=options["preview"] == BESIDE or options["preview"] or False,
            night_scale=is_scale_open(options) and options["exposure_curve"] is None,
        )
    check_clouds(context, *plan.planets)
    return plan


def _bake(plan: Plan, part: Plan, products: Products, options: Mapping[str, Any]) -> SequenceResult:
    from skybake.baking import late_kernels
    from skybake.sequence.bake import check_sequence, frame_pool
    from skybake.sequence.run import bake_frames

    quiet = options["quiet"]
    check_sequence(part, products)
    if not quiet:
        announce_kernels()
    with (
        late_kernels.compiled_in_background(),
        frame_pool(
            plan,
            part,
            products=products,
            picture=picture_from_options(options, options["preview_ev"]),
            skip_existing=options["skip_existing"],
            workers=options["workers"],
            dask=options["dask"],
            notice=None if quiet else notice,
        ) as run,
        frame_progress(options["style"], len(part.frames), quiet=quiet) as tell,
    ):
        return bake_frames(part, run, retries=options["retry"], tell=tell, keep=products.keep)


def _write_products(products: Products, result: SequenceResult) -> list[Path]:
    """Write them; where frames failed, their failure determines the exit status."""
    try:
        return products.write(result)
    except SkybakeError as error:
        if not result.failures:
            raise
        notice(str(error))
        return []
