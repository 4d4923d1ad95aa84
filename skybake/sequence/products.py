"""Files about a sequence, beside its maps: manifests, contact sheet, animated picture."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.lit_moon import LitMoon
from skybake.errors import OutputError
from skybake.formats.targets import check_target
from skybake.formats.whole_files import replace_when_whole
from skybake.image.moon_figures import ColourAndLight
from skybake.optics.spectrum import star_at
from skybake.sequence.animation import STILL_WIDTH, check_animation, write_animation
from skybake.sequence.frame import FrameOutcome
from skybake.sequence.frames import FramePattern
from skybake.sequence.manifest import (
    FrameRecord,
    SequenceHeader,
    ascending,
    write_csv,
    write_manifest,
)
from skybake.sequence.plan import Frame, Plan
from skybake.sequence.run import SequenceResult
from skybake.sequence.sheet import TILE_WIDTH, check_sheet, contact_sheet
from skybake.sequence.thumbnails import Thumbnails
from skybake.sidecar.dome_and_sun import Common, DistantLight, DomeAndSun
from skybake.sidecar.light_file import seen_from
from skybake.sidecar.map_light import disc_diameter, holds_sun
from skybake.sidecar.usd import check_usd, usd_layer
from skybake.units import degrees, metres


@dataclass(frozen=True)
class Products:
    """Files about a sequence, written when its frames are done.

    Attributes
    ----------
    plan : Plan
        All of the sequence.
    manifests : tuple of Path
        Times, sun, light, files and digests of all frames: ``.json``, ``.csv`` or
        ``.usda``.
    contact_sheet : Path or None
        One picture with all frames side by side, ``.png``.
    animation : Path or None
        An animated picture, ``.webp`` or ``.gif``.
    fps : float
        Frames per second of the animated picture and of USD.
    command : tuple of str
        A command that bakes the same frames, for the manifest.
    """

    plan: Plan
    manifests: tuple[Path, ...] = ()
    contact_sheet: Path | None = None
    animation: Path | None = None
    fps: float = 24.0
    command: tuple[str, ...] = ()

    @cached_property
    def _thumbnails(self) -> Thumbnails:
        pictures = [path for path in (self.animation, self.contact_sheet) if path is not None]
        return Thumbnails(pictures[0].parent if pictures else Path())

    @property
    def paths(self) -> list[Path]:
        """All files."""
        pictures = (self.animation, self.contact_sheet)
        return [*self.manifests, *(path for path in pictures if path is not None)]

    @property
    def thumbnail_widths(self) -> tuple[int, ...]:
        """Widths of the thumbnails of each frame that the pictures consist of. [pixel]"""
        widths = ((self.contact_sheet, TILE_WIDTH), (self.animation, STILL_WIDTH))
        return tuple(width for path, width in widths if path is not None)

    def keep(self, outcome: FrameOutcome) -> FrameOutcome:
        """Take the thumbnails of a frame, and return it without them."""
        return self._thumbnails.keep(outcome)

    def check(self) -> None:
        """Raise the errors of the files that can be found before anything is computed.

        Raises
        ------
        SkybakeError
            If one cannot be written.
        """
        curve = None if self.plan.exposure_curve is None else self.plan.exposure_curve.path
        for path in self.manifests:
            if curve is not None and path.resolve() == curve.resolve():
                raise OutputError(
                    f"{path}: cannot be written, because the exposure curve is read from it"
                )
            if path.suffix.lower() == ".usda":
                maps = seen_from(path.parent, [frame.output for frame in self.plan.frames])
                check_usd(path, self.plan.frames[0].settings.view.projection, maps)
            else:
                check_target(path)
        if self.contact_sheet is not None:
            check_sheet(self.contact_sheet)
        if self.animation is not None:
            check_animation(self.animation, self.fps)

    def write(self, result: SequenceResult) -> list[Path]:
        """Write the files and return their names; none if there are no frames."""
        outcomes = result.outcomes
        if not outcomes:
            return []
        frames = {frame.number: frame for frame in self.plan.frames}
        for path in self.manifests:
            records = [
                _record(self.plan, frames[outcome.number], outcome, path.parent)
                for outcome in outcomes
            ]
            suffix = path.suffix.lower()
            if suffix == ".csv":
                write_csv(path, records)
            elif suffix == ".usda":
                _write_usd(path, _header(self), records)
            else:
                write_manifest(path, _header(self), records)
        numbers = [outcome.number for outcome in outcomes]
        if self.animation is not None:
            stills = self._thumbnails.pictures(STILL_WIDTH, numbers)
            write_animation(self.animation, stills, self.fps)
        if self.contact_sheet is not None:
            tiles = self._thumbnails.pictures(TILE_WIDTH, numbers)
            labels = [tile_label(frames[outcome.number], outcome) for outcome in outcomes]
            contact_sheet(self.contact_sheet, tiles, labels, title=self.plan.planets[0].title)
        return self.paths


def default_manifest(plan: Plan) -> Path:
    """Name of the manifest of a plan: JSON beside the maps."""
    pattern = FramePattern.parse(str(plan.output or plan.frames[0].output))
    before = pattern.before.replace("{face}", "").removesuffix(".exr").removesuffix(".hdr")
    stem = before.rstrip("._-")
    return pattern.folder / f"{stem or plan.planets[0].name}.sequence.json"


def _header(products: Products) -> SequenceHeader:
    plan = products.plan
    planet, settings = plan.planets[0], plan.frames[0].settings
    maps = [
        frame.settings.recipe(has_clouds=bool(plan.planet(frame).clouds)) for frame in plan.frames
    ]
    worlds = [planet.recipe for planet in plan.planets]
    return SequenceHeader(
        preset=planet.name,
        projection=settings.view.projection.name,
        colorspace=settings.encoding.colorspace,
        sun_disc=settings.lighting.sun_disc,
        sun_angular_diameter_deg=math.degrees(disc_diameter(planet, settings.lighting)),
        recipe={"map": _common(maps), "preset": _common(worlds), "command": list(products.command)},
        fps=products.fps,
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


def _record(plan: Plan, frame: Frame, outcome: FrameOutcome, folder: Path) -> FrameRecord:
    settings, light = frame.settings, outcome.light
    planet = plan.planet(frame)
    star = star_at(planet.star, settings.lighting.sun_distance)
    time = frame.attributes.get("skybake:time")
    return FrameRecord(
        frame=frame.number,
        time=None if time is None else str(time),
        label=frame.label,
        sun_elevation_deg=degrees(settings.lighting.sun_elevation),
        sun_azimuth_deg=degrees(settings.lighting.sun_azimuth),
        altitude_m=metres(settings.view.altitude),
        sun_direction=light.sun_direction,
        sun_colour=light.sun_colour,
        sun_distance_au=star.distance / ASTRONOMICAL_UNIT,
        sun_angular_diameter_deg=math.degrees(disc_diameter(planet, settings.lighting)),
        sun_illuminance_lux=light.direct_normal_illuminance,
        direct_illuminance_lux=light.direct_illuminance,
        sky_illuminance_lux=light.sky_illuminance,
        white_luminance_cd_m2=settings.encoding.white_luminance,
        exposure_ev=outcome.ev,
        files=tuple(seen_from(folder, outcome.files)),
        sha256=outcome.sha256,
        preview=None if frame.preview is None else seen_from(folder, [frame.preview])[0],
        moon=_moon(settings.moonlight.moon, outcome.moon),
    )


def _moon(moon: LitMoon | None, light: ColourAndLight | None) -> DistantLight | None:
    if moon is None or light is None:
        return None
    colour, illuminance = light
    return DistantLight(
        elevation_deg=degrees(moon.elevation),
        azimuth_deg=degrees(moon.azimuth),
        angular_diameter_deg=math.degrees(2.0 * moon.angular_radius),
        colour=colour,
        illuminance_lux=illuminance,
    )


def _write_usd(path: Path, header: SequenceHeader, records: Sequence[FrameRecord]) -> None:
    common = Common(
        preset=header.preset,
        colorspace=header.colorspace,
        sun_is_in_maps=holds_sun(header.sun_disc),
        rotation_deg=header.recipe["map"]["rotate_deg"],
        fps=header.fps,
    )
    rows = [
        DomeAndSun(
            file=record.files[0],
            **{field.name: getattr(record, field.name) for field in fields(DomeAndSun)[1:]},
        )
        for record in ascending(records)
    ]
    with replace_when_whole(path) as temporary:
        temporary.write_text(usd_layer(path, common, rows), "utf-8")


def tile_label(frame: Frame, outcome: FrameOutcome) -> str:
    """Time and sun of a frame, and below them the exposure of its tile and the light outside.

    That is the illuminance of a horizontal plane by sun and sky.
    """
    sun = f"sun {math.degrees(frame.settings.lighting.sun_elevation):.1f} deg"
    time = (frame.label or str(frame.number)).removesuffix(":00")
    if frame.label and "skybake:time" in frame.attributes:
        time = f"{datetime.fromisoformat(frame.label):%Y-%m-%d %H:%M}"
    lux = outcome.light.direct_illuminance + outcome.light.sky_illuminance
    return f"{time}  {sun}\nEV {outcome.tile_ev:.1f}  {_rounded(lux)} lx"


def _rounded(lux: float) -> str:
    """Write an illuminance with three digits, and in thousands with a space between."""
    if not 1e-3 <= lux < 1e6:
        return f"{lux:.2g}"
    rounded = float(f"{lux:.3g}")
    return f"{rounded:,.0f}".replace(",", " ") if rounded >= 100.0 else f"{rounded:g}"
