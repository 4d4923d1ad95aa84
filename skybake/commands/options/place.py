"""The options of the place from which the sun is seen, and of its clock."""

from __future__ import annotations

from datetime import date, datetime, timedelta
from typing import TYPE_CHECKING

import click

from skybake.commands.options import celestial
from skybake.commands.options.rules import (
    Needs,
    is_given,
    option_names,
    options_together,
    usage_faults,
)
from skybake.ephemeris.place import SITES, check_planet, find_place
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.place import Place

place_options = options_together(
    click.option(
        "--lat",
        "latitude",
        metavar="ANGLE",
        type=celestial.latitude,
        help="Latitude: 48.8566, 48.8566N or -54.8deg.",
    ),
    click.option(
        "--lon",
        "longitude",
        metavar="ANGLE",
        type=celestial.longitude,
        help="Longitude, positive in the east: 2.3522, 78.47W or -78.47deg.",
    ),
    click.option(
        "--site",
        type=click.Choice(tuple(SITES)),
        help="Place on Mars, instead of --lat and --lon.",
    ),
    click.option(
        "--ls",
        "solar_longitude",
        metavar="ANGLE",
        type=celestial.solar_longitude,
        help="Season on Mars, the sun's longitude Ls; times are then of local true solar time.",
    ),
    click.option(
        "--tz",
        "zone",
        metavar="AREA/CITY",
        help="Time zone of times without an offset and of --date, such as Europe/Paris.",
    ),
    click.option(
        "--date",
        "day",
        metavar="YYYY-MM-DD|today",
        type=celestial.day,
        help="Local date of sunset, noon and the like; also tomorrow or yesterday.",
    ),
    click.option(
        "--refraction/--no-refraction",
        default=None,
        show_default="on Earth for sunset, noon and the like",
        help="Raise the sun by refraction in Earth's atmosphere, half a degree at the horizon.",
    ),
)


def place_needs(*, is_timed: bool, time: str, is_latitude_free: bool = False) -> Needs:
    """Return what the options of a place need: `time`, the option or options of a time.

    If these are given, the sun cannot be placed by angles. A latitude may serve something else.
    """
    where = (
        *(() if is_latitude_free else ("latitude",)),
        "longitude",
        "site",
        "solar_longitude",
        "zone",
        "day",
        "refraction",
    )
    return dict.fromkeys(where, (is_timed, f"needs {time}")) | dict.fromkeys(
        ("sun_elevation", "sun_azimuth"), (not is_timed, f"cannot be combined with {time}")
    )


def day_from_options(context: click.Context, place: Place) -> date | None:
    """Return the date of ``--date``, in which today is that of the local clock.

    Raises
    ------
    click.UsageError
        If there is no such time zone.
    """
    day = context.params["day"]
    if not isinstance(day, str):
        found: date | None = day
        return found

    from skybake.ephemeris.events import mean_solar_zone
    from skybake.ephemeris.local_clock import find_zone

    name = context.params["zone"]
    try:
        zone = mean_solar_zone(place) if name is None else find_zone(name)
    except InputError as error:
        raise click.UsageError(f"--tz: {error}") from error
    return (datetime.now(zone) + timedelta(days=celestial.DAYS_FROM_TODAY[day])).date()


def place_from_options(context: click.Context, time: str) -> Place:
    """Return where the sun is seen from.

    Parameters
    ----------
    context : click.Context
        With `place_options` and ``--preset``.
    time : str
        The option or options of the time.

    Raises
    ------
    click.UsageError
        If too few or too many coordinates are given, or it is on another planet than
        the preset's.
    PresetError
        If the preset cannot be read.
    """
    from skybake.preset import planet_name

    options = context.params
    names = ("site", "solar_longitude", "latitude", "longitude")
    with usage_faults(context, place=time):
        place = find_place(**{name: options[name] for name in names})
    given = next(
        name for name in ("site", "solar_longitude", "latitude") if is_given(context, name)
    )
    with usage_faults(context, place=option_names(context)[given]):
        check_planet(place, planet_name(options["preset"]))
    return place
