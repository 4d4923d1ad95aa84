"""The options of every command that takes a preset: which world, and what to change of it."""

from __future__ import annotations

import math
import tomllib
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import values
from skybake.commands.options.clouds import NONE, clouds_option
from skybake.commands.options.rules import is_given, option_names, options_together, usage_faults
from skybake.errors import InputError
from skybake.units import parse_column

if TYPE_CHECKING:
    from skybake.optics.changes import PresetChanges
    from skybake.preset import Planet

_CHANGES = ("ground_albedo", "ozone", "visibility", "turbidity")


def changes_from_options(context: click.Context) -> PresetChanges:
    """Return what `change_options` change of a preset.

    Raises
    ------
    click.UsageError
        If one would have no effect with another.
    """
    from skybake.optics.changes import PresetChanges

    options, names = context.params, option_names(context)
    with usage_faults(context):
        return PresetChanges(
            values=options["changes"],
            clouds=tuple(layer for layer in options["clouds"] if layer != NONE),
            keep_clouds=NONE not in options["clouds"],
            **{name: options[name] for name in _CHANGES},
            sources={"values": "--set", "clouds": "--clouds"}
            | {name: names[name] for name in _CHANGES},
        )


def is_changed(context: click.Context) -> bool:
    """Whether any of `change_options` is given."""
    return any(is_given(context, name) for name in ("changes", "clouds", *_CHANGES))


def world_from_options(context: click.Context) -> Planet:
    """Load the preset of `world_options` and change it as they say.

    Raises
    ------
    click.UsageError
        As `changes_from_options`.
    PresetError
        If the preset is faulty, or has nothing that an option could change.
    """
    return changes_from_options(context).load(context.params["preset"])


def _read_change(text: str) -> tuple[str, Any]:
    """Read ``KEY=VALUE``; a value that is not TOML is a string."""
    key, equals, value = (part.strip() for part in text.partition("="))
    if not (key and equals and value):
        raise click.BadParameter(
            f"must have the form KEY=VALUE, such as aerosol.optical_depth=0.3, got {text!r}"
        )
    return key, read_value(value)


def read_value(text: str) -> Any:
    """Read a value of TOML; anything else is taken as a string."""
    try:
        document = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return document["value"] if len(document) == 1 else text


def _visibility(text: str) -> float:
    length = values.length(text)
    if not length > 0.0:
        raise click.BadParameter(f"must be greater than 0m, got {text}")
    return length


def _turbidity(text: str) -> float:
    try:
        ratio = float(text)
    except ValueError:
        ratio = math.nan
    if not 1.0 <= ratio < math.inf:
        raise click.BadParameter(f"must be a number of at least 1, which is pure gas, got {text!r}")
    return ratio


def _ozone(text: str) -> float:
    try:
        column = parse_column(text)
    except InputError as error:
        raise click.BadParameter(str(error)) from error
    if column < 0.0:
        raise click.BadParameter(f"must be at least 0DU, got {text}")
    return column


change_options = options_together(
    click.option(
        "--set",
        "changes",
        metavar="KEY=VALUE",
        type=_read_change,
        multiple=True,
        help="Change the preset, such as aerosol.optical_depth=0.3; may be repeated.",
    ),
    clouds_option,
    click.option(
        "--visibility",
        metavar="LENGTH",
        type=_visibility,
        help="Haze that gives this visibility at the ground: 3.912 / extinction at 550 nm.",
    ),
    click.option(
        "--turbidity",
        metavar="T",
        type=_turbidity,
        help="Haze by the vertical optical depth of gas and aerosol over that of gas, at 550 nm.",
    ),
    click.option("--ozone", metavar="COLUMN", type=_ozone, help="Column of ozone, such as 320DU."),
    click.option(
        "--ground-albedo",
        metavar="NUMBER|NAME",
        type=read_value,
        help="Albedo of the ground, such as 0.8 or snow.",
    ),
)


preset_option = click.option(
    "--preset",
    default="earth",
    show_default=True,
    metavar="NAME|PATH",
    help="World: a name from 'skybake presets list', or a TOML file of your own.",
)
world_options = options_together(preset_option, change_options)
