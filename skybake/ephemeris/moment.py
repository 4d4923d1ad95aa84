"""The sun's position at a time and a place, on Earth and on Mars."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import date, datetime, timedelta, tzinfo

from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.clock import Clock, argument
from skybake.ephemeris.earth import sun_distance, sun_position
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.lit_moon import LitMoon
from skybake.ephemeris.local_clock import local_text, utc_text
from skybake.ephemeris.mars import distance_in_season, mars_time, sun_in_season
from skybake.ephemeris.moon import Moon
from skybake.ephemeris.place import Place
from skybake.ephemeris.season import DAY
from skybake.ephemeris.sidereal import frame_at, frame_in_season
from skybake.ephemeris.times import MAX_STEPS, steps
from skybake.errors import ArgumentError
from skybake.units import degrees

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
    sun_distance : float
        From the planet then. [au]
    attributes : mapping of str to str or float
        Time and place as files state them, see docs/formats.md.
    moon : Moon or None
        The moon that is nearest to the sun; None in a season of Mars, which has no date.
    celestial : CelestialFrame or None
        How the stars stand.
    lit_moon : LitMoon or None
        The Moon as a light, on Earth.
    """

    time: datetime | None
    label: str
    place: Place
    sun_elevation: float
    sun_azimuth: float
    sun_distance: float
    attributes: Mapping[str, str | float]
    moon: Moon | None = None
    celestial: CelestialFrame | None = None
    lit_moon: LitMoon | None = None

    @property
    def is_refracted(self) -> bool:
        """Whether the sun is where refraction shows it, and stars have to be as well."""
        return "skybake:refraction" in self.attributes


