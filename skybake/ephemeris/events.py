"""Sunrise, sunset and other events: when the sun passes an elevation or the meridian."""

from __future__ import annotations

import math
from collections.abc import Callable
from datetime import UTC, date, datetime, time, timedelta, timezone, tzinfo
from typing import Literal, NamedTuple, Protocol

from skybake.ephemeris import earth, mars
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.place import Place
from skybake.errors import InputError

CROSSINGS = {
    "sunrise": None,
    "sunset": None,
    "civil-dawn": math.radians(-6.0),
    "civil-dusk": math.radians(-6.0),
    "nautical-dawn": math.radians(-12.0),
    "nautical-dusk": math.radians(-12.0),
    "astronomical-dawn": math.radians(-18.0),
    "astronomical-dusk": math.radians(-18.0),
}
"""Elevations; None is that of a sun on the horizon."""

MORNING = ("sunrise", "civil-dawn", "nautical-dawn", "astronomical-dawn")
_VERBS = {"sunrise": "rise", "sunset": "set"}

EVENTS = (*CROSSINGS, "noon", "midnight")
"""Events of the sun."""

MOON_EVENTS = ("moonrise", "moonset")
"""Events of the Moon, on Earth."""

_DAY = timedelta(days=1)
_SECOND = timedelta(seconds=1)

Search = Literal["next", "previous"]


class _Motion(NamedTuple):
    """How the sun moves in the sky of a planet."""

    position: Callable[[datetime, Place], tuple[float, float]]
    hour_angle: Callable[[datetime, Place], float]
    distance: Callable[[datetime], float]
    day: timedelta
    year: int  # days


_MOTIONS = {
    "earth": _Motion(earth.sun_position, earth.hour_angle, earth.sun_distance, _DAY, 366),
    "mars": _Motion(
        mars.sun_position,
        mars.hour_angle,
        lambda time: mars.mars_time(time).sun_distance,
        _DAY * mars.SOL_DAYS,
        687,
    ),
}


def mean_solar_zone(place: Place) -> tzinfo:
    """Return the clock of mean solar time at a place on Earth; of one on Mars UTC."""
    if place.planet != "earth":
        return UTC
    return timezone(timedelta(seconds=round(place.longitude / (2.0 * math.pi) * 86_400.0)))


def event_time(
    event: str,
    day: date,
    place: Place,
    zone: tzinfo,
    *,
    horizon: Horizon | None = None,
    search: Search | None = None,
) -> datetime:
    """Return the time of an event.

    Parameters
    ----------
    event : str
        One of `EVENTS` or `MOON_EVENTS`. Those of the morning, and midnight, are the last before
        the true noon of the day, those of the evening the first after it; at high latitudes they
        may have another date. On Mars, whose days are longer, the noon is the first
        after the date has begun. Those of the Moon are the first on the local date.
    day : date
        By the local clock.
    place : Place
        Where.
    zone : tzinfo
        The local clock.
    horizon : Horizon, optional
        On which the sun rises and sets; by default that of an observer on the ground, with
        refraction on Earth.
    search : {"next", "previous"}, optional
        If the event does not happen on the day, take the next or the previous one within a
        year of the planet.

    Returns
    -------
    datetime
        In UTC, to a second.

    Raises
    ------
    InputError
        If the sun does not pass that elevation, as in polar night and midnight sun, or the Moon
        the horizon, as on one day a month; the message says when it last did and will again.
    """
    horizon = horizon or Horizon(place.planet)
    if event in MOON_EVENTS:
        from skybake.ephemeris.moon_events import MoonDay

        return _found(MoonDay(event, place, zone, horizon), day, search)
    return _found(_Day(event, place, zone, horizon), day, search)


class _Event(Protocol):
    """An event at a place, of any day."""

    def time(self, day: date) -> datetime | None: ...

    def nearest(self, day: date, step: int) -> datetime | None: ...

    def absence(self, day: date) -> str: ...


def _found(seen: _Event, day: date, search: Search | None) -> datetime:
    found = seen.time(day)
    if found is None and search is not None:
        found = seen.nearest(day, 1 if search == "next" else -1)
    if found is None:
        raise InputError(seen.absence(day))
    return found


