"""From the options of ``skybake sequence`` to its frames."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake import input_files
from skybake.commands import moment, place, request, world
from skybake.errors import InputError
from skybake.sequence.ramp import Ramp, shares

if TYPE_CHECKING:
    from skybake.baking import MapSettings
    from skybake.preset import Planet
    from skybake.sequence.frames import FramePattern
    from skybake.sequence.plan import Plan

_NUMBER = r"[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\.\.({_NUMBER})", re.ASCII)


def plan_from_options(context: click.Context) -> Plan:
    """Return all frames that the options ask for.

    Raises
    ------
    click.UsageError
        If options contradict each other or leave the frames open.
    SkybakeError
        If a value, the preset, or a file that an option names cannot be used.
    """
    options = context.params
    moments = _moments(context)
    numbers = _numbers(options, moments)

    from skybake.sequence.plan import Frame, Plan

    along = shares(numbers)
    planets = _planets(options, along)
    if options["output"] is None:
        options["output"] = _default_output(planets)
    pattern = output_pattern(options, numbers)
    previews = None
    if options["preview"] not in {None, request.BESIDE}:
        previews = _pattern("--preview", str(options["preview"]), numbers)
    curve = _exposure_curve(options)
    frames = []
    for i, (number, share) in enumerate(zip(numbers, along, strict=True)):
        when = moments[number - numbers[0] if options["every"] is None else i] if moments else None
        output = pattern.path(number)
        preview = previews.path(number) if previews else options["preview"]
        settings = _settings(options, share, when)
        if curve is not None:
            settings = replace(settings, ev=_interpolated(curve, number))
        frames.append(
            Frame(
                number=number,
                world=min(i, len(planets) - 1),
                settings=settings,
                output=output,
                preview=request.preview_path(preview, output),
                label=None if when is None else when.label,
                attributes={} if when is None else when.attributes,
            )
        )
    return Plan(planets, tuple(frames))


def part_of(plan: Plan, only: tuple[int, ...] | None) -> Plan:
    """Return the plan with the frames of ``--only``, all without it.

    Numbers between the plan's frames are let pass: some farms name ranges without steps.

    Raises
    ------
    click.UsageError
        If there is none of them, or one lies before or beyond all frames.
    """
    if only is None:
        return plan
    part = plan.only(only)
    first, last = plan.frames[0].number, plan.frames[-1].number
    outside = next((number for number in only if not first <= number <= last), None)
    if outside is not None or not part.frames:
        raise click.UsageError(
            f"--only: must name frames of {first}-{last}, "
            f"got {only[0] if outside is None else outside}"
        )
    return part


def output_pattern(options: Mapping[str, Any], numbers: Sequence[int] = ()) -> FramePattern:
    """Return where the maps go, as `plan_from_options` has left it in the options.

    Raises
    ------
    click.UsageError
        If the option is no pattern, or has no place for the numbers of several frames.
    """
    return _pattern("--output", str(options["output"]), numbers)


def _default_output(planets: Sequence[Planet]) -> Path:
    """Name of the world, with what was set of it, unless that changes from frame to frame."""
    from skybake.baking.paths import world_name

    name = world_name(planets[0]) if len(planets) == 1 else planets[0].name
    return Path(f"{name}.####.exr")


def _pattern(option: str, text: str, numbers: Sequence[int]) -> FramePattern:
    from skybake.sequence.frames import FramePattern

    try:
        pattern = FramePattern.parse(text)
        pattern.check(numbers)
    except InputError as error:
        raise click.UsageError(f"{option}: {error}") from error
    return pattern


def _moments(context: click.Context) -> list[moment.Moment] | None:
    """Moments of a time span; None if the sun's path is given by angles."""
    options = context.params
    if options["start"] is None and options["end"] is None:
        if options["every"] is not None:
            raise click.UsageError("--every: needs --from and --to")
        place.refuse_places(options, "--from and --to")
        return None
    if options["start"] is None or options["end"] is None:
        raise click.UsageError("--from, --to: each needs the other")
    moment.refuse_sun(context, "--from and --to")
    frames = options["frames"]
    if options["every"] is None and frames is None:
        raise click.UsageError("--frames: is needed, or --every")
    count = None if frames is None else frames[-1] - frames[0] + 1
    return moment.moments(options, count)


