"""What a sequence leaves beside its maps: manifests, a contact sheet, a moving picture."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import click

from skybake.commands.course import output_pattern
from skybake.commands.emit import HOW, arguments
from skybake.errors import OutputError
from skybake.formats.targets import check_target
from skybake.sequence.animation import STILL_WIDTH, check_animation, write_animation
from skybake.sequence.frame import Outcome
from skybake.sequence.manifest import (
    FrameRecord,
    SequenceHeader,
    write_csv,
    write_manifest,
)
from skybake.sequence.plan import Frame, Plan
from skybake.sequence.run import Result
from skybake.sequence.sheet import TILE_WIDTH, check_sheet, contact_sheet
from skybake.sequence.thumbnails import Thumbnails
from skybake.sequence.usd import check_usd, write_usd


class Products:
    """Files about a sequence, written when its frames are done.

    Parameters
    ----------
    plan : Plan
        All of the sequence.
    context : click.Context
        With the options of ``skybake sequence``.
    """

    def __init__(self, plan: Plan, context: click.Context) -> None:
        options = context.params
        self._plan = plan
        self._manifests = list(options["manifests"]) or _default_manifests(plan, options)
        self._sheet: Path | None = options["contact_sheet"]
        self._animation: Path | None = options["animate"]
        self._curve: Path | None = options["exposure_curve"]
        pictures = [path for path in (self._animation, self._sheet) if path is not None]
        self._thumbnails = Thumbnails(pictures[0].parent if pictures else Path())
        self._header = _header(plan, options["fps"], arguments(context, HOW))

    @property
    def paths(self) -> list[Path]:
        """All files."""
        pictures = (self._animation, self._sheet)
        return [*self._manifests, *(path for path in pictures if path is not None)]

    def keep(self, outcome: Outcome) -> Outcome:
        """Take the thumbnails of a frame, and return it without them."""
        return self._thumbnails.keep(outcome)

    def check(self) -> None:
        """Raise what can be said of the files before anything is computed.

        Raises
        ------
        SkybakeError
            If one cannot be written.
        """
        for path in self._manifests:
            if self._curve is not None and path.resolve() == self._curve.resolve():
                raise OutputError(f"{path}: must not be the exposure curve, which is read")
            if path.suffix.lower() == ".usda":
                maps = (_seen_from(path.parent, frame.output) for frame in self._plan.frames)
                check_usd(path, self._header.projection, maps)
            else:
                check_target(path)
        if self._sheet is not None:
            check_sheet(self._sheet)
        if self._animation is not None:
            check_animation(self._animation, self._header.fps)

    def write(self, result: Result) -> list[Path]:
        """Write the files and return their names; of no frames none."""
        outcomes = result.outcomes
        if not outcomes:
            return []
        frames = {frame.number: frame for frame in self._plan.frames}
        for path in self._manifests:
            records = [
                _record(frames[outcome.number], outcome, path.parent) for outcome in outcomes
            ]
            suffix = path.suffix.lower()
            if suffix == ".csv":
                write_csv(path, records)
            elif suffix == ".usda":
                write_usd(path, self._header, records)
            else:
                write_manifest(path, self._header, records)
        numbers = [outcome.number for outcome in outcomes]
        if self._animation is not None:
            stills = self._thumbnails.pictures(STILL_WIDTH, numbers)
            write_animation(self._animation, stills, self._header.fps)
        if self._sheet is not None:
            tiles = self._thumbnails.pictures(TILE_WIDTH, numbers)
            labels = [_label(frames[outcome.number]) for outcome in outcomes]
            contact_sheet(self._sheet, tiles, labels, title=self._plan.planets[0].title)
        return self.paths


def _default_manifests(plan: Plan, options: Mapping[str, Any]) -> list[Path]:
    """JSON beside the maps; a part of a sequence would take that of another part."""
    if options["only"] is not None:
        return []
    pattern = output_pattern(options)
    before = pattern.before.replace("{face}", "").removesuffix(".exr").removesuffix(".hdr")
    stem = before.rstrip("._-")
    return [pattern.folder / f"{stem or plan.planets[0].name}.sequence.json"]


def _header(plan: Plan, fps: float, command: list[str]) -> SequenceHeader:
    planet, settings = plan.planets[0], plan.frames[0].settings
    maps = [frame.settings.recipe() for frame in plan.frames]
    worlds = [planet.recipe for planet in plan.planets]
    return SequenceHeader(
        preset=planet.name,
        projection=settings.projection,
        colorspace=settings.colorspace,
        sun_disc=settings.sun_disc,
        sun_angular_diameter_deg=math.degrees(2.0 * planet.star.angular_radius),
        recipe={"map": _common(maps), "preset": _common(worlds), "command": command},
        fps=fps,
    )


def _common(recipes: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return what recipes have in common, tables in tables too."""
    first, *others = recipes
    common = {}
    for key, value in first.items():
        values = [other.get(key) for other in others]
        tables = [table for table in (value, *values) if isinstance(table, Mapping)]
        if all(other == value for other in values):
            common[key] = value
        elif len(tables) == len(recipes):
            common[key] = _common(tables)
    return common


def _record(frame: Frame, outcome: Outcome, folder: Path) -> FrameRecord:
    settings, light = frame.settings, outcome.light
    time = frame.attributes.get("skybake:time")
    return FrameRecord(
        frame=frame.number,
        time=None if time is None else str(time),
        label=frame.label,
        sun_elevation_deg=math.degrees(settings.sun_elevation),
        sun_azimuth_deg=math.degrees(settings.sun_azimuth),
        altitude_m=settings.altitude * 1e3,
        sun_direction=light.sun_direction,
        sun_colour=light.sun_colour,
        sun_illuminance_lux=light.direct_normal_illuminance,
        direct_illuminance_lux=light.direct_illuminance,
        sky_illuminance_lux=light.sky_illuminance,
        white_luminance_cd_m2=settings.white_luminance,
        exposure_ev=outcome.ev,
        files=tuple(_seen_from(folder, path) for path in outcome.files),
        sha256=outcome.sha256,
        preview=None if frame.preview is None else _seen_from(folder, frame.preview),
    )


def _seen_from(folder: Path, path: Path) -> str:
    return Path(os.path.relpath(path, folder)).as_posix()


def _label(frame: Frame) -> str:
    sun = f"sun {math.degrees(frame.settings.sun_elevation):.1f} deg"
    time = (frame.label or str(frame.number)).removesuffix(":00")
    if frame.label and "skybake:time" in frame.attributes:
        time = f"{datetime.fromisoformat(frame.label):%Y-%m-%d %H:%M}"
    return f"{time}  {sun}"