class _Day(NamedTuple):
    """An event at a place, of any day."""

    event: str
    place: Place
    zone: tzinfo
    horizon: Horizon

    @property
    def motion(self) -> _Motion:
        return _MOTIONS[self.place.planet]

    def time(self, day: date) -> datetime | None:
        """Return when it happens on a day, or None if it does not."""
        noon = _noon(day, self.place, self.zone)
        if self.event == "noon":
            return _whole(noon)
        is_morning = self.event == "midnight" or self.event in MORNING
        midnight = self.midnight(noon, before=is_morning)
        if self.event == "midnight":
            return _whole(midnight)
        target = self.target(noon)
        # Beside a pole the sun may climb past noon, and pass the elevation in the other half.
        other = self.midnight(noon, before=not is_morning)
        for low, high in ((midnight, noon), (noon, other)):
            if self.elevation(low) <= target <= self.elevation(high):
                return _whole(self.crossing(low, high, target))
        return None

    def midnight(self, noon: datetime, *, before: bool) -> datetime:
        """Return the sun's lower culmination before or after a noon."""
        half = self.motion.day / 2
        return _culmination(noon - half if before else noon + half, self.place, math.pi)

    def elevation(self, moment: datetime) -> float:
        return self.motion.position(moment, self.place)[0]

    def target(self, moment: datetime) -> float:
        """Return the elevation that the sun's centre passes."""
        elevation = CROSSINGS[self.event]
        return self.horizon.risen(self.motion.distance(moment)) if elevation is None else elevation

    def crossing(self, low: datetime, high: datetime, target: float) -> datetime:
        """Return when the sun passes an elevation, by bisection between below and above."""
        while abs(high - low) > _SECOND / 10:
            middle = low + (high - low) / 2
            if self.elevation(middle) < target:
                low = middle
            else:
                high = middle
        return low

    def nearest(self, day: date, step: int) -> datetime | None:
        """Return when it happens first after a day, or before it with a step of -1."""
        for days in range(1, self.motion.year + 1):
            try:
                found = self.time(day + step * timedelta(days=days))
            except (InputError, OverflowError):
                # Beyond the years that the sun's path is known for.
                return None
            if found is not None:
                return found
        return None

    def absence(self, day: date) -> str:
        """Say that it does not happen on a day, and when it does."""
        noon = _noon(day, self.place, self.zone)
        stays_above = self.elevation(noon) > self.target(noon)
        text = absence_text(self.event, f"{self.place} on {day}", stays_above=stays_above)
        return "; ".join([text, *dates_around(self, self.event, day, self.zone)])


def dates_around(seen: _Event, event: str, day: date, zone: tzinfo) -> list[str]:
    """Say when an event that does not happen on a day last did, and when it will again."""
    around = {"previous": seen.nearest(day, -1), "next": seen.nearest(day, 1)}
    return [
        f"{search}-{event} is on {found.astimezone(zone):%Y-%m-%d}"
        for search, found in around.items()
        if found is not None
    ]


def absence_text(event: str, where: str, *, stays_above: bool) -> str:
    """Say that the sun does not pass the elevation of an event."""
    elevation = CROSSINGS[event]
    level = "the horizon" if elevation is None else f"{math.degrees(elevation):g}deg"
    verb = _VERBS.get(event, f"pass {level}")
    side = "above" if stays_above else "below"
    return f"{event}: the sun does not {verb} at {where}, it stays {side} {level}"


def _noon(day: date, place: Place, zone: tzinfo) -> datetime:
    """Return the sun's upper culmination on a day, or within 17 minutes of it."""
    start = datetime.combine(day, time(), zone).astimezone(UTC)
    motion = _MOTIONS[place.planet]
    if place.planet == "earth":
        since_midnight = timedelta(hours=start.hour, minutes=start.minute, seconds=start.second)
        mean_noon = _DAY / 2 - _DAY * (place.longitude / (2.0 * math.pi))
        return _culmination(start + (mean_noon - since_midnight) % _DAY, place, 0.0)
    ahead = -motion.hour_angle(start, place) % (2.0 * math.pi)
    return _culmination(start + motion.day * (ahead / (2.0 * math.pi)), place, 0.0)


def _culmination(near: datetime, place: Place, angle: float) -> datetime:
    """Return when the sun has an hour angle, near a time."""
    motion = _MOTIONS[place.planet]
    # The hour angle grows by a turn a day to 1e-3, so an error of 17 minutes becomes 1 s
    # and then vanishes.
    for _ in range(3):
        off = math.remainder(motion.hour_angle(near, place) - angle, 2.0 * math.pi)
        near -= motion.day * (off / (2.0 * math.pi))
    return near


def _whole(moment: datetime) -> datetime:
    return (moment + _SECOND / 2).replace(microsecond=0)
