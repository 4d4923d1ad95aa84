"""The sun's position at a time and a place, on Earth and on Mars."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date, datetime, timedelta, tzinfo

from skybake.ephemeris.clock import Clock, argument
from skybake.ephemeris.earth import refraction, sun_position
from skybake.ephemeris.mars import mars_time, sun_in_season
from skybake.ephemeris.place import Place
from skybake.ephemeris.times import (
    MAX_STEPS,
    local_text,
    parse_clock,
    steps,
    utc_text,
)
from skybake.errors import ArgumentError

_DAY = 86_400.0

Spread = Callable[[float, float], list[float]]
"""From the first and the last time to all that are wanted. [s]"""


@dataclass(frozen=True)
class Moment:
    """A time and the sun's position.

    Attributes
    ----------
    time : datetime or None
        In UTC; None for a time of day in a season of Mars.
    label : str
        Human-readable time, by the local clock if it is known.
    place : Place
        Where the sun is seen from.
    sun_elevation : float
        Of the sun's centre, geometric unless refraction was asked for. [rad]
    sun_azimuth : float
        Compass bearing: 0 = north, clockwise. [rad]
    attributes : mapping of str to str or float
        Time and place as files state them, see docs/formats.md.
    """

    time: datetime | None
    label: str
    place: Place
    sun_elevation: float
    sun_azimuth: float
    attributes: Mapping[str, str | float]


def sun_at(
    time: str | datetime,
    place: Place,
    *,
    zone: str | None = None,
    day: date | None = None,
    solar_longitude: float | None = None,
    refraction: bool = False,
) -> Moment:
    """Return the sun's position at a time and a place.

    Parameters
    ----------
    time : str or datetime
        With an offset, as ``2026-06-21T04:00Z``; in `zone` also without one; on Earth
        also an event of `day`, as ``sunset`` or ``noon-1h30min``; with
        `solar_longitude` a local true solar time, as ``16:30``.
    place : Place
        Where it is seen from.
    zone : str, optional
        Time zone, as ``Europe/Paris``, of times without an offset, of `day` and of labels.
    day : date, optional
        Local date of an event.
    solar_longitude : float, optional
        The season on Mars, Ls, from 0 to 2 pi. [rad]
    refraction : bool, optional
        Raise the sun by refraction in Earth's atmosphere.

    Raises
    ------
    ArgumentError
        If there is no such time, or an argument has no effect with the others.
    """
    clock = Clock(place, zone, day, solar_longitude, refraction)
    return _moments(clock, {"time": _text(time)}, lambda start, _: [start])[0]


@dataclass(frozen=True)
class TimeSpan:
    """Moments from a first to a last one.

    Attributes
    ----------
    start, end : str or datetime
        Times as of `sun_at`. An event at the end that does not follow the start is that
        of the next day, and so is a local true solar time on Mars.
    place : Place
        Where the sun is seen from.
    every : float or None
        Time between moments; with `solar_longitude` it is of local true solar time,
        86400 s a day. None spreads a number of moments evenly. [s]
    zone, day, solar_longitude, refraction
        As of `sun_at`.
    """

    start: str | datetime
    end: str | datetime
    place: Place
    every: float | None = None
    zone: str | None = None
    day: date | None = None
    solar_longitude: float | None = None
    refraction: bool = False

    def moments(self, count: int | None = None) -> list[Moment]:
        """Return all moments.

        Parameters
        ----------
        count : int, optional
            How many, where `every` is None.

        Raises
        ------
        ArgumentError
            As `sun_at`; or if the end does not follow the start, or there are none or too
            many moments.
        """
        clock = Clock(self.place, self.zone, self.day, self.solar_longitude, self.refraction)
        texts = {"start": _text(self.start), "end": _text(self.end)}
        return _moments(clock, texts, lambda start, end: self._spread(start, end, count))

    def _spread(self, start: float, end: float, count: int | None) -> list[float]:
        if self.every is not None:
            with argument("every"):
                return [start + step for step in steps(end - start, self.every)]
        if count is None or not 1 <= count <= MAX_STEPS:
            raise ArgumentError(
                "{frames}: must be from 1 to {most}, got {count}", most=MAX_STEPS, count=count
            )
        return [start + (end - start) * i / max(count - 1, 1) for i in range(count)]


def _moments(clock: Clock, texts: Mapping[str, str], spread: Spread) -> list[Moment]:
    clock.check(texts)
    if clock.solar_longitude is not None:
        return _in_season(clock, clock.solar_longitude, texts, spread)
    zone, start, end = clock.bounds(texts)
    sun = _on_mars if clock.is_on_mars else _on_earth
    times = spread(0.0, (end - start).total_seconds())
    with argument(next(iter(texts))):
        return [sun(start + timedelta(seconds=seconds), zone, clock) for seconds in times]


def _on_earth(time: datetime, zone: tzinfo | None, clock: Clock) -> Moment:
    elevation, azimuth = sun_position(time, clock.place)
    attributes = _attributes(time, clock.place)
    if clock.refraction:
        lift = refraction(elevation)
        elevation += lift
        attributes["skybake:refraction"] = math.degrees(lift)
    return Moment(time, _label(time, zone), clock.place, elevation, azimuth, attributes)


def _on_mars(time: datetime, zone: tzinfo | None, clock: Clock) -> Moment:
    now = mars_time(time)
    hour_angle = now.hour_angle(clock.place.longitude)
    sun = sun_in_season(now.solar_longitude, hour_angle, clock.place.latitude)
    attributes = _attributes(time, clock.place)
    attributes["skybake:solarLongitude"] = math.degrees(now.solar_longitude)
    attributes["skybake:trueSolarTime"] = _clock_text((hour_angle / (2 * math.pi) + 0.5) * _DAY)
    return Moment(time, _label(time, zone), clock.place, *sun, attributes)


def _in_season(
    clock: Clock, season: float, texts: Mapping[str, str], spread: Spread
) -> list[Moment]:
    times = []
    for name, text in texts.items():
        with argument(name):
            times.append(parse_clock(text))
    start, end = times[0], times[-1]
    if len(times) > 1 and end <= start:
        end += _DAY
    moments = []
    for seconds in spread(start, end):
        sun = sun_in_season(season, 2 * math.pi * (seconds / _DAY - 0.5), clock.place.latitude)
        attributes = _attributes(None, clock.place)
        attributes["skybake:solarLongitude"] = math.degrees(season)
        attributes["skybake:trueSolarTime"] = text = _clock_text(seconds)
        label = f"Ls {math.degrees(season):g} {text}"
        moments.append(Moment(None, label, clock.place, *sun, attributes))
    return moments


def _attributes(time: datetime | None, place: Place) -> dict[str, str | float]:
    where: dict[str, str | float] = {
        "skybake:latitude": math.degrees(place.latitude),
        "skybake:longitude": math.degrees(place.longitude),
    }
    return where if time is None else {"skybake:time": utc_text(time), **where}


def _text(time: str | datetime) -> str:
    return time if isinstance(time, str) else time.isoformat()


def _label(time: datetime, zone: tzinfo | None) -> str:
    return utc_text(time) if zone is None else local_text(time.astimezone(zone))


def _clock_text(seconds: float) -> str:
    """Write a time of day to a second."""
    minutes, second = divmod(round(seconds % _DAY), 60)
    return f"{minutes // 60 % 24:02}:{minutes % 60:02}:{second:02}"
