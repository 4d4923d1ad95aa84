"""Values of options: how they are read."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from skybake.errors import InputError
from skybake.sequence.frames import parse_frames
from skybake.sequence.ramp import Ramp
from skybake.units import parse_angle, parse_duration, parse_length

COLDEST, HOTTEST = 1000.0, 25_000.0

Paths = TypeVar("Paths", Path | None, tuple[Path, ...])

# The tolerance is for 5400arcmin, which differs from 90deg in the last bit.
RIGHT_ANGLE = math.pi / 2 + 1e-9
"""A quarter of a turn. [rad]"""

_MOST_TURNS = 1000
_WIDEST = math.radians(170.0)
_LARGEST_DISC = math.radians(20.0) + 1e-9
_STRONGEST = 1e6
_FASTEST = 1000.0

_PICTURES = (".png", ".jpg", ".jpeg", ".webp", ".gif", ".tif", ".tiff")

# Click shows the message of a click.BadParameter, but only the value of a ValueError.


def elevation(text: str) -> float:
    """Read an angle from -90deg to 90deg. [rad]"""
    angle = parsed(text, parse_angle)
    if abs(angle) > RIGHT_ANGLE:
        raise click.BadParameter(f"must be from -90deg to 90deg, got {text}")
    return angle


def bearing(text: str) -> float:
    """Read an angle of up to a thousand turns; many more would leave it no precision. [rad]"""
    angle = parsed(text, parse_angle)
    if abs(angle) > 4 * RIGHT_ANGLE * _MOST_TURNS:
        raise click.BadParameter(f"must be at most {_MOST_TURNS} turns, got {text}")
    return angle


def scale(text: str) -> float:
    """Read a factor, whose range settings check."""
    try:
        return float(text)
    except ValueError:
        raise click.BadParameter(f"must be a number such as 1.5, got {text!r}") from None


def length(text: str) -> float:
    """Read a length. [km]"""
    return parsed(text, parse_length)


def altitude(text: str) -> float:
    """Read a length of at least 0. [km]"""
    above = length(text)
    if above < 0.0:
        raise click.BadParameter(f"must be at least 0m, which is the ground, got {text}")
    return above


def size(text: str) -> tuple[int, ...]:
    """Read width and height, or an edge: ``4096x2048``, ``1024``."""
    if not re.fullmatch(r"\d{1,9}(x\d{1,9})?", text, re.ASCII):
        raise click.BadParameter(
            f"must be such as 4096x2048, or 1024 for a map 2:1 or a cubemap, got {text!r}"
        )
    return tuple(int(number) for number in text.split("x"))


def field_of_view(text: str) -> float:
    """Read an angle greater than 0. [rad]"""
    angle = parsed(text, parse_angle)
    if not angle > 0.0:
        raise click.BadParameter(f"must be greater than 0deg, got {text}")
    return angle


def disc_diameter(text: str) -> float:
    """Read an angle greater than 0deg, at most 20deg. [rad]"""
    angle = parsed(text, parse_angle)
    if not 0.0 < angle <= _LARGEST_DISC:
        raise click.BadParameter(f"must be greater than 0deg and at most 20deg, got {text}")
    return angle


def strength(text: str) -> float:
    """Read a factor greater than 0, at most a million."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0.0 < number <= _STRONGEST:
        raise click.BadParameter(
            f"must be a number greater than 0 and at most {_STRONGEST:g}, got {text!r}"
        )
    return number


def look(text: str) -> tuple[float, float]:
    """Read a compass bearing and an elevation with a comma between. [rad]"""
    azimuth, comma, height = text.partition(",")
    if not comma:
        raise click.BadParameter(f"must be AZIMUTH,ELEVATION such as 180,10, got {text!r}")
    return bearing(azimuth), elevation(height)


def exposure(text: str) -> float | None:
    """Read an exposure value; ``auto`` becomes None."""
    if text == "auto":
        return None
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not -30.0 <= number <= 40.0:
        raise click.BadParameter(f"must be auto or a number from -30 to 40, got {text!r}")
    return number


def sequence_exposure(text: str) -> float | str:
    """Read an exposure value, ``auto`` or ``adapt``."""
    if text == "adapt":
        return text
    number = exposure(text)
    return "auto" if number is None else number


