"""Times as users type them, and steps through them."""

from __future__ import annotations

import re
from datetime import UTC, date, datetime, timedelta, tzinfo
from difflib import get_close_matches
from typing import Literal, NamedTuple

from skybake.ephemeris.events import EVENTS, MOON_EVENTS, Search, event_time, mean_solar_zone
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.local_clock import check_day, day_exists, from_local, utc_text
from skybake.ephemeris.place import Place
from skybake.errors import InputError
from skybake.units import parse_duration

FIRST_YEAR, LAST_YEAR = 1000, 2999
MAX_STEPS = 100_000
"""Most moments of a range; more is a typing error."""

_OFFSET = r"(?:Z|[+-]\d\d:[0-5]\d(?::[0-5]\d)?)"
_ISO = re.compile(rf"\d{{4}}-\d\d-\d\dT\d\d:\d\d(?::\d\d(?:\.\d{{1,6}})?)?({_OFFSET})?", re.ASCII)
_EVENT = re.compile(rf"(?:(next|previous)-)?({'|'.join((*EVENTS, *MOON_EVENTS))})(?:([+-])(.+))?")
_SECONDS_OF_DAY = 86_400.0


def kind_of(text: str) -> Literal["event", "local", "absolute", "unknown"]:
    """Return what a text means: an event, a time of the local clock, or one with an offset."""
    if _EVENT.fullmatch(text):
        return "event"
    iso = _ISO.fullmatch(text)
    if iso is None:
        return "unknown"
    return "local" if iso[1] is None else "absolute"


class Event(NamedTuple):
    """An event as it was typed.

    Attributes
    ----------
    name : str
        One of `EVENTS` or `MOON_EVENTS`.
    search : {"next", "previous"} or None
        As of `event_time`.
    offset : float
        From the event to the time that is meant. [s]
    """

    name: str
    search: Search | None
    offset: float


def split_event(text: str) -> Event | None:
    """Read an event such as ``next-sunset-1h``; None if the text is none.

    Raises
    ------
    InputError
        If its offset is no duration, or longer than a day.
    """
    match = _EVENT.fullmatch(text)
    if match is None:
        return None
    before, name, sign, length = match.groups()
    search: Search | None = None if before is None else "next" if before == "next" else "previous"
    offset = parse_duration(length) if sign else 0.0
    if offset > _SECONDS_OF_DAY:
        raise InputError(f"{name}: offset must be at most 24h, got {length}")
    return Event(name, search, -offset if sign == "-" else offset)


def parse_time(
    text: str,
    *,
    place: Place | None = None,
    zone: tzinfo | None = None,
    day: date | None = None,
    horizon: Horizon | None = None,
) -> datetime:
    """Read a time such as ``2026-06-21T04:00Z`` or ``sunset+10min``.

    Parameters
    ----------
    text : str
        ISO 8601 with an offset or, if there is a zone, without one; or one of `EVENTS` or
        `MOON_EVENTS`, optionally with ``next-`` or ``previous-`` before it and an offset after.
    place : Place, optional
        Of events.
    zone : tzinfo, optional
        The local clock; for events without one, that of the place's mean sun.
    day : date, optional
        Of events, by the local clock.
    horizon : Horizon, optional
        As of `skybake.ephemeris.events.event_time`.

    Returns
    -------
    datetime
        In UTC.

    Raises
    ------
    InputError
        If the text is not such a time, if the local clock shows it never or twice, or if
        the event does not happen.
    """
    event = split_event(text)
    if event is not None:
        return _in_range(_time_of(event, place, zone, day, horizon), text)
    iso = _ISO.fullmatch(text)
    if iso is None:
        like = ", ".join(get_close_matches(text, (*EVENTS, *MOON_EVENTS), n=3))
        raise InputError(
            "must be a time such as 2026-06-21T04:00Z or an event such as sunset+10min, "
            f"got {text!r}" + (f"; nearest: {like}" if like else "")
        )
    try:
        moment = datetime.fromisoformat(text)
    except ValueError as error:
        raise InputError(f"must be a date and time that exists, got {text!r}") from error
    _in_range(moment, text)
    if moment.tzinfo is None:
        if zone is None:
            raise InputError(
                f"needs an offset, as {text}Z or {text}+02:00, or a time zone, since clocks "
                f"differ, got {text!r}"
            )
        return from_local(moment, zone)
    return moment.astimezone(UTC)


def parse_end(
    text: str,
    start: datetime,
    *,
    place: Place | None = None,
    zone: tzinfo | None = None,
    day: date | None = None,
    horizon: Horizon | None = None,
) -> datetime:
    """Read the end of a range; an event that is not after the start is that of the next day.

    Parameters and errors are those of `parse_time`; an end that is not after the start is
    an InputError too.
    """
    end = parse_time(text, place=place, zone=zone, day=day, horizon=horizon)
    if end <= start and kind_of(text) == "event" and day is not None:
        day += timedelta(days=1)
        if zone is not None and not day_exists(day, zone):
            day += timedelta(days=1)
        end = parse_time(text, place=place, zone=zone, day=day, horizon=horizon)
    if end <= start:
        raise InputError(f"must be after the start, {utc_text(start)}, got {utc_text(end)}")
    return end


def parse_clock(text: str) -> float:
    """Read a time of day, ``00:00`` to ``24:00``, optionally with seconds. [s]"""
    match = re.fullmatch(r"(\d\d):([0-5]\d)(?::([0-5]\d))?", text, re.ASCII)
    seconds = 3600.0 * int(match[1]) + 60.0 * int(match[2]) + int(match[3] or 0) if match else -1.0
    if not 0.0 <= seconds <= _SECONDS_OF_DAY:
        raise InputError(f"must be a time of day such as 04:00 or 16:30:15, got {text!r}")
    return seconds


def steps(span: float, every: float) -> list[float]:
    """Return multiples of a step from 0 up to a span, with its end if it falls on a step.

    Parameters
    ----------
    span, every : float
        Both in one unit.

    Raises
    ------
    InputError
        If the step is not positive, or there are more than `MAX_STEPS`.
    """
    if not every > 0.0:
        raise InputError(f"must be longer than 0s, got {every:g}s")
    if span / every > MAX_STEPS:
        raise InputError(f"must give at most {MAX_STEPS} frames, got {span / every:.7g}")
    # In binary numbers a sum of steps can differ from their product in its last bits.
    return [i * every for i in range(int(span / every + 1e-9) + 1)]


def _time_of(
    event: Event,
    place: Place | None,
    zone: tzinfo | None,
    day: date | None,
    horizon: Horizon | None,
) -> datetime:
    if place is None or day is None:
        raise InputError(f"{event.name} needs a place and a date, got none")
    if not FIRST_YEAR <= day.year <= LAST_YEAR:
        raise InputError(f"date must be in the years {FIRST_YEAR} to {LAST_YEAR}, got {day}")
    if zone is None:
        zone = mean_solar_zone(place)
    check_day(day, zone)
    moment = event_time(event.name, day, place, zone, horizon=horizon, search=event.search)
    return moment + timedelta(seconds=event.offset)


def _in_range(moment: datetime, text: str) -> datetime:
    if not FIRST_YEAR <= moment.year <= LAST_YEAR:
        raise InputError(f"must be in the years {FIRST_YEAR} to {LAST_YEAR}, got {text!r}")
    return moment
