"""Names of the files of a map."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from skybake.ephemeris.celestial import J2000
from skybake.errors import InputError
from skybake.formats.cube_file import is_cube_file
from skybake.image.night import Night
from skybake.image.sensor import Sensor
from skybake.image.settings import Clouds, Encoding, Lighting, MapSettings
from skybake.preset import Planet
from skybake.projection import Cubemap, Projection

PLAIN_LIGHTING, PLAIN_ENCODING = Lighting(), Encoding()
PLAIN_CLOUDS, PLAIN_NIGHT = Clouds(), Night()

LONGEST_VALUE = 12
LONGEST_CHANGES = 40
"""Longest value, and longest of all changes together, that is part of a name. [character]"""

_SAFE = re.compile(r"[A-Za-z0-9_.-]+")
_DISCS = {"include": "", "exclude": "nodisc", "only": "disc", "separate": "separate"}


def default_path(planet: Planet, settings: MapSettings) -> Path:
    """Name that describes a map, as ``mars_sun05.00deg_equirect.exr``.

    What was changed of the preset follows its name, as
    ``mars_dust.optical_depth=2_sun05.00deg_equirect.exr``, or, if that is long, six
    digits of its digest; settings other than the default ones follow the sun, such that
    maps of different light have different names. Size, pixel type and compression do not show.
    """
    view, lighting, encoding = settings.view, settings.lighting, settings.encoding
    parts = (
        world_name(planet),
        # A plus would be a blank in the query of a URL.
        f"sun{f'{math.degrees(lighting.sun_elevation):+06.2f}'.lstrip('+')}deg",
        _bearing(lighting.sun_azimuth),
        "" if lighting.sun_distance is None else f"{lighting.sun_distance:.4f}au",
        _rotation(view.rotation),
        f"{view.altitude * 1e3:g}m" if view.altitude > 0.0 else "",
        lighting.method if lighting.method != PLAIN_LIGHTING.method else "",
        _DISCS[lighting.sun_disc],
        "moon" if lighting.moon is not None else "",
        *_night(settings.night),
        *_moonlight(settings),
        "" if lighting.sun_size is None else f"size{math.degrees(lighting.sun_size):g}deg",
        "soft" if lighting.sun_soft else "",
        f"strength{lighting.sun_strength:g}" if lighting.sun_strength != 1.0 else "",
        encoding.colorspace if encoding.colorspace != PLAIN_ENCODING.colorspace else "",
        _scale(encoding),
        "clamped" if encoding.clamp_negative else "",
        *(_clouds(settings.clouds) if planet.clouds else ()),
        encoding.target or "",
        view.below_horizon if view.below_horizon != "ground" else "",
        *_sensor(settings.sensor),
        view.projection.label,
    )
    return Path("_".join(filter(None, parts)) + usual_suffix(settings))


def _moonlight(settings: MapSettings) -> tuple[str, ...]:
    """Name what a map has of the Moon as a light, unless it is as usual."""
    moonlight = settings.moonlight
    if moonlight.moon is None or not settings.night.is_shown:
        return ()
    if moonlight.shown == "exclude":
        return ("nomoon",)
    moon, name = moonlight.moon, "moonlight" if moonlight.is_alone else ""
    if moon.earth is not None:
        return (name,)
    elevation, azimuth = math.degrees(moon.elevation), math.degrees(moon.azimuth)
    phase = math.degrees(moon.phase_angle)
    return (name, f"moon{elevation:.4g}deg{azimuth:.4g}deg{phase:.4g}deg")


def _night(night: Night) -> tuple[str, ...]:
    """Name what a map has of the night, unless it is as usual."""
    if night.frame is None:
        return ()
    if not night.is_shown:
        return ("nonight",)
    stars = {"include": "", "exclude": "nostars", "only": "stars"}[night.stars]
    if night.faintest_star != PLAIN_NIGHT.faintest_star:
        stars = f"stars{night.faintest_star:g}"
    scales = (
        f"{name}{value:g}"
        for name, value in (("airglow", night.airglow), ("zodiacal", night.zodiacal))
        if value != 1.0
    )
    city = () if night.city == 0.0 else (f"city{1e3 * night.city:.3g}mcd",)
    # By hand, of no time that would move the sun.
    by_hand = night.frame.year == J2000
    stands = f"lst{math.degrees(night.frame.sidereal_time):.2f}deg" if by_hand else ""
    return (stands, stars, *scales, *city)


def _sensor(sensor: Sensor) -> tuple[str, ...]:
    """Name what a map records besides what an eye sees, or instead."""
    camera = sensor.response
    return (
        "" if camera is None else f"camera-{Path(camera.name).stem}",
        "unbalanced" if camera is not None and camera.white == "none" else "",
        "" if sensor.wavelengths is None else "spectral",
        "stokes" if sensor.stokes else "",
        "" if sensor.polarizer is None else f"polarizer{math.degrees(sensor.polarizer):g}deg",
    )


def usual_suffix(settings: MapSettings) -> str:
    """Suffix of a map's files, ``.exr`` unless its target takes another."""
    if settings.encoding.target is None:
        return ".exr"
    from skybake.image.target import find_target

    return find_target(settings.encoding.target).suffix(settings.view.projection.name)


