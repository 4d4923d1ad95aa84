"""A file about the light of one map, in the format that its suffix names."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path

from skybake.errors import InputError
from skybake.formats.spec import Attribute
from skybake.formats.targets import check_target
from skybake.formats.whole_files import WholeFiles
from skybake.projection import PROJECTIONS
from skybake.sidecar.blender import TURN, blender_script
from skybake.sidecar.light_json import light_json
from skybake.sidecar.map_light import MapLight
from skybake.sidecar.usd import Common, DomeAndSun, check_usd, usd_layer
from skybake.units import degrees

SUFFIXES = (".json", ".usda", ".py")
"""JSON, Pixar's USD, and a script for Blender."""


def check_light_file(path: Path, projection: str, files: Sequence[Path]) -> None:
    """Raise the errors of a light file that can be found before anything is computed.

    Parameters
    ----------
    path : Path
        With one of `SUFFIXES`.
    projection : str
        Of the map, a key of `skybake.projection.PROJECTIONS`.
    files : sequence of Path
        The map.

    Raises
    ------
    InputError
        If the suffix is none of them, or the format cannot refer to the map.
    OutputError
        If a file cannot be written under that name.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(
            f"{path}: suffix of a light file must be one of {', '.join(SUFFIXES)}, "
            f"got {path.suffix!r}"
        )
    if suffix == ".usda":
        check_usd(path, projection, seen_from(path.parent, files))
    elif suffix == ".py" and not PROJECTIONS[projection].lights_a_dome:
        raise InputError(
            f"{path}: the world of Blender needs a map of the projection equirect, got {projection}"
        )
    check_target(path)


def write_light_file(
    path: Path,
    light: MapLight,
    files: Sequence[Path],
    whole: WholeFiles,
    *,
    time: Attribute | None = None,
    blender_turn: float = TURN,
) -> None:
    """Write a light file, which appears together with its map.

    Parameters
    ----------
    path : Path
        As of `check_light_file`.
    light : MapLight
        What it tells.
    files : sequence of Path
        The map, one file or six.
    whole : WholeFiles
        The files that it is to appear with.
    time : str, optional
        Attribute of the map's files: ISO 8601 in UTC, for JSON.
    blender_turn : float, optional
        As of `blender_script`.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    names = seen_from(path.parent, files)
    suffix = path.suffix.lower()
    if suffix == ".usda":
        text = _usd(path, light, names)
    elif suffix == ".py":
        text = blender_script(light, names, turn=blender_turn)
    else:
        text = light_json(light, names, None if time is None else str(time))
    whole.add(path).write_text(text, "utf-8")


def seen_from(folder: Path, files: Sequence[Path]) -> list[str]:
    """Return names of files relative to a folder, with ``/``."""
    return [Path(os.path.relpath(file, folder)).as_posix() for file in files]


def _usd(path: Path, light: MapLight, names: Sequence[str]) -> str:
    common = Common(
        preset=light.preset,
        colorspace=light.colorspace,
        sun_is_in_maps=light.sun_is_in_map,
        rotation_deg=degrees(light.rotation),
    )
    row = DomeAndSun(
        file=names[0],
        white_luminance_cd_m2=light.white_luminance,
        sun_elevation_deg=degrees(light.sun_elevation),
        sun_azimuth_deg=degrees(light.sun_azimuth),
        sun_angular_diameter_deg=math.degrees(light.sun_angular_diameter),
        sun_colour=light.sun_colour,
        sun_illuminance_lux=light.direct_normal_illuminance,
    )
    return usd_layer(path, common, [row])
