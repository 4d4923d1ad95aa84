"""Cameras in files of JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from skybake.errors import InputError
from skybake.input_files import read_text
from skybake.projection.camera import (
    METRE,
    WORLD_TO_CAMERA,
    WORLD_TO_NDC,
    Camera,
    Place,
    camera_from_angles,
    camera_from_attributes,
)

LARGEST = 1 << 20
"""Size of a file. [byte]"""

UNITS = {"m": METRE, "cm": 1e-5, "mm": 1e-6, "km": 1.0, "ft": 0.3048e-3}
"""Lengths of 1 in a world, by name. [km]"""

_KEYS = (
    *(WORLD_TO_CAMERA, WORLD_TO_NDC),
    *("position", "azimuth", "elevation", "roll"),
    *("fov", "fov_vertical", "focal_length", "sensor_width", "lens_shift"),
    *("aspect", "units", "up_axis"),
)


def load_camera(
    path: Path,
    *,
    fov: float | None = None,
    aspect: float = 1.0,
    unit: float | None = None,
    up: str | None = None,
) -> Camera:
    """Read a camera.

    Parameters
    ----------
    path : Path
        A JSON object with `worldToNDC`, or `worldToCamera`, or `azimuth` and `elevation` in
        degrees, with `roll` and `position` if they are not 0. Except with `worldToNDC`, the width
        is told by `fov` or `fov_vertical` in degrees, or by `focal_length` and `sensor_width` in
        the same unit. `lens_shift` is right and up, in widths of the picture; `aspect` is width
        over height; `units` is one of `UNITS`, m unless given; `up_axis` y or z.
    fov : float, optional
        In place of what the file tells: angle that the width covers. [rad]
    aspect : float, optional
        Width over height of the picture, where the file does not tell it.
    unit : float, optional
        Length of 1 in the world, in place of `units`. [km]
    up : {"y", "z"}, optional
        In place of `up_axis`.

    Raises
    ------
    InputError
        If the file cannot be read, or does not tell a camera.
    """
    where = str(path)
    told = _read(path)
    unknown = sorted(told.keys() - set(_KEYS))
    if unknown:
        raise InputError(f"{where}: unknown key {unknown[0]!r}; known keys: {', '.join(_KEYS)}")
    unit = _unit(told, where) if unit is None else unit
    proportions = _number(told, "aspect", where, aspect) or 0.0
    if not proportions > 0.0:
        raise InputError(f"{where}: aspect must be greater than 0, got {proportions:g}")
    width = _fov(told, where, proportions) if fov is None else fov
    up = told.get("up_axis", "y") if up is None else up
    if up not in {"y", "z"}:
        raise InputError(f"{where}: up_axis must be y or z, got {up!r}")
    if WORLD_TO_CAMERA in told or WORLD_TO_NDC in told:
        camera = camera_from_attributes(
            told, where, fov=width, aspect=proportions, unit=unit, up=up
        )
    else:
        camera = _from_angles(told, where, width, proportions)
        camera = replace(camera, position=_position(told, where, unit, up))
    return _shifted(camera, told, where)


def _read(path: Path) -> dict[str, Any]:
    where = str(path)
    text = read_text(path, where, LARGEST)
    try:
        told = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{where}: must be JSON, got {error}") from error
    if not isinstance(told, dict):
        raise InputError(f"{where}: must be a JSON object, got {type(told).__name__}")
    return told


def _from_angles(told: Mapping[str, Any], where: str, fov: float | None, aspect: float) -> Camera:
    for name in ("azimuth", "elevation"):
        if name not in told:
            raise InputError(
                f"{where}: camera must be given by {WORLD_TO_CAMERA}, {WORLD_TO_NDC}, or azimuth "
                f"and elevation, got no {name}"
            )
    if fov is None:
        raise InputError(f"{where}: fov must be given, in degrees, or focal_length, sensor_width")
    azimuth, elevation, roll = (
        math.radians(_number(told, name, where, 0.0) or 0.0)
        for name in ("azimuth", "elevation", "roll")
    )
    if not abs(elevation) <= math.pi / 2.0 + 1e-9:
        raise InputError(
            f"{where}: elevation must be from -90 to 90, got {math.degrees(elevation):g}"
        )
    return camera_from_angles(azimuth, elevation, roll, fov, aspect)


def _position(told: Mapping[str, Any], where: str, unit: float, up: str) -> Place:
    x, *others = _numbers(told, "position", where, (0.0, 0.0, 0.0))
    y, z = others if up == "y" else (others[1], -others[0])
    return x * unit, y * unit, z * unit


def _shifted(camera: Camera, told: Mapping[str, Any], where: str) -> Camera:
    right, up = _numbers(told, "lens_shift", where, (0.0, 0.0))
    width = 2.0 * camera.half_width
    across, above = camera.shift
    return replace(camera, shift=(across + right * width, above + up * width))


def _unit(told: Mapping[str, Any], where: str) -> float:
    name = told.get("units", "m")
    if name not in UNITS:
        raise InputError(f"{where}: units must be one of {', '.join(UNITS)}, got {name!r}")
    return UNITS[name]


def _fov(told: Mapping[str, Any], where: str, aspect: float) -> float | None:
    """Angle that the width covers, or None if the file does not tell it. [rad]"""
    ways = [name for name in ("fov", "fov_vertical", "focal_length") if name in told]
    if not ways:
        return None
    if len(ways) > 1:
        raise InputError(f"{where}: {ways[1]} cannot be combined with {ways[0]}")
    (way,) = ways
    value = _number(told, way, where, None) or 0.0
    if way == "focal_length":
        sensor = _number(told, "sensor_width", where, None)
        if sensor is None or not (value > 0.0 and sensor > 0.0):
            raise InputError(
                f"{where}: focal_length and sensor_width must be greater than 0, got {value:g} "
                f"and {sensor}"
            )
        return 2.0 * math.atan(0.5 * sensor / value)
    if not 0.0 < value < 180.0:
        raise InputError(
            f"{where}: {way} must be greater than 0 and less than 180 deg, got {value:g}"
        )
    angle = math.radians(value)
    return angle if way == "fov" else 2.0 * math.atan(math.tan(0.5 * angle) * aspect)


def _number(
    told: Mapping[str, Any], name: str, where: str, otherwise: float | None
) -> float | None:
    value = told.get(name, otherwise)
    if value is None and name not in told:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(f"{where}: {name} must be a finite number, got {value!r}")
    return float(value)


def _numbers(
    told: Mapping[str, Any], name: str, where: str, otherwise: tuple[float, ...]
) -> tuple[float, ...]:
    values = told.get(name, otherwise)
    if not isinstance(values, list | tuple) or len(values) != len(otherwise):
        raise InputError(f"{where}: {name} must be {len(otherwise)} numbers, got {values!r}")
    return tuple(_number({name: value}, name, where, None) or 0.0 for value in values)