def world_name(planet: Planet) -> str:
    """Name of a planet, followed by what was set of its preset, if anything."""
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


def _clouds(clouds: Clouds) -> tuple[str, str]:
    quality = "" if clouds.quality == PLAIN_CLOUDS.quality else clouds.quality
    return (f"t{clouds.time:g}s" if clouds.time > 0.0 else "", quality)


def _bearing(azimuth: float) -> str:
    degrees = round(math.degrees(azimuth), 2) % 360.0
    return "" if degrees == math.degrees(PLAIN_LIGHTING.sun_azimuth) else f"az{degrees:06.2f}deg"


def _rotation(angle: float) -> str:
    degrees = round(math.degrees(angle), 2) % 360.0
    return f"rot{degrees:g}deg" if degrees else ""


def _scale(encoding: Encoding) -> str:
    if encoding.white_luminance == PLAIN_ENCODING.white_luminance:
        return ""
    return encoding.units if encoding.ev is None else f"ev{encoding.ev:g}"


def map_paths(target: Path, settings: MapSettings) -> tuple[Path, ...]:
    """Return the files of a map: one, or one for each face.

    Raises
    ------
    InputError
        If the file format cannot hold the projection's layout, or the target takes no such files.
    """
    projection = settings.view.projection
    if settings.encoding.target is not None:
        from skybake.image.target import find_target

        find_target(settings.encoding.target).check_suffix(projection.name, target.suffix)
    return projection_paths(target, projection)


def projection_paths(target: Path, projection: Projection) -> tuple[Path, ...]:
    """Return the files of a map in a projection: one, or one for each face.

    Raises
    ------
    InputError
        If the file format cannot hold the layout.
    """
    projection.check_file(target)
    if is_cube_file(target):
        _check_cube_file(target, projection)
        return (target,)
    return tuple(
        target if canvas.face is None else face_path(target, canvas.face)
        for canvas in projection.canvases()
    )


def _check_cube_file(target: Path, projection: Projection) -> None:
    if not isinstance(projection, Cubemap) or projection.layout != "faces":
        raise InputError(
            f"{target}: must be of a cubemap in faces, all of which it holds, "
            f"got {projection.label}"
        )
    if "{face}" in target.name:
        raise InputError(f"{target}: name must have no {{face}}, since the file holds all faces")


def face_path(target: Path, face: str) -> Path:
    """Name of a face's file."""
    if "{face}" in target.name:
        return target.with_name(target.name.replace("{face}", face))
    return target.with_name(f"{target.stem}_{face}{target.suffix}")


def preview_beside(target: Path) -> Path:
    """Default name of the picture of a map."""
    return target.with_name(target.name.replace("{face}", "preview")).with_suffix(".png")
