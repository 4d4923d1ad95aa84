"""Options as a page shows them: what kind of value each takes, its unit, range and default."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import click

from skybake.commands.options import celestial, clouds, values, world

# Of no use to a page, which has no files, pipes or terminals.
LEFT_OUT = frozenset({"output", "lights", "preview", "shot", "as_json", "quiet", "changes"})

_GROUPS: dict[str, tuple[str, ...]] = {
    "World": ("preset", "visibility", "turbidity", "ozone", "ground_albedo", "method"),
    "Sun": ("sun_elevation", "sun_azimuth", "sun_distance"),
    "Time and place": (
        *("time", "day", "zone", "latitude", "longitude", "site", "solar_longitude"),
        *("refraction", "sidereal_time"),
    ),
    "Observer": ("altitude", "below_horizon"),
    "Clouds": ("clouds", "cloud_time", "clouds_quality"),
    "Moon": ("moon", "eclipse", "moon_elevation", "moon_azimuth", "moon_phase"),
    "Night": ("night", "stars", "airglow", "zodiacal", "light_pollution"),
    "Sun's disc": ("sun_disc", "sun_size", "sun_soft", "sun_strength"),
    "Picture": ("preview_ev", "view", "white_balance", "vision", "show"),
    "Map": (
        *("target", "projection", "size", "fov", "look", "cube_layout", "cube_space"),
        *("face_names", "equirect_rows", "rotate"),
    ),
    "File": (
        *("colorspace", "units", "ev", "pixel", "compression", "mips", "layers"),
        *("clamp_negative", "omit_exposure"),
    ),
    "Sensor": ("camera", "camera_white", "spectral", "stokes", "polarizer"),
}
OTHER = "Other"
"""Group of the options that are in none of the others."""

_SOLVES = frozenset(_GROUPS["World"])
_CLOUDS = frozenset(_GROUPS["Clouds"])
_FOLDS = frozenset((*_GROUPS["Sun's disc"], "below_horizon", *_GROUPS["Picture"]))
_STORED = frozenset((*_GROUPS["Map"], *_GROUPS["File"], *_GROUPS["Sensor"], "vision", "show"))
_UNSEEN = frozenset((*_GROUPS["Sensor"], "vision", "show"))
"""Options that change what baked pictures look like, but not what a page shows of the sky."""


@dataclass(frozen=True)
class Quantity:
    """What a slider needs of an option's values.

    Attributes
    ----------
    kind : str
        "angle", "length", "number" or another that the page knows.
    unit : str
        Of the numbers, and of a text that has none of its own where the option allows that.
    least, most : float or None
        Ends of a slider, which need not be those of the range.
    is_logarithmic : bool
        Whether equal steps are equal ratios.
    """

    kind: str
    unit: str = ""
    least: float | None = None
    most: float | None = None
    is_logarithmic: bool = False


_TURN = Quantity("angle", "deg", 0.0, 360.0)
_BY_READER: dict[Callable[[str], Any], Quantity] = {
    values.elevation: Quantity("angle", "deg", -90.0, 90.0),
    values.bearing: _TURN,
    values.altitude: Quantity("length", "km", 0.0, 40_000.0, is_logarithmic=True),
    values.length: Quantity("length", "km", 0.0, 1000.0, is_logarithmic=True),
    values.field_of_view: Quantity("angle", "deg", 1.0, 360.0),
    values.disc_diameter: Quantity("angle", "deg", 0.01, 20.0, is_logarithmic=True),
    values.strength: Quantity("number", "", 1e-3, 1e3, is_logarithmic=True),
    values.scale: Quantity("number", "", 0.0, 4.0),
    values.exposure: Quantity("number", "EV", -8.0, 20.0),
    values.white_balance: Quantity("number", "K", values.COLDEST, values.HOTTEST, True),
    values.duration_from_zero: Quantity("duration", "min", 0.0, 120.0),
    values.size: Quantity("size"),
    values.look: Quantity("direction", "deg"),
    world._visibility: Quantity("length", "km", 0.5, 500.0, is_logarithmic=True),
    world._turbidity: Quantity("number", "", 1.0, 10.0),
    world._ozone: Quantity("number", "DU", 0.0, 600.0),
    world.read_value: Quantity("number", "", 0.0, 1.0),
    celestial.latitude: Quantity("angle", "deg", -90.0, 90.0),
    celestial.longitude: Quantity("angle", "deg", -180.0, 180.0),
    celestial.solar_longitude: _TURN,
    celestial.sidereal_time: Quantity("time", "h", 0.0, 24.0),
    celestial.sun_distance: Quantity("number", "au", 0.01, 50.0, is_logarithmic=True),
    celestial.day: Quantity("date"),
    celestial.moon: Quantity("moon"),
    clouds.clouds_layer: Quantity("clouds"),
}
_BY_NAME = {
    "time": Quantity("time"),
    "preset": Quantity("preset"),
    "ev": Quantity("number", "EV", -30.0, 40.0),
    "zone": Quantity("zone"),
}
_TEXT = Quantity("text")


def long_name(option: click.Parameter) -> str:
    """Return the long form of an option without dashes, by which a page knows it."""
    return max(option.opts, key=len).lstrip("-")


def described_groups(options: Iterable[click.Parameter]) -> list[dict[str, Any]]:
    """Return options in groups, fit for JSON.

    Parameters
    ----------
    options : iterable of click.Parameter
        Of a command; those of `LEFT_OUT` are left out, unknown ones form the group `OTHER`.
    """
    left = {one.name or "": one for one in options if one.name not in LEFT_OUT}
    groups = []
    for title, names in _GROUPS.items():
        found = [left.pop(name) for name in names if name in left]
        if found:
            groups.append({"title": title, "options": [_described(one) for one in found]})
    if left:
        groups.append({"title": OTHER, "options": [_described(one) for one in left.values()]})
    return groups


def quantity_of(option: click.Parameter) -> Quantity:
    """Return what is known of an option's values."""
    if isinstance(option.type, click.Choice):
        return Quantity("choice")
    if getattr(option, "is_flag", False):
        return Quantity("flag")
    reader = getattr(option.type, "func", None)
    if reader in _BY_READER:
        return _BY_READER[reader]
    if option.name in _BY_NAME:
        return _BY_NAME[option.name]
    if option.type in {click.FLOAT, click.INT}:
        return Quantity("integer" if option.type is click.INT else "number")
    return _TEXT