def _numbers(options: dict[str, Any], moments: list[moment.Moment] | None) -> tuple[int, ...]:
    frames: tuple[int, ...] | None = options["frames"]
    if moments is None or options["every"] is None:
        if frames is None:
            raise click.UsageError("--frames: is needed, as 1-96")
        return frames
    if frames is None:
        return tuple(range(1, len(moments) + 1))
    if len(frames) != len(moments):
        raise click.UsageError(
            f"--frames: must be as many as --every makes, which is {len(moments)}, "
            f"got {len(frames)}"
        )
    return frames


def _settings(options: dict[str, Any], share: float, when: moment.Moment | None) -> MapSettings:
    sun = (
        (options["sun_elevation"].at(share), options["sun_azimuth"].at(share))
        if when is None
        else (when.sun_elevation, when.sun_azimuth)
    )
    here = {
        "sun_elevation": sun[0],
        "sun_azimuth": sun[1],
        "altitude": options["altitude"].at(share),
    }
    return request.map_settings({**options, **here})


def _planets(options: dict[str, Any], along: Sequence[float]) -> tuple[Planet, ...]:
    """Worlds of the frames: one, or one for each if something of it changes."""
    changes = [(key, _ramp(value)) for key, value in options["changes"]]
    if not any(ramp for _, ramp in changes):
        return (world.load_world(options["preset"], options),)
    return tuple(
        world.load_world(
            options["preset"],
            {
                **options,
                "changes": tuple(
                    (key, value if ramp is None else _plain(ramp.at(share)))
                    for (key, value), (_, ramp) in zip(options["changes"], changes, strict=True)
                ),
            },
        )
        for share in along
    )


def _ramp(value: Any) -> Ramp | None:
    found = _RANGE.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        return None
    first, last = float(found[1]), float(found[2])
    return Ramp(first, last) if math.isfinite(first) and math.isfinite(last) else None


def _plain(number: float) -> float:
    """Return a number as one would type it, since the text of a recipe tells 2 from 2.0."""
    return int(number) if number.is_integer() else number


def _exposure_curve(options: dict[str, Any]) -> list[tuple[float, float]] | None:
    """Frames and exposure values, ascending."""
    path: Path | None = options["exposure_curve"]
    if path is None:
        return None
    text = input_files.read_text(path, str(path), input_files.LARGEST_TABLE)
    try:
        reader = csv.DictReader(io.StringIO(text, newline=""))
        columns, rows = list(reader.fieldnames or ()), list(reader)
    except csv.Error as error:
        raise InputError(f"{path}: must be a CSV file that can be read, got {error}") from error
    if columns.count("frame") != 1 or columns.count("ev") != 1:
        found = ", ".join(columns) or "nothing"
        raise InputError(f"{path}: must hold the columns frame and ev, got {found}")
    curve: list[tuple[float, float]] = []
    for line, row in enumerate(rows, start=2):
        try:
            point = float(row["frame"]), float(row["ev"])
        except (TypeError, ValueError) as error:
            raise InputError(
                f"{path}: line {line}: must hold numbers under frame and ev, got {dict(row)}"
            ) from error
        if not math.isfinite(point[0]):
            raise InputError(f"{path}: line {line}: frame must be finite, got {point[0]:g}")
        if not -30.0 <= point[1] <= 40.0:
            raise InputError(f"{path}: line {line}: ev must be from -30 to 40, got {point[1]:g}")
        if curve and point[0] <= curve[-1][0]:
            raise InputError(f"{path}: line {line}: frames must ascend, got {point[0]:g}")
        curve.append(point)
    if not curve:
        raise InputError(f"{path}: must hold at least one frame and its ev, got none")
    return curve


def _interpolated(curve: list[tuple[float, float]], frame: int) -> float:
    """Value of a curve that is straight between its points and level beyond them."""
    for (first, low), (last, high) in pairwise(curve):
        if first <= frame <= last:
            return low + (high - low) * (frame - first) / (last - first)
    return curve[0][1] if frame < curve[0][0] else curve[-1][1]
