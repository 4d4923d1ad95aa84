"""The options of the Moon as a light: whether a map shows it, and where without a time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import celestial, values
from skybake.commands.options.observer import quantity
from skybake.commands.options.rules import Decorator, Needs, options_together
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment
    from skybake.image.moonlight import Moonlight
    from skybake.sequence.moon_path import MoonPath

SOUTH = math.pi
"""Bearing of a Moon that has none. [rad]"""


def moonlight_options(*, is_range: bool = False) -> Decorator:
    """Return the options of a Moon by hand; of sequences angles may be ranges."""
    return options_together(
        click.option(
            "--moon-elevation",
            **quantity("ANGLE", values.elevation, is_range=is_range),
            help="Put the Moon as a light at this elevation, where no time does.",
        ),
        click.option(
            "--moon-azimuth",
            **quantity("ANGLE", values.bearing, is_range=is_range),
            show_default="180deg",
            help="Compass bearing of the Moon that --moon-elevation puts there.",
        ),
        click.option(
            "--moon-phase",
            metavar="ANGLE[..ANGLE]|NAME" if is_range else "ANGLE|NAME",
            type=values.ramp(celestial.moon_phase) if is_range else celestial.moon_phase,
            show_default="what the sun makes of it",
            help="Phase angle of that Moon, 0deg when full and 180deg when new, or full, gibbous, "
            "quarter, crescent or new; its lit side looks to the sun.",
        ),
    )


def shown_moon(options: Mapping[str, Any]) -> str | None:
    """Return which word ``--moon`` is, if it is one."""
    moon = options["moon"]
    return moon if isinstance(moon, str) else None


def moonlight_needs(options: Mapping[str, Any], *, is_timed: bool, time: str) -> Needs:
    """Return what `moonlight_options` and words of ``--moon`` need; `time` as of `night_needs`."""
    shown, is_by_hand = shown_moon(options), options.get("moon_elevation") is not None
    is_off = options["night"] == "off"
    off = "cannot be combined with --night off"
    if is_timed:
        problem = f"cannot be combined with {time}, which puts the Moon where it is"
    elif is_off:
        problem = off
    elif shown == "exclude":
        problem = "cannot be combined with --moon exclude"
    elif options["moon"] is not None and shown is None:
        problem = "cannot be combined with --moon AZIMUTH,ELEVATION, which is in front of the sun"
    else:
        problem = ""
    others = problem or ("" if is_by_hand else "needs --moon-elevation")
    return {
        "moon": _moon_needs(options, is_known=is_timed or is_by_hand, time=time),
        "moon_elevation": (not problem, problem),
        **dict.fromkeys(("moon_azimuth", "moon_phase"), (not others, others)),
    }


def _moon_needs(options: Mapping[str, Any], *, is_known: bool, time: str) -> tuple[bool, str]:
    shown = shown_moon(options)
    if shown is None:
        return True, ""
    if not is_known:
        by_hand = " or --moon-elevation" if "moon_elevation" in options else ""
        return False, f"{shown} needs {time}{by_hand}"
    if shown != "exclude" and options["night"] == "off":
        return False, f"{shown} cannot be combined with --night off"
    if shown == "only" and options.get("stars") == "only":
        return False, "only cannot be combined with --stars only"
    if shown == "only" and options["sun_disc"] == "only":
        return False, "only cannot be combined with --sun-disc only"
    return True, ""


def moonlight_of_sequence(options: Mapping[str, Any]) -> Moonlight:
    """Return whether maps show the Moon, wherever it stands."""
    from skybake.image.moonlight import Moonlight

    if options["night"] == "off":
        return Moonlight(shown="exclude")
    return Moonlight(shown=shown_moon(options) or "include")


def moon_path_from_options(options: Mapping[str, Any]) -> MoonPath | None:
    """Return where a Moon by hand stands in a sequence, if there is one."""
    from skybake.sequence.moon_path import MoonPath

    if options["moon_elevation"] is None:
        return None
    path = MoonPath(options["moon_elevation"], phase=options["moon_phase"])
    azimuth = options["moon_azimuth"]
    return path if azimuth is None else replace(path, azimuth=azimuth)


def moonlight_from_options(
    options: Mapping[str, Any], moment: Moment | None, where: Mapping[str, Any]
) -> Moonlight:
    """Return what of the Moon a map shows.

    Parameters
    ----------
    options : mapping
        With the values of `moonlight_options`, ``--moon`` and ``--night``.
    moment : Moment or None
        When.
    where : mapping
        With the sun's azimuth and elevation, for a Moon by hand. [rad]

    Raises
    ------
    click.UsageError
        If there is no such Moon.
    """
    from skybake.ephemeris.lit_moon import moon_by_hand
    from skybake.image.moonlight import Moonlight, moonlight_at

    moonlight = moonlight_of_sequence(options)
    if moment is not None:
        shown = shown_moon(options)
        if shown in {"include", "only"} and moment.place.planet != "earth":
            raise click.UsageError(f"--moon: {shown} needs a place on Earth")
        return moonlight_at(moonlight, moment)
    if options.get("moon_elevation") is None:
        return moonlight
    azimuth = options["moon_azimuth"]
    try:
        moon = moon_by_hand(
            SOUTH if azimuth is None else azimuth,
            options["moon_elevation"],
            options["moon_phase"],
            where["sun_azimuth"],
            where["sun_elevation"],
        )
    except InputError as error:
        raise click.UsageError(f"--{error}") from error
    return Moonlight(moon, moonlight.shown)
