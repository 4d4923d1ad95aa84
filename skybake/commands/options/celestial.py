"""Values of options that say when and where, and what stands in the sky then."""

from __future__ import annotations

import math
import re
from contextlib import suppress
from datetime import date
from typing import TYPE_CHECKING

import click

from skybake.commands.options.values import RIGHT_ANGLE, bearing, elevation, length, parsed
from skybake.errors import InputError
from skybake.units import parse_angle

if TYPE_CHECKING:
    from skybake.ephemeris.moon import Moon

DAYS_FROM_TODAY = {"yesterday": -1, "today": 0, "tomorrow": 1}

# Of a square arcsecond: the brightest and the natural zenith, and of 1 cd/m2. [mag]
_BRIGHTEST_ZENITH, _NATURAL_ZENITH, _CANDELA_MAGNITUDE = 13.0, 22.0, 12.58

# As of star.distance_au in presets. [au]
_NEAREST, _FARTHEST = 1e-3, 1e5


def latitude(text: str) -> float:
    """Read a latitude such as ``48.8566``, ``54.8S`` or ``-54.8deg``. [rad]"""
    angle = _hemisphere(text, "N", "S")
    if abs(angle) > RIGHT_ANGLE:
        raise click.BadParameter(f"must be from -90deg to 90deg, got {text}")
    return angle


def longitude(text: str) -> float:
    """Read a longitude, -180deg to 360deg in the east; it becomes -180deg to 180deg. [rad]"""
    angle = _hemisphere(text, "E", "W")
    if not -2 * RIGHT_ANGLE <= angle <= 4 * RIGHT_ANGLE:
        raise click.BadParameter(f"must be from -180deg to 360deg, got {text}")
    return math.remainder(angle, 2 * math.pi)


def sidereal_time(text: str) -> float:
    """Read hours such as ``18h``, ``18.6h`` or ``18:36``, or an angle from 0deg to 360deg. [rad]"""
    found = re.fullmatch(r"(\d{1,2}):([0-5]\d)|(\d{1,2}(?:\.\d+)?)h", text.strip(), re.ASCII)
    if found is None:
        return solar_longitude(text)
    hours = float(found[3]) if found[3] else int(found[1]) + int(found[2]) / 60.0
    if hours > 24.0:
        raise click.BadParameter(f"must be from 0h to 24h, got {text}")
    return math.radians(15.0 * hours)


def stars(text: str) -> float | str:
    """Read ``include``, ``exclude``, ``only`` or a magnitude, which is checked by settings."""
    if text in {"include", "exclude", "only"}:
        return text
    try:
        return float(text)
    except ValueError:
        raise click.BadParameter(
            f"must be include, exclude, only or a magnitude such as 4.5, got {text!r}"
        ) from None


def light_pollution(text: str) -> tuple[float, float | None]:
    """Read ``20mag``, ``1.5mcd`` or ``off``, with the bearing of a city as ``20mag,90deg``.

    Returns
    -------
    luminance : float
        Of the zenith by lamps; a magnitude is that of all its light, of which a natural sky has
        that of 22 mag. [cd m⁻²]
    azimuth : float or None
        [rad]
    """
    if text == "off":
        return 0.0, None
    level, comma, where = text.partition(",")
    found = re.fullmatch(r"(\d+(?:\.\d*)?|\.\d+)(mag|mcd)", level.strip(), re.ASCII)
    if found is None:
        raise click.BadParameter(f"must be off or such as 20mag or 1.5mcd,90deg, got {text!r}")
    value = float(found[1])
    azimuth = bearing(where) if comma else None
    if found[2] == "mcd":
        return 1e-3 * value, azimuth
    if not _BRIGHTEST_ZENITH <= value < _NATURAL_ZENITH:
        raise click.BadParameter(
            f"must be from {_BRIGHTEST_ZENITH:g}mag to below {_NATURAL_ZENITH:g}mag, that of a "
            f"natural sky, got {text}"
        )
    luminances = (10.0 ** (0.4 * (_CANDELA_MAGNITUDE - each)) for each in (value, _NATURAL_ZENITH))
    total, natural = luminances
    return total - natural, azimuth