def white_balance(text: str) -> float | str:
    """Read ``auto``, ``none`` or a colour temperature such as ``5500K``. [K]"""
    if text in {"auto", "none"}:
        return text
    try:
        kelvin = float(text.removesuffix("K"))
    except ValueError:
        kelvin = math.nan
    if not COLDEST <= kelvin <= HOTTEST:
        raise click.BadParameter(
            f"must be auto, none or a temperature from {COLDEST:g}K to {HOTTEST:g}K, got {text!r}"
        )
    return kelvin


def shot(text: str) -> tuple[float, float, float]:
    """Read a compass bearing, an elevation and a field of view with commas between. [rad]"""
    parts = text.split(",")
    if len(parts) != 3:
        raise click.BadParameter(f"must be AZIMUTH,ELEVATION,FOV such as 180,10,50, got {text!r}")
    fov = field_of_view(parts[2])
    if fov > _WIDEST:
        raise click.BadParameter(
            f"must have a field of view of at most {math.degrees(_WIDEST):g}deg, got {parts[2]}"
        )
    return bearing(parts[0]), elevation(parts[1]), fov


def frame_rate(text: str) -> float:
    """Read frames per second, greater than 0."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0.0 < number <= _FASTEST:
        raise click.BadParameter(
            f"must be a number greater than 0 and at most {_FASTEST:g}, got {text!r}"
        )
    return number


def ramp(read: Callable[[str], float]) -> Callable[[str], Ramp]:
    """Return a reader of a value, or of two with ``..`` between."""

    def read_ramp(text: str) -> Ramp:
        if "..." in text:
            raise click.BadParameter(f"must have two dots between two values, got {text}")
        first, dots, last = text.partition("..")
        unit = last.lstrip("+-.0123456789 ")
        # In 1..2rad users mean radians, but a bare 1 is in degrees.
        if unit and first.strip()[-1:].isdigit() and not _is_same(read, first, first + unit):
            raise click.BadParameter(f"must have a unit on both sides, got {text}")
        return Ramp(read(first), read(last if dots else first))

    return read_ramp


def _is_same(read: Callable[[str], float], text: str, other: str) -> bool:
    """Whether two texts mean the same; one that means nothing does not."""
    try:
        return read(text) == read(other)
    except click.BadParameter:
        return False


_NUMBER = r"[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\.\.({_NUMBER})", re.ASCII)


def number_range(value: Any) -> Any:
    """Read a text such as ``0.1..0.3`` as a ramp; anything else stays what it is."""
    found = _RANGE.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        return value
    first, last = float(found[1]), float(found[2])
    return Ramp(first, last) if math.isfinite(first) and math.isfinite(last) else value


def frames(text: str) -> tuple[int, ...]:
    """Read frame numbers such as ``1-96`` or ``1-100x5,150``."""
    try:
        return parse_frames(text)
    except InputError as error:
        raise click.BadParameter(str(error).removeprefix("frames: ")) from error


def duration(text: str) -> float:
    """Read a duration such as ``10min``, greater than 0. [s]"""
    seconds = parsed(text, parse_duration)
    if not seconds > 0.0:
        raise click.BadParameter(f"must be greater than 0s, got {text}")
    return seconds


def duration_from_zero(text: str) -> float:
    """Read a duration such as ``2min``, or ``0s``. [s]"""
    return parsed(text, parse_duration)


def folder(text: str) -> Path:
    """Read the path of a folder."""
    if not text:
        raise click.BadParameter("must name a folder, got ''")
    return Path(text)


def with_suffix(
    *suffixes: str,
) -> Callable[[click.Context, click.Parameter, Paths], Paths]:
    """Return a callback of an option that checks the suffix of its path or paths."""

    def is_map(path: Path) -> bool:
        return ".exr" in suffixes and path.suffix.lower() in _PICTURES

    def check(context: click.Context, option: click.Parameter, value: Paths) -> Paths:
        for path in value if isinstance(value, tuple) else (value,):
            if path is not None and path.suffix.lower() not in suffixes:
                known = " or ".join(suffixes)
                has_preview = any(one.name == "preview" for one in context.command.params)
                way = "--preview" if has_preview else "skybake preview"
                hint = f"; a picture to look at is written by {way}" if is_map(path) else ""
                raise click.BadParameter(
                    f"{path}: suffix must be {known}, got {path.suffix!r}{hint}", context, option
                )
        return value

    return check


def parsed(text: str, parse: Callable[[str], float]) -> float:
    """Read a quantity by a function that raises an `InputError`."""
    try:
        return parse(text)
    except InputError as error:
        raise click.BadParameter(str(error)) from error
