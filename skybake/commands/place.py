"""The options that say where the sun is seen from and by which clock."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import click

from skybake.commands import parameters
from skybake.ephemeris.mars import SITES

Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--lat",
        metavar="ANGLE",
        type=parameters.latitude,
        help="Latitude: 48.8566, 48.8566N or -54.8deg.",
    ),
    click.option(
        "--lon",
        metavar="ANGLE",
        type=parameters.longitude,
        help="Longitude, positive in the east: 2.3522, 78.47W or -78.47deg.",
    ),
    click.option(
        "--site",
        type=click.Choice(tuple(SITES)),
        help="Place on Mars instead.",
    ),
    click.option(
        "--ls",
        metavar="ANGLE",
        type=parameters.solar_longitude,
        help="Season on Mars, the sun's longitude Ls; times are then of local true solar time.",
    ),
    click.option(
        "--tz",
        metavar="AREA/CITY",
        help="Time zone of times without an offset and of --date, such as Europe/Paris.",
    ),
    click.option(
        "--date",
        metavar="YYYY-MM-DD",
        type=parameters.day,
        help="Local date of sunset, noon and the like.",
    ),
    click.option(
        "--refraction",
        is_flag=True,
        help="Lift the sun as Earth's air does, by half a degree at the horizon.",
    ),
)
_NAMES = ("lat", "lon", "site", "ls", "tz", "date", "refraction")


def place_options(command: Command) -> Command:
    """Add the options that say where and by which clock."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def is_on_mars(options: Mapping[str, Any]) -> bool:
    """Whether options of Mars are given."""
    return options["site"] is not None or options["ls"] is not None


def refuse_places(options: Mapping[str, Any], need: str) -> None:
    """Refuse all options of place and clock where `need`, which asks for a time, is not given."""
    for name in _NAMES:
        if options[name] not in (None, False):
            raise click.UsageError(f"--{name}: needs {need}")


def check_place(options: Mapping[str, Any], texts: Mapping[str, str]) -> None:
    """Refuse options that would have no effect beside the others, and ask for what is missing.

    Parameters
    ----------
    options : mapping
        With the values of `place_options` and ``preset``.
    texts : mapping of str to str
        Times by the options that ask for them: one, or start and end.

    Raises
    ------
    click.UsageError
        That names the options.
    PresetError
        If the preset cannot be read.
    """
    first = next(iter(texts))
    latitude, longitude, site = options["lat"], options["lon"], options["site"]
    if (latitude is None) != (longitude is None):
        given, missing = ("--lat", "--lon") if longitude is None else ("--lon", "--lat")
        raise click.UsageError(f"{given}: needs {missing} beside it")
    if latitude is None and site is None:
        raise click.UsageError(f"{first}: needs --lat and --lon, or on Mars --site")
    if latitude is not None and site is not None:
        raise click.UsageError("--site: needs no --lat and --lon beside it")
    if is_on_mars(options) and options["refraction"]:
        raise click.UsageError("--refraction: is that of Earth's air, needs no --site or --ls")
    if options["ls"] is not None:
        for name in ("tz", "date"):
            if options[name] is not None:
                raise click.UsageError(f"--{name}: needs no --ls, which goes with solar time")
    else:
        _check_times(options, texts)
    _check_world(options, first)


def _check_times(options: Mapping[str, Any], texts: Mapping[str, str]) -> None:
    from skybake.ephemeris.times import kind_of

    kinds = {option: kind_of(text) for option, text in texts.items()}
    for option, text in texts.items():
        if is_on_mars(options) and kinds[option] in {"event", "unknown"}:
            raise click.UsageError(
                f"{option}: on Mars must be as 2026-06-21T04:00Z, or as 16:30 with --ls, "
                f"got {text!r}"
            )
        if kinds[option] == "event" and options["date"] is None:
            raise click.UsageError(f"{option} {text}: needs --date")
    found = set(kinds.values())
    if options["date"] is not None and found <= {"local", "absolute"}:
        raise click.UsageError(f"--date: needs {next(iter(texts))} sunset or the like")
    # The labels of a range are by the local clock in any case.
    if options["tz"] is not None and len(texts) == 1 and found == {"absolute"}:
        raise click.UsageError("--tz: needs a time without an offset of its own")


def _check_world(options: Mapping[str, Any], first: str) -> None:
    """Refuse the sun of one planet for the air of another, as far as presets tell."""
    from skybake.preset import base_name, preset_names

    base = base_name(options["preset"])
    if base not in preset_names():
        return
    planet, preset = base.split("-")[0], options["preset"]
    if is_on_mars(options):
        if planet != "mars":
            option = "--site" if options["site"] is not None else "--ls"
            raise click.UsageError(f"{option}: is for Mars, needs --preset mars or one like it")
    elif planet == "mars":
        raise click.UsageError(f"{first}: on Mars needs --site or --ls, got --preset {preset}")
    elif planet != "earth":
        raise click.UsageError(
            f"{first}: the sun is known on Earth and Mars, got --preset {preset}; use --sun"
        )
