"""The options of every command that takes a preset: which world, and what to change of it."""

from __future__ import annotations

import math
import tomllib
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from skybake.commands import parameters
from skybake.errors import InputError, PresetError, PresetWarning
from skybake.units import parse_column

if TYPE_CHECKING:
    from skybake.preset import Override, Planet

Command = TypeVar("Command", bound=Callable[..., Any])

OZONE = "ozone"


def load_world(preset: str, options: dict[str, Any]) -> Planet:
    """Load a preset and change it as the options say.

    Parameters
    ----------
    preset : str
        Name or path.
    options : dict
        With the values of `change_options`.

    Raises
    ------
    PresetError
        If the preset is faulty, or has nothing that an option could change.
    """
    from skybake.preset import load_preset

    return load_preset(preset, world_overrides(preset, options))


def world_overrides(preset: str, options: dict[str, Any]) -> list[Override]:
    """Return what the options change: ``--set`` first, in the order given, then the others.

    Raises
    ------
    PresetError
        If the preset is faulty, or has nothing that an option could change.
    """
    from skybake.preset import Absorber, Override

    overrides = [Override(key, value, "--set") for key, value in options["changes"]]
    if options["ground_albedo"] is not None:
        overrides.append(Override("ground.albedo", options["ground_albedo"], "--ground-albedo"))
    ozone, haze = options["ozone"], _haze_option(options)
    if ozone is not None:
        planet = _load_quietly(preset, overrides)
        absorbers = [one.name for one in planet.constituents if isinstance(one, Absorber)]
        if OZONE not in absorbers:
            raise PresetError(
                f"--ozone: needs an absorber of the name {OZONE}, {planet.name} has "
                f"{', '.join(absorbers) or 'no absorber'}"
            )
        overrides.append(Override(f"constituents.{OZONE}.column_du", ozone, "--ozone"))
    if haze is not None:
        name, value = haze
        planet = _load_quietly(preset, overrides)
        overrides += [
            Override(f"constituents.{aerosol}.optical_depth", depth, name)
            for aerosol, depth in _optical_depths(planet, name, value).items()
        ]
    return overrides


def _load_quietly(preset: str, overrides: list[Override]) -> Planet:
    """Load a planet that is loaded once more for good, and shall warn then."""
    from skybake.preset import load_preset

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PresetWarning)
        return load_preset(preset, overrides)


def is_changed(options: dict[str, Any]) -> bool:
    """Whether any of `change_options` is given."""
    names = ("ground_albedo", OZONE, "visibility", "turbidity")
    return bool(options["changes"]) or any(options[name] is not None for name in names)


def _haze_option(options: dict[str, Any]) -> tuple[str, float] | None:
    given = [
        (f"--{name}", options[name])
        for name in ("visibility", "turbidity")
        if options[name] is not None
    ]
    if len(given) > 1:
        raise click.UsageError("--turbidity: needs no --visibility beside it")
    return given[0] if given else None


def _optical_depths(planet: Planet, option: str, value: float) -> dict[str, float]:
    from skybake.optics.haze import haze_for_turbidity, haze_for_visibility

    solve = haze_for_visibility if option == "--visibility" else haze_for_turbidity
    try:
        return solve(planet, value)
    except PresetError as error:
        raise PresetError(f"{option}: {error}") from error


def _read_change(text: str) -> tuple[str, Any]:
    """Read ``KEY=VALUE``; a value that is no TOML is a text."""
    key, equals, value = (part.strip() for part in text.partition("="))
    if not (key and equals and value):
        raise click.BadParameter(f"must be as aerosol.optical_depth=0.3, got {text!r}")
    return key, read_value(value)


def read_value(text: str) -> Any:
    """Read a value of TOML; anything else is taken as the text that it is."""
    try:
        document = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return document["value"] if len(document) == 1 else text


def _visibility(text: str) -> float:
    length = parameters.length(text)
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


_CHANGES = (
    click.option(
        "--set",
        "changes",
        metavar="KEY=VALUE",
        type=_read_change,
        multiple=True,
        help="Change the preset, as aerosol.optical_depth=0.3; may be repeated.",
    ),
    click.option(
        "--visibility",
        metavar="LENGTH",
        type=_visibility,
        help="Haze with which one sees so far at the ground: 3.912 / extinction at 550 nm.",
    ),
    click.option(
        "--turbidity",
        metavar="T",
        type=_turbidity,
        help="Haze by optical depth of gas and aerosol over that of gas, vertical, 550 nm.",
    ),
    click.option("--ozone", metavar="COLUMN", type=_ozone, help="Column of ozone, as 320DU."),
    click.option(
        "--ground-albedo",
        metavar="NUMBER|NAME",
        type=read_value,
        help="Albedo of the ground, as 0.8 or snow.",
    ),
)


def change_options(command: Command) -> Command:
    """Add the options that change a preset."""
    for option in reversed(_CHANGES):
        command = option(command)
    return command


def world_options(command: Command) -> Command:
    """Add ``--preset`` and the options that change it."""
    return parameters.preset_option(change_options(command))