def live_of(name: str) -> str:
    """Return what another value of an option costs: ``fold``, ``trace``, ``solve``, ``clouds``.

    Options that only concern the file cost ``file``, which is nothing.
    """
    if name in _SOLVES:
        return "solve"
    if name in _CLOUDS:
        return "clouds"
    if name in _STORED:
        return "file"
    return "fold" if name in _FOLDS else "trace"


def _described(option: click.Parameter) -> dict[str, Any]:
    quantity, name = quantity_of(option), option.name or ""
    choices = option.type.choices if isinstance(option.type, click.Choice) else None
    given, shown = _default(option), getattr(option, "show_default", None)
    return {
        "name": long_name(option),
        "flags": [*option.opts, *option.secondary_opts],
        "kind": "list" if option.multiple and quantity is _TEXT else quantity.kind,
        "unit": quantity.unit,
        "unit_shown": quantity.unit.replace("deg", "°"),
        "min": quantity.least,
        "max": quantity.most,
        "scale": "log" if quantity.is_logarithmic else "linear",
        "default": _number(given),
        "default_text": shown if isinstance(shown, str) else given or "",
        "choices": None if choices is None else list(choices),
        "multiple": option.multiple,
        "metavar": option.metavar or "",
        "help": getattr(option, "help", None) or "",
        "live": live_of(name),
        "unseen": name in _UNSEEN,
    }


def _default(option: click.Parameter) -> str | None:
    """Return the text of the default, or None without one."""
    default = option.default
    return default if isinstance(default, str) else None


def _number(text: str | None) -> float | None:
    """Return the number at the beginning of a default such as ``30deg``."""
    digits = "" if text is None else text.rstrip("abcdefghijklmnopqrstuvwxyz")
    try:
        return float(digits)
    except ValueError:
        return None
