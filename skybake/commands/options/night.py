"""The options of stars: whether they are in the map, and how they stand without a time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import values
from skybake.commands.options.rules import Needs
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment
    from skybake.image.night import Night

stars_option = click.option(
    "--stars",
    metavar="include|exclude|only|MAGNITUDE",
    type=values.stars,
    show_default="include, with a time",
    help="Whether the map holds the stars, or nothing else, or those up to a magnitude; where they "
    "stand is known with a time, or with --lst.",
)

lst_option = click.option(
    "--lst",
    "sidereal_time",
    metavar="HOURS|ANGLE",
    type=values.sidereal_time,
    help="Local sidereal time, such as 18.6h, 18:36 or 279deg, with --lat: how the stars of J2000 "
    "stand, wherever the sun is; over Mars in its worlds, over Earth in all others.",
)


def night_needs(options: Mapping[str, Any], *, is_timed: bool, time: str) -> Needs:
    """Return what the options of stars need: `time`, the option or options of a time."""
    sidereal = options.get("sidereal_time")
    return {
        "stars": (
            is_timed or sidereal is not None,
            f"needs {time}" + (" or --lst" if "sidereal_time" in options else ""),
        ),
        "sidereal_time": (
            not is_timed and options["latitude"] is not None,
            f"cannot be combined with {time}" if is_timed else "needs --lat",
        ),
    }


def night_from_options(options: Mapping[str, Any], moment: Moment | None = None) -> Night:
    """Return which stars a map shows.

    Parameters
    ----------
    options : mapping
        With the values of `stars_option`, and of ``--lst`` and ``--lat`` if there are any.
    moment : Moment, optional
        When.

    Raises
    ------
    click.UsageError
        If the magnitude is out of its range.
    PresetError
        If the preset cannot be read.
    """
    from skybake.image.night import Night, night_at

    wanted = options["stars"]
    shown = {} if wanted is None else {"stars": wanted}
    if isinstance(wanted, float):
        shown = {"faintest_star": wanted}
    try:
        night = Night(**shown)
    except InputError as error:
        raise click.UsageError(f"--{error}") from error
    if moment is not None:
        return night_at(night, moment)
    if options.get("sidereal_time") is None:
        return night

    from dataclasses import replace

    from skybake.ephemeris.celestial import CelestialFrame
    from skybake.preset import planet_name

    # Elsewhere than on Mars the stars stand as over Earth.
    planet = "mars" if planet_name(options["preset"]) == "mars" else "earth"
    frame = CelestialFrame(planet, options["sidereal_time"], options["latitude"])
    return replace(night, frame=frame)
