"""Names of the files of a map."""

from __future__ import annotations

import math
from pathlib import Path

from skybake.baking.settings import MapSettings
from skybake.errors import InputError
from skybake.preset import Planet
from skybake.projection.cubemap import FACES


def default_path(planet: Planet, settings: MapSettings) -> Path:
    """Name that says what a map is, as ``mars_sun+05.00deg_equirect.exr``."""
    elevation = f"{math.degrees(settings.sun_elevation):+06.2f}deg"
    altitude = f"_{settings.altitude * 1e3:g}m" if settings.altitude > 0.0 else ""
    return Path(f"{planet.name}_sun{elevation}{altitude}_{settings.projection}.exr")


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
