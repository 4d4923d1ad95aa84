"""What ``skybake sequence`` prints of its frames before they are baked and after."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from skybake.commands.printing.notices import notice, warn

if TYPE_CHECKING:
    from skybake.sequence.plan import Plan
    from skybake.sequence.run import SequenceResult


def print_plan(plan: Plan, *, as_json: bool) -> None:
    """Print each frame's sun, time and file, or everything about it as one JSON object."""
    frames = plan.summary()
    if as_json:
        click.echo(json.dumps({"frames": frames}))
        return
    for frame in frames:
        label = f"  {frame['label']}" if frame["label"] else ""
        click.echo(
            f"{frame['frame']}  sun {frame['sun_elevation_deg']:.2f}deg at "
            f"{frame['sun_azimuth_deg']:.2f}deg, altitude {frame['altitude_m']:g}m"
            f"{label}  {frame['file']}"
        )


def print_summary(result: SequenceResult, written: Sequence[Path], seconds: float) -> None:
    """Print the files about the sequence and the number of frames, human-readable."""
    for path in written:
        click.echo(path)
    baked, skipped = _counts(result)
    click.echo(
        f"{baked} frames baked, {skipped} skipped, {len(result.failures)} failed; {seconds:.1f} s"
    )


def print_json(result: SequenceResult, written: Sequence[Path], seconds: float) -> None:
    """Print one JSON object on one line, see docs/cli.md."""
    from skybake.sequence.frames import format_frames

    baked, skipped = _counts(result)
    summary = {
        "baked": baked,
        "skipped": skipped,
        "failed": {str(number): message for number, message in result.failures.items()},
        "warnings": {text: format_frames(numbers) for text, numbers in _warnings(result).items()},
        "files": [str(path) for outcome in result.outcomes for path in outcome.files],
        "written": [str(path) for path in written],
        "seconds": round(seconds, 3),
    }
    click.echo(json.dumps(summary))


def print_warnings(result: SequenceResult) -> None:
    """Print what a user should know of frames, with their numbers."""
    from skybake.sequence.frames import format_frames

    for text, numbers in _warnings(result).items():
        warn(f"frames {format_frames(numbers)}: {text}")


def print_failures(result: SequenceResult, *, openjd: bool) -> None:
    """Print which frames failed and why; also as an Open Job Description expects it."""
    from skybake.sequence.frames import format_frames

    for number, message in result.failures.items():
        notice(f"frame {number}: {message}")
    line = f"frames failed: {format_frames(result.failures)}"
    notice(line)
    if openjd:
        click.echo(f"openjd_fail: {line}")


def _warnings(result: SequenceResult) -> dict[str, list[int]]:
    """Return the frames of each warning."""
    found: dict[str, list[int]] = {}
    for outcome in result.outcomes:
        for text in outcome.warnings:
            found.setdefault(text, []).append(outcome.number)
    return found


def _counts(result: SequenceResult) -> tuple[int, int]:
    """How many frames were baked, and how many were skipped."""
    baked = sum(outcome.is_new for outcome in result.outcomes)
    return baked, len(result.outcomes) - baked