def sun_at(
    time: str | datetime,
    place: Place,
    *,
    zone: str | None = None,
    day: date | None = None,
    solar_longitude: float | None = None,
    refraction: bool | None = None,
    altitude: float = 0.0,
) -> Moment:
    """Return the sun's position at a time and a place.

    Parameters
    ----------
    time : str or datetime
        With an offset, as ``2026-06-21T04:00Z``; in `zone` also without one; an event of
        `day`, as ``sunset`` or ``noon-1h30min``, or ``next-sunset`` if it may be a later
        day; with `solar_longitude` an event, or a local true solar time, as ``16:30``.
    place : Place
        Where it is seen from.
    zone : str, optional
        Time zone, as ``Europe/Paris``, of times without an offset, of `day` and of labels.
    day : date, optional
        Local date of an event.
    solar_longitude : float, optional
        The season on Mars, Ls, from 0 to 2 pi. [rad]
    refraction : bool, optional
        Whether to raise the sun by refraction in Earth's atmosphere; by default if the
        time is that of an event. Without it the sun rises and sets as it would without air.
    altitude : float, optional
        Of the observer above the ground, from where the sun is seen longer. [km]

    Raises
    ------
    ArgumentError
        If there is no such time, or an argument has no effect with the others.
    """
    clock = Clock(place, zone, day, solar_longitude, refraction, (altitude, altitude))
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
        As of `sun_at`; with an event at either end, refraction is that of all moments.
    altitude : float, tuple of 2 float, or None
        Of the observer above the ground; of two, at the first moment and at the last, and
        evenly between. None is the ground, or in a sequence its observer. [km]
    """

    start: str | datetime
    end: str | datetime
    place: Place
    every: float | None = None
    zone: str | None = None
    day: date | None = None
    solar_longitude: float | None = None
    refraction: bool | None = None
    altitude: float | tuple[float, float] | None = None

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
        ends = self.altitude or 0.0
        clock = Clock(
            self.place,
            self.zone,
            self.day,
            self.solar_longitude,
            self.refraction,
            ends if isinstance(ends, tuple) else (ends, ends),
        )
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
        season = clock.solar_longitude
        times = spread(*clock.solar_bounds(season, texts))
        return [_in_season(season, seconds, clock.place) for seconds in times]
    zone, start, end = clock.bounds(texts)
    times = spread(0.0, (end - start).total_seconds())
    horizons = _horizons(*clock.horizons(texts.values()), len(times))
    with argument(next(iter(texts))):
        return [
            _at(start + timedelta(seconds=seconds), zone, clock.place, horizon)
            for seconds, horizon in zip(times, horizons, strict=True)
        ]


def _horizons(first: Horizon, last: Horizon, count: int) -> list[Horizon]:
    """Return the horizon of each moment; its altitude changes evenly."""
    if first == last:
        return [first] * count
    climb = last.altitude - first.altitude
    return [
        replace(first, altitude=first.altitude + climb * i / max(count - 1, 1))
        for i in range(count)
    ]


def _at(time: datetime, zone: tzinfo | None, place: Place, horizon: Horizon) -> Moment:
    label = _label(time, zone)
    attributes = _attributes(time, place)
    if place.planet == "mars":
        now = mars_time(time)
        hour_angle = now.hour_angle(place.longitude)
        sun = sun_in_season(now.solar_longitude, hour_angle, place.latitude)
        attributes["skybake:solarLongitude"] = degrees(now.solar_longitude)
        attributes["skybake:trueSolarTime"] = _clock_text((hour_angle / (2 * math.pi) + 0.5) * DAY)
        return Moment(
            time,
            label,
            place,
            *sun,
            now.sun_distance,
            attributes,
            _moon(time, place, horizon, *sun),
            frame_at(time, place),
        )
    elevation, azimuth = sun_position(time, place)
    if horizon.refraction:
        lift = horizon.lift(elevation)
        elevation += lift
        attributes["skybake:refraction"] = degrees(lift)
    sun = elevation, azimuth
    moon = _moon(time, place, horizon, *sun)
    distance, stars = sun_distance(time), frame_at(time, place)
    lit = _lit_moon(time, place, horizon)
    return Moment(time, label, place, *sun, distance, attributes, moon, stars, lit)


def _moon(time: datetime, place: Place, horizon: Horizon, elevation: float, azimuth: float) -> Moon:
    # Kept out of what asks for no moment, since it needs arrays.
    from skybake.ephemeris.moons import moon_before_sun

    return moon_before_sun(time, place, horizon.altitude, azimuth, elevation)


def _lit_moon(time: datetime, place: Place, horizon: Horizon) -> LitMoon:
    # As of `_moon`.
    from skybake.ephemeris.moonlight import lit_moon_at

    return lit_moon_at(time, place, horizon.altitude, horizon.lift if horizon.refraction else None)


def _in_season(season: float, seconds: float, place: Place) -> Moment:
    """Return the moment of a local true solar time on Mars. [s]"""
    hour_angle = 2 * math.pi * (seconds / DAY - 0.5)
    sun = sun_in_season(season, hour_angle, place.latitude)
    attributes = _attributes(None, place)
    attributes["skybake:solarLongitude"] = degrees(season)
    attributes["skybake:trueSolarTime"] = text = _clock_text(seconds)
    label = f"Ls {degrees(season):g} {text}"
    stars = frame_in_season(season, hour_angle, place.latitude)
    distance = distance_in_season(season)
    return Moment(None, label, place, *sun, distance, attributes, celestial=stars)


def _attributes(time: datetime | None, place: Place) -> dict[str, str | float]:
    where: dict[str, str | float] = {
        "skybake:latitude": degrees(place.latitude),
        "skybake:longitude": degrees(place.longitude),
    }
    return where if time is None else {"skybake:time": utc_text(time), **where}


def _text(time: str | datetime) -> str:
    return time if isinstance(time, str) else time.isoformat()


def _label(time: datetime, zone: tzinfo | None) -> str:
    return utc_text(time) if zone is None else local_text(time.astimezone(zone))


def _clock_text(seconds: float) -> str:
    """Write a time of day to a second."""
    minutes, second = divmod(round(seconds % DAY), 60)
    return f"{minutes // 60 % 24:02}:{minutes % 60:02}:{second:02}"
