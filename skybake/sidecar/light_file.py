"""Files about the light of one map, in the formats that their suffixes name."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from skybake.errors import InputError
from skybake.formats.spec import Attribute
from skybake.formats.targets import check_target, faults_of
from skybake.formats.whole_files import WholeFiles
from skybake.image.moon_figures import MoonFigures
from skybake.projection.chart import Projection
from skybake.sidecar.blender import blender_script
from skybake.sidecar.dome_and_sun import Common, DistantLight, DomeAndSun, check_dome
from skybake.sidecar.light_json import light_json
from skybake.sidecar.map_light import MapLight
from skybake.sidecar.usd import check_usd, usd_layer
from skybake.units import degrees

SUFFIXES = (".json", ".usda", ".py")
"""JSON, Pixar's USD, and a script for Blender."""


def check_light_files(paths: Iterable[Path], projection: Projection, files: Sequence[Path]) -> None:
    """Raise the errors of light files that can be found before anything is computed.

    Parameters
    ----------
    paths : iterable of Path
        Each with one of `SUFFIXES`.
    projection : Projection
        Of the map.
    files : sequence of Path
        The map.

    Raises
    ------
    InputError
        If a suffix is none of them, or the format cannot refer to the map.
    OutputError
        If a file cannot be written under that name.
    """
    for path in paths:
        _check(path, projection, files)


def write_light_files(
    paths: Iterable[Path],
    light: MapLight,
    files: Sequence[Path],
    whole: WholeFiles,
    *,
    time: Attribute | None = None,
) -> None:
    """Write light files, which appear together with their map.

    Parameters
    ----------
    paths : iterable of Path
        As of `check_light_files`.
    light : MapLight
        What they tell.
    files : sequence of Path
        The map, one file or six.
    whole : WholeFiles
        The files that they are to appear with.
    time : str, optional
        Attribute of the map's files: ISO 8601 in UTC, for JSON.

    Raises
    ------
    OutputError
        If one cannot be written.
    """
    for path in paths:
        text = _text(path, light, files, None if time is None else str(time))
        with faults_of(path):
            whole.add(path).write_text(text, "utf-8")


def seen_from(folder: Path, files: Sequence[Path]) -> list[str]:
    """Return names of files relative to a folder, with ``/``."""
    return [Path(os.path.relpath(file, folder)).as_posix() for file in files]


def _check(path: Path, projection: Projection, files: Sequence[Path]) -> None:
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(
            f"{path}: suffix of a light file must be one of {', '.join(SUFFIXES)}, "
            f"got {path.suffix!r}"
        )
    if suffix == ".usda":
        check_usd(path, projection, seen_from(path.parent, files))
    elif suffix == ".py":
        check_dome(path, "the world of Blender", projection)
    check_target(path)


def _text(path: Path, light: MapLight, files: Sequence[Path], time: str | None) -> str:
    names = seen_from(path.parent, files)
    suffix = path.suffix.lower()
    if suffix == ".usda":
        return _usd(path, light, names)
    if suffix == ".py":
        return blender_script(light, names)
    return light_json(light, names, time)


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
        moon=None if light.moon is None else _moon(light.moon),
    )
    return usd_layer(path, common, [row])


def _moon(moon: MoonFigures) -> DistantLight:
    return DistantLight(
        elevation_deg=degrees(moon.elevation),
        azimuth_deg=degrees(moon.azimuth),
        angular_diameter_deg=math.degrees(moon.angular_diameter),
        colour=moon.colour,
        illuminance_lux=moon.normal_illuminance,
    )
