"""Quantities as users type them, "5deg", "2km", "30000ft", "1h30min", and as files state them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from skybake.errors import InputError

_RADIANS = {
    "deg": math.pi / 180.0,
    "rad": 1.0,
    "arcmin": math.pi / 10_800.0,
    "arcsec": math.pi / 648_000.0,
    "°": math.pi / 180.0,
}
_KILOMETRES = {"m": 1e-3, "km": 1.0, "ft": 0.3048e-3, "mi": 1.609344}

_KILOMETRES_PER_SECOND = {
    "m/s": 1e-3,
    "km/h": 1.0 / 3600.0,
    "kn": 1.852 / 3600.0,
    "mph": 1.609344 / 3600.0,
}
_GRAMS_PER_SQUARE_METRE = {"g/m2": 1.0, "kg/m2": 1e3}
_MICROMETRES = {"um": 1.0, "mm": 1e3}

_DIGITS = 17  # of a double

_SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86_400.0}

_QUANTITY = re.compile(
    r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-zA-Z°][a-zA-Z0-9/°]*)?", re.ASCII
)
_DURATION_PART = r"([0-9]+\.?[0-9]*|\.[0-9]+)(s|min|h|d)"

# A mega, a mile or a nautical mile rather than a metre.
_AMBIGUOUS = ("M",)


def parse_angle(text: str) -> float:
    """Read an angle such as ``5deg``, ``0.1rad``, ``30arcmin`` or ``5``.

    Parameters
    ----------
    text : str
        A number and a unit: deg, rad, arcmin or arcsec, or the sign of degrees; a
        bare number is in degrees. Units may be in capitals.

    Returns
    -------
    float
        The angle. [rad]

    Raises
    ------
    InputError
        If the text is no finite number with one of these units.
    """
    return _parse(text, _RADIANS, bare="deg", quantity="an angle", example="5deg")


def parse_length(text: str) -> float:
    """Read a length such as ``2km``, ``1500m`` or ``30000ft``.

    Parameters
    ----------
    text : str
        A number and a unit: m, km, ft or mi, which may be in capitals, except M; only 0
        needs none.

    Returns
    -------
    float
        The length. [km]

    Raises
    ------
    InputError
        If the text is no finite number with one of these units.
    """
    return _parse(text, _KILOMETRES, bare=None, quantity="a length", example="2km")


def parse_column(text: str) -> float:
    """Read a column of gas such as ``320DU`` or ``320``.

    Parameters
    ----------
    text : str
        A number and the unit DU, in capitals or not; a bare number is in Dobson units.

    Returns
    -------
    float
        The column. [DU]

    Raises
    ------
    InputError
        If the text is no finite number with this unit.
    """
    return _parse(text, {"DU": 1.0}, bare="DU", quantity="a column of gas", example="320DU")


def parse_speed(text: str) -> float:
    """Read a speed such as ``8m/s``, ``30km/h`` or ``8``.

    Parameters
    ----------
    text : str
        A number and a unit: m/s, km/h, kn or mph; a bare number is in m/s.

    Returns
    -------
    float
        The speed. [km s⁻¹]

    Raises
    ------
    InputError
        If the text is no finite number with one of these units.
    """
    return _parse(text, _KILOMETRES_PER_SECOND, bare="m/s", quantity="a speed", example="8m/s")


def parse_density(text: str) -> float:
    """Read a mass over an area such as ``100g/m2`` or ``0.1kg/m2``; a bare number is in g/m2.

    Returns
    -------
    float
        The mass over an area. [g m⁻²]

    Raises
    ------
    InputError
        If the text is no finite number with one of these units.
    """
    units = _GRAMS_PER_SQUARE_METRE
    return _parse(text, units, bare="g/m2", quantity="a mass over an area", example="100g/m2")


def parse_micrometres(text: str) -> float:
    """Read the size of a particle such as ``10um``; a bare number is in micrometres.

    Returns
    -------
    float
        The size. [um]

    Raises
    ------
    InputError
        If the text is no finite number with this unit.
    """
    return _parse(text, _MICROMETRES, bare="um", quantity="a size", example="10um")


def parse_duration(text: str) -> float:
    """Read a duration such as ``10min``, ``30s`` or ``1h30min``.

    Parameters
    ----------
    text : str
        Numbers, each with a unit: s, min, h or d, which may be in capitals.

    Returns
    -------
    float
        The duration, at least 0. [s]

    Raises
    ------
    InputError
        If the text is no finite duration with these units.
    """
    lower = text.strip().lower()
    parts = re.findall(_DURATION_PART, lower)
    value = sum(float(number) * _SECONDS[unit] for number, unit in parts)
    if not re.fullmatch(f"({_DURATION_PART})+", lower) or not math.isfinite(value):
        raise InputError(
            f"must be a duration such as 10min or 1h30min (units: {', '.join(_SECONDS)}), "
            f"got {text!r}"
        )
    return value


def degrees(angle: float) -> float:
    """Return an angle in degrees, in the fewest digits that mean the same angle.

    By `math.degrees` the radians of 30 deg are 29.999999999999996 deg.
    """
    return _shortest(math.degrees(angle), lambda value: math.radians(value) == angle)


def metres(length: float) -> float:
    """Return a length in metres of one in kilometres, in the fewest digits that mean the same."""
    return _shortest(length * 1e3, lambda value: value * 1e-3 == length or value / 1e3 == length)


def _shortest(exact: float, is_same: Callable[[float], bool]) -> float:
    for digits in range(1, _DIGITS):
        short = float(f"{exact:.{digits}g}")
        if is_same(short):
            return short
    return exact


def _parse(
    text: str, units: dict[str, float], *, bare: str | None, quantity: str, example: str
) -> float:
    """Read a number and a unit; `bare` is the unit of a number without, None if only 0 may be."""
    match = _QUANTITY.fullmatch(text.strip())
    number = float(match[1]) if match else math.nan
    unit = bare if match and not match[2] else _unit(match[2], units) if match else None
    known = ", ".join(name for name in units if name.isascii())
    if match and not match[2] and bare is None and math.isfinite(number):
        if number == 0.0:
            return 0.0
        likely = " or ".join(f"{match[1]}{name}" for name in list(units)[:2])
        raise InputError(f"needs a unit, such as {likely} (units: {known}), got {text!r}")
    value = number * units[unit] if unit is not None else math.nan
    if not math.isfinite(value):
        rule = "" if bare is None else f"; a bare number is in {bare}"
        raise InputError(
            f"must be {quantity} such as {example} (units: {known}{rule}), got {text!r}"
        )
    return value


def _unit(text: str, units: dict[str, float]) -> str | None:
    """Return the unit that a text means in any case, or None."""
    if text in units:
        return text
    if text in _AMBIGUOUS:
        return None
    return next((unit for unit in units if unit.lower() == text.lower()), None)
