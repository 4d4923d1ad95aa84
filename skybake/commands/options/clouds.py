"""The options of clouds: layers that are added to a preset, when they are seen, and how finely."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import choices, values
from skybake.commands.options.rules import Decorator, is_given, option_names, options_together
from skybake.errors import InputError, PresetError
from skybake.units import (
    degrees,
    parse_angle,
    parse_density,
    parse_length,
    parse_micrometres,
    parse_speed,
)

if TYPE_CHECKING:
    from skybake.image.settings import Clouds
    from skybake.preset import Planet

NONE = "none"
_TILE = "tile"
_METRES = 1e3


def clouds_layer(text: str) -> dict[str, Any] | str:
    """Read a layer such as ``cumulus:0.4,base=1km``, as a table of a preset, or ``none``.

    Raises
    ------
    click.BadParameter
        That names the part which is at fault.
    """
    from skybake.preset.clouds import check_layer
    from skybake.preset.message import nearest

    if text.strip() == NONE:
        return NONE
    head, *parts = (part.strip() for part in text.split(","))
    table, written = _read_head(head)
    for part in parts:
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not (name and equals and value):
            raise click.BadParameter(f"{text!r}: {part!r} must have the form KEY=VALUE")
        if name not in _PARTS:
            like = nearest(name, _PARTS)
            hint = f", nearest: {like}" if like else ""
            raise click.BadParameter(
                f"{part}: unknown key {name!r}{hint}; known keys: {', '.join(_PARTS)}"
            )
        key, read = _PARTS[name]
        if key in table:
            raise click.BadParameter(f"{part}: {name} is given twice")
        try:
            table[key] = read(value)
        except InputError as error:
            raise click.BadParameter(f"{part}: {error}") from error
        written[key] = part
    try:
        check_layer(table)
    except PresetError as error:
        raise click.BadParameter(_by_its_part(error.faults[0], written, text)) from error
    return table


def _read_head(head: str) -> tuple[dict[str, Any], dict[str, str]]:
    """Read what a layer consists of and how much it covers; and by keys, how it was written."""
    if head.startswith(f"{_TILE}="):
        return {_TILE: head.partition("=")[2].strip()}, {_TILE: head}
    kind, colon, cover = (part.strip() for part in head.partition(":"))
    if kind == _TILE or head.endswith(".npz"):
        file = cover if kind == _TILE else head
        raise click.BadParameter(f"{head}: a tile must be written as {_TILE}={file or 'FILE.npz'}")
    table: dict[str, Any] = {"kind": kind}
    if colon:
        table["cover"] = _number_or_text(cover)
    return table, {"kind": head or repr(head), "cover": head}


def _by_its_part(fault: str, written: Mapping[str, str], text: str) -> str:
    """Say of a fault in a table which part of the option it is in."""
    _, place, rule = fault.split(": ", 2)
    key = place.removeprefix("clouds.layer").lstrip(".")
    part = written.get(key) or repr(text)
    return f"{part}: {key} {rule}" if key else f"{part}: {rule}"


def _number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _integer(text: str) -> int:
    if not re.fullmatch(r"[+-]?\d{1,20}", text, re.ASCII):
        raise InputError(f"must be a whole number, got {text!r}")
    return int(text)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise InputError(f"must be a number, got {text!r}") from error


def _wind(text: str) -> list[float]:
    """Read ``8m/s@270deg``: speed [m s⁻¹] and the bearing from which it blows [deg]."""
    speed, at, bearing = text.partition("@")
    if not at:
        raise InputError(
            f"must be a speed and where it comes from, such as 8m/s@270deg, got {text!r}"
        )
    return [parse_speed(speed) * _METRES, degrees(parse_angle(bearing))]


def _pair_of_lengths(text: str) -> list[float]:
    """Read ``1km:500m``. [km]"""
    east, colon, north = text.partition(":")
    if not colon:
        raise InputError(f"must be lengths to the east and the north, such as 1km:0m, got {text!r}")
    return [parse_length(east), parse_length(north)]


_PARTS: Mapping[str, tuple[str, Callable[[str], Any]]] = {
    "base": ("base_km", parse_length),
    "depth": ("depth_km", parse_length),
    "size": ("size_km", parse_length),
    "cover": ("cover", _number_or_text),
    "tau": ("optical_depth", _number),
    "lwp": ("liquid_water_path_g_m2", parse_density),
    "reff": ("effective_radius_um", parse_micrometres),
    "phase": ("phase", str),
    "seed": ("seed", _integer),
    "wind": ("wind_m_s", _wind),
    "interpolation": ("interpolation", str),
    "origin": ("origin_km", _pair_of_lengths),
}


def absolute_layer(text: str) -> str:
    """Make the path of a tile absolute in the text of a layer."""
    head, comma, rest = text.partition(",")
    if not head.strip().startswith(f"{_TILE}="):
        return text
    return f"{_TILE}={Path(head.partition('=')[2].strip()).absolute()}{comma}{rest}"


clouds_option = click.option(
    "--clouds",
    metavar="KIND[:COVER][,KEY=VALUE...]|none",
    type=clouds_layer,
    multiple=True,
    help="Add a layer of stratus, stratocumulus, cumulus, altocumulus or cirrus, such as "
    "cumulus:0.4 or stratus:8okta,base=600m,tau=20,seed=3, or tile=FILE.npz,base=1km; none removes "
    "the preset's own; may be repeated.",
)


def clouds_options(*, is_range: bool = False) -> Decorator:
    """Return ``--cloud-time``, a time or a range of them, and ``--clouds-quality``."""
    text = "How long clouds have drifted and changed, "
    return options_together(
        click.option(
            "--cloud-time",
            metavar="DURATION[..DURATION]" if is_range else "DURATION",
            type=values.ramp(values.duration_from_zero) if is_range else values.duration_from_zero,
            show_default="0s, or the time since the first frame" if is_range else "0s",
            help=text + ("from first to last frame." if is_range else "such as 120s or 10min."),
        ),
        click.option(
            "--clouds-quality",
            type=click.Choice(choices.CLOUD_QUALITIES),
            default="normal",
            show_default=True,
            help="How finely the light of clouds is solved for.",
        ),
    )


def clouds_from_options(context: click.Context) -> Clouds:
    """Return the settings of `clouds_options` without a range."""
    from skybake.image.settings import Clouds

    options = context.params
    return Clouds(time=options["cloud_time"] or 0.0, quality=options["clouds_quality"])


def check_clouds(context: click.Context, *planets: Planet) -> None:
    """Refuse settings of clouds for a world without any.

    Raises
    ------
    click.UsageError
        That names the option.
    """
    if any(planet.clouds for planet in planets):
        return
    for name in ("cloud_time", "clouds_quality"):
        if is_given(context, name):
            raise click.UsageError(
                f"{option_names(context)[name]}: needs clouds, and the preset has none: "
                "add a layer with --clouds"
            )
