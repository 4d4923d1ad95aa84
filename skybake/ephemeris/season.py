"""Times of day in a season of Mars, by local true solar time."""

from __future__ import annotations

import math

from skybake.ephemeris import mars
from skybake.ephemeris.events import CROSSINGS, MOON_EVENTS, MORNING, absence_text
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.place import Place
from skybake.ephemeris.times import parse_clock, split_event
from skybake.errors import InputError

DAY = 86_400.0
"""Seconds of true solar time from midnight to midnight."""


def parse_solar_time(text: str, solar_longitude: float, place: Place, horizon: Horizon) -> float:
    """Read a local true solar time such as ``16:30``, or an event such as ``sunset-1h``.

    Parameters
    ----------
    text : str
        The offset of an event is in true solar time too.
    solar_longitude, place, horizon
        As of `event_in_season`.

    Returns
    -------
    float
        Since midnight; events with an offset may be before it or after the next. [s]

    Raises
    ------
    InputError
        If the text is no such time, or the event does not happen.
    """
    event = split_event(text)
    if event is None:
        return parse_clock(text)
    if event.search is not None:
        raise InputError(f"{text}: needs a date, and a season has none")
    return event_in_season(event.name, solar_longitude, place, horizon) + event.offset


def event_in_season(event: str, solar_longitude: float, place: Place, horizon: Horizon) -> float:
    """Return the local true solar time of an event on Mars.

    Parameters
    ----------
    event : str
        One of `skybake.ephemeris.events.EVENTS`.
    solar_longitude : float
        Ls. [rad]
    place : Place
        On Mars.
    horizon : Horizon
        On which the sun rises and sets.

    Returns
    -------
    float
        Since midnight, 0 to 86400. [s]

    Raises
    ------
    InputError
        If the sun does not pass that elevation in this season.
    """
    if event in {"noon", "midnight"}:
        return DAY / 2 if event == "noon" else 0.0
    if event in MOON_EVENTS:
        raise InputError(f"{event}: needs a place on Earth")
    elevation = CROSSINGS[event]
    if elevation is None:
        elevation = horizon.risen(mars.distance_in_season(solar_longitude))
    tilt, height = mars.declination(solar_longitude), mars.planetographic_latitude(place.latitude)
    reach = math.cos(tilt) * math.cos(height)
    above = math.sin(elevation) - math.sin(tilt) * math.sin(height)
    if not abs(above) <= reach:
        where = f"{place} at Ls {math.degrees(solar_longitude):g}"
        raise InputError(absence_text(event, where, stays_above=above < 0.0))
    since_noon = math.acos(above / reach) / math.pi * DAY / 2
    return DAY / 2 - since_noon if event in MORNING else DAY / 2 + since_noon
