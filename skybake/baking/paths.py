"""Names of the files of a map."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from skybake.baking.settings import MapSettings
from skybake.errors import InputError
from skybake.preset import Planet
from skybake.projection.cubemap import FACES

PLAIN = MapSettings()

LONGEST_VALUE = 12
LONGEST_CHANGES = 40
"""Longest value, and longest of all changes together, that stands in a name. [character]"""

_SAFE = re.compile(r"[A-Za-z0-9_.+-]+")
_DISCS = {"include": "", "exclude": "nodisc", "only": "disc"}


def default_path(planet: Planet, settings: MapSettings) -> Path:
    """Name that says what a map is, as ``mars_sun+05.00deg_equirect.exr``.

    What was changed of the preset stands behind its name, as
    ``mars_dust.optical_depth=2_sun+05.00deg_equirect.exr``, or if that were long six
    digits of its digest; settings other than the default ones follow the sun, such that
    maps of other light have other names. Size, pixel type and compression do not show.
    """
    projection = settings.projection
    if projection == "cubemap" and settings.cube_layout != PLAIN.cube_layout:
        projection = f"{projection}_{settings.cube_layout}"
    parts = (
        world_name(planet),
        f"sun{math.degrees(settings.sun_elevation):+06.2f}deg",
        _bearing(settings.sun_azimuth),
        f"{settings.altitude * 1e3:g}m" if settings.altitude > 0.0 else "",
        settings.method if settings.method != PLAIN.method else "",
        _DISCS[settings.sun_disc],
        settings.colorspace if settings.colorspace != PLAIN.colorspace else "",
        _scale(settings),
        "clamped" if settings.clamp_negative else "",
        projection,
    )
    return Path(f"{'_'.join(filter(None, parts))}.exr")


def world_name(planet: Planet) -> str:
    """Name of a planet, and what was set of its preset if there is anything."""
    changes = planet.recipe.get("set")
    return f"{planet.name}_{_changes_name(changes)}" if changes else planet.name


def _changes_name(changes: Mapping[str, Any]) -> str:
    values = {
        key.removeprefix("constituents."): value if isinstance(value, str) else json.dumps(value)
        for key, value in changes.items()
    }
    name = "_".join(f"{key}={value}" for key, value in values.items())
    is_short = all(len(value) <= LONGEST_VALUE for value in values.values())
    is_short &= len(name) <= LONGEST_CHANGES
    if is_short and all(_SAFE.fullmatch(value) for value in values.values()):
        return name
    return sha256(json.dumps(changes, sort_keys=True, default=str).encode()).hexdigest()[:6]


def _bearing(azimuth: float) -> str:
    degrees = round(math.degrees(azimuth), 2) % 360.0
    return "" if degrees == math.degrees(PLAIN.sun_azimuth) else f"az{degrees:06.2f}deg"


def _scale(settings: MapSettings) -> str:
    if settings.white_luminance == PLAIN.white_luminance:
        return ""
    return settings.units if settings.ev is None else f"ev{settings.ev:g}"


def map_paths(target: Path, settings: MapSettings) -> tuple[Path, ...]:
    """Return the files of a map: one, or one for each of the `FACES`.

    Raises
    ------
    InputError
        If the file format cannot hold the cube's layout.
    """
    if settings.projection == "equirect" or settings.cube_layout == "cross":
        return (target,)
    if settings.cube_layout == "exr":
        if target.suffix.lower() != ".exr":
            raise InputError(f"{target}: suffix must be .exr for the cube layout exr")
        return (target,)
    return tuple(face_path(target, face) for face in FACES)


def face_path(target: Path, face: str) -> Path:
    """Name of a face's file."""
    if "{face}" in target.name:
        return target.with_name(target.name.replace("{face}", face))
    return target.with_name(f"{target.stem}_{face}{target.suffix}")