def solar_longitude(text: str) -> float:
    """Read an angle from 0deg to 360deg. [rad]"""
    angle = parsed(text, parse_angle)
    if not 0.0 <= angle <= 4 * RIGHT_ANGLE:
        raise click.BadParameter(f"must be from 0deg to 360deg, got {text}")
    return angle


def sun_distance(text: str) -> float | str:
    """Read a distance in au, ``mean`` or ``date``."""
    if text in {"mean", "date"}:
        return text
    try:
        distance = float(text.strip().casefold().removesuffix("au"))
    except ValueError:
        distance = math.nan
    if not _NEAREST <= distance <= _FARTHEST:
        raise click.BadParameter(
            f"must be mean, date or a number of au from {_NEAREST:g} to {_FARTHEST:g}, got {text!r}"
        )
    return distance


MOONS = ("include", "exclude", "only")
"""As of `skybake.image.moonlight`."""


def moon(text: str) -> Moon | str:
    """Read one of `MOONS`, or a moon in front of the sun as of `eclipsing_moon`."""
    if text in MOONS:
        return text
    return _eclipsing_moon(text, "include, exclude, only or ")


def eclipsing_moon(text: str) -> Moon:
    """Read ``195deg,40deg``, with a diameter as ``0.52deg`` and a distance as ``384400km``."""
    return _eclipsing_moon(text, "")


def moon_phase(text: str) -> float:
    """Read a phase angle, or a name of `skybake.ephemeris.lit_moon.PHASES`. [rad]"""
    from skybake.ephemeris.lit_moon import PHASES

    if text in PHASES:
        return math.radians(PHASES[text])
    try:
        angle = parse_angle(text)
    except InputError:
        angle = math.nan
    if not 0.0 <= angle <= math.pi + 1e-9:
        raise click.BadParameter(
            f"must be from 0deg to 180deg or one of {', '.join(PHASES)}, got {text!r}"
        )
    return angle


def _eclipsing_moon(text: str, others: str) -> Moon:
    from skybake.ephemeris.moon import Moon

    parts = text.split(",")
    if not 2 <= len(parts) <= 4:
        raise click.BadParameter(
            f"must be {others}AZIMUTH,ELEVATION[,DIAMETER[,DISTANCE]] such as 180deg,40deg, "
            f"got {text!r}"
        )
    sizes: dict[str, float] = {}
    if len(parts) > 2:
        sizes["diameter"] = parsed(parts[2], parse_angle)
    if len(parts) > 3:
        is_far = parts[3].strip() == "inf"
        sizes["distance"] = math.inf if is_far else length(parts[3])
    try:
        return Moon(bearing(parts[0]), elevation(parts[1]), **sizes)
    except InputError as error:
        raise click.BadParameter(str(error)) from error


def day(text: str) -> date | str:
    """Read a date such as ``2026-06-21``, or a key of `DAYS_FROM_TODAY`."""
    if text.lower() in DAYS_FROM_TODAY:
        return text.lower()
    if re.fullmatch(r"\d{4}-\d\d-\d\d", text, re.ASCII):
        with suppress(ValueError):
            return date.fromisoformat(text)
    raise click.BadParameter(f"must be a date such as 2026-06-21, or today, got {text!r}")


def _hemisphere(text: str, positive: str, negative: str) -> float:
    """Read an angle that may end in the letter of a hemisphere instead of having a sign. [rad]"""
    letter = text.strip()[-1:].upper()
    if letter not in (positive, negative):
        return parsed(text, parse_angle)
    angle = parsed(text.strip()[:-1], parse_angle)
    if text.strip()[0] in "+-":
        raise click.BadParameter(f"must have a sign or {letter}, not both, got {text}")
    return angle if letter == positive else -angle
