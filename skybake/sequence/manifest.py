"""What a sequence holds, frame by frame, as JSON and as CSV."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from skybake.formats.whole_files import replace_when_whole
from skybake.sequence.frames import format_frames
from skybake.sidecar.dome_and_sun import DistantLight
from skybake.version import __version__

SCHEMA = 1
"""Incremented when a key of the JSON changes its meaning or is removed."""

_AXES = {"sun_direction": "xyz", "sun_colour": "rgb", "colour": "rgb"}


@dataclass(frozen=True)
class FrameRecord:
    """One frame: when it is, its light, and its files.

    Attributes
    ----------
    frame : int
        Its number.
    time : str or None
        ISO 8601 in UTC; None if the frame has a sun but no time.
    label : str or None
        The same, human-readable and in local time.
    sun_elevation_deg, sun_azimuth_deg : float
        Geometric elevation of the sun's centre, and its compass bearing. [deg]
    altitude_m : float
        Of the observer above the ground. [m]
    sun_direction : tuple of 3 float
        Unit vector toward the sun in the maps' axes; +Y up and, without a rotation, -Z north
        and +X east.
    sun_colour : tuple of 3 float
        Of the sun's light at the observer, linear Rec. 709 of luminance 1; any if it
        gives none.
    sun_distance_au : float
        Of the sun. [au]
    sun_angular_diameter_deg : float
        Of its disc. [deg]
    sun_illuminance_lux, direct_illuminance_lux : float
        By the sun's disc, on a plane that faces it and on a horizontal one. [lx]
    sky_illuminance_lux : float
        By the sky, on a horizontal plane. [lx]
    white_luminance_cd_m2 : float
        Luminance that a pixel value of 1 stands for. [cd m⁻²]
    exposure_ev : float or None
        Exposure value of the preview.
    files : tuple of str
        The map, one file or six, as seen from the manifest's folder, with ``/``.
    sha256 : tuple of str
        Of the same files, as hexadecimal digits.
    preview : str or None
        The display-referred picture, as seen from the manifest's folder.
    moon : DistantLight or None
        The Moon, of a frame with one.
    """

    frame: int
    time: str | None
    label: str | None
    sun_elevation_deg: float
    sun_azimuth_deg: float
    altitude_m: float
    sun_direction: tuple[float, float, float]
    sun_colour: tuple[float, float, float]
    sun_distance_au: float
    sun_angular_diameter_deg: float
    sun_illuminance_lux: float
    direct_illuminance_lux: float
    sky_illuminance_lux: float
    white_luminance_cd_m2: float
    exposure_ev: float | None
    files: tuple[str, ...]
    sha256: tuple[str, ...]
    preview: str | None
    moon: DistantLight | None = None


@dataclass(frozen=True)
class SequenceHeader:
    """What all frames have in common.

    Attributes
    ----------
    preset : str
        Name of the world.
    projection : str
        Kind of the maps, a key of `skybake.projection.PROJECTIONS`.
    colorspace : str
        A name of `skybake.colour.space.COLOUR_SPACES`.
    sun_disc : {"include", "exclude", "only", "separate"}
        Whether the maps hold the sun's disc, or nothing else.
    sun_angular_diameter_deg : float
        Of the star's disc in the first frame, or of the size that it is drawn in. [deg]
    recipe : mapping
        What the maps are baked from, fit for JSON.
    fps : float
        Frames per second, for players and renderers.
    skybake : str
        Version that baked them.
    """

    preset: str
    projection: str
    colorspace: str
    sun_disc: str
    sun_angular_diameter_deg: float
    recipe: Mapping[str, Any]
    fps: float = 24.0
    skybake: str = __version__


def ascending(records: Iterable[FrameRecord]) -> list[FrameRecord]:
    """Return records in the order of their frames."""
    return sorted(records, key=lambda record: record.frame)


def write_manifest(path: Path, header: SequenceHeader, records: Iterable[FrameRecord]) -> None:
    """Write a sequence as JSON.

    Parameters
    ----------
    path : Path
        By convention ``*.sequence.json``.
    header : SequenceHeader
        Its keys are at the top level, after ``schema`` and ``frames``.
    records : iterable of FrameRecord
        In any order; in the file they ascend, under ``records``.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    rows = ascending(records)
    document = {
        "schema": SCHEMA,
        "frames": format_frames(row.frame for row in rows),
        **asdict(header),
        "records": [_document(row) for row in rows],
    }
    with replace_when_whole(path) as temporary:
        temporary.write_text(json.dumps(document, indent=2, allow_nan=False) + "\n", "utf-8")


def _document(record: FrameRecord) -> dict[str, Any]:
    """Return a record fit for JSON; one without a Moon does not speak of it."""
    document = asdict(record)
    if record.moon is None:
        del document["moon"]
    return document


def write_csv(path: Path, records: Iterable[FrameRecord]) -> None:
    """Write the records as CSV: a row for each frame, an empty cell for None.

    Columns of the Moon are there if a frame has one.

    Vectors take three columns, ``sun_direction_x`` and so on; the six files of a cube
    share one cell, separated by ``;``.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    rows = ascending(records)
    has_moon = any(row.moon is not None for row in rows)
    names = [field.name for field in fields(FrameRecord) if field.name != "moon"]
    of_moon = [field.name for field in fields(DistantLight)] if has_moon else []
    writer.writerow([*_columns(names), *(f"moon_{name}" for name in _columns(of_moon))])
    for row in rows:
        writer.writerow([*_cells(row, names), *_cells(row.moon, of_moon)])
    with replace_when_whole(path) as temporary:
        temporary.write_bytes(text.getvalue().encode("utf-8", "surrogateescape"))


def _columns(names: Iterable[str]) -> Iterator[str]:
    for name in names:
        if name in _AXES:
            yield from (f"{name}_{axis}" for axis in _AXES[name])
        else:
            yield name


def _cells(record: FrameRecord | DistantLight | None, names: Iterable[str]) -> Iterator[str]:
    for name in names:
        value = getattr(record, name, None)
        if name in _AXES:
            yield from (f"{component:.9g}" for component in value) if value else ("", "", "")
        elif isinstance(value, tuple):
            yield ";".join(value)
        elif isinstance(value, float):
            yield f"{value:.9g}"
        else:
            yield "" if value is None else str(value)
