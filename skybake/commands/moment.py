"""From options of place and time to where the sun stands, on Earth and on Mars."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import datetime, timedelta, tzinfo
from typing import TYPE_CHECKING, Any, NamedTuple

import click
from click.core import ParameterSource

from skybake.commands.place import check_place, is_on_mars, refuse_places
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.place import Place

_DAY = 86_400.0

time_option = click.option(
    "--time",
    metavar="TIME",
    help="Put the sun where it stands at --lat and --lon: 2026-06-21T04:00Z, or sunset+10min; "
    "on Mars at --site, or 16:30 with --ls.",
)


class Moment(NamedTuple):
    """A time and where the sun stands then.

    Attributes
    ----------
    time : datetime or None
        In UTC; None for a time of day in a season of Mars.
    label : str
        The time for people, by the local clock if it is known.
    sun_elevation, sun_azimuth : float
        As of `skybake.baking.MapSettings`. [rad]
    attributes : mapping of str to str or float
        What a file says of time and place, see docs/formats.md.
    """

    time: datetime | None
    label: str
    sun_elevation: float
    sun_azimuth: float
    attributes: Mapping[str, str | float]


Spread = Callable[[float, float], list[float]]
"""From the first and the last time to all that are wanted. [s]"""


def moment(context: click.Context) -> Moment | None:
    """Return the moment that ``--time`` asks for.

    Raises
    ------
    click.UsageError
        If there is no such time, or an option that would have no effect.
    PresetError
        If the preset cannot be read.
    """
    options = context.params
    if options["time"] is None:
        refuse_places(options, "--time")
        return None
    refuse_sun(context, "--time")
    return _resolve(options, {"--time": options["time"]}, lambda start, _: [start])[0]


def refuse_sun(context: click.Context, time: str) -> None:
    """Refuse a sun by angles where `time`, the option or options of a time, puts it.

    Raises
    ------
    click.UsageError
        That names both.
    """
    for name, option in (("sun_elevation", "--sun"), ("sun_azimuth", "--sun-azimuth")):
        if context.get_parameter_source(name) is not ParameterSource.DEFAULT:
            raise click.UsageError(f"{option}: needs no {time} beside it")


def moments(options: Mapping[str, Any], count: int | None) -> list[Moment]:
    """Return moments from a start to an end.

    Parameters
    ----------
    options : mapping
        With the values of `place_options`, ``preset``, the texts ``start`` and ``end``,
        and the step ``every``, in seconds or None. In a season of Mars a step is of
        local true solar time, 86400 s a day.
    count : int or None
        Without a step, how many moments are spread evenly from start to end.

    Raises
    ------
    click.UsageError, PresetError
        As of `moment`.
    """
    return _resolve(
        options,
        {"--from": options["start"], "--to": options["end"]},
        lambda start, end: _spread(start, end, options["every"], count),
    )


def _spread(start: float, end: float, every: float | None, count: int | None) -> list[float]:
    from skybake.ephemeris.times import MAX_STEPS, steps

    if every is not None:
        with _named("--every"):
            return [start + step for step in steps(end - start, every)]
    if count is None or not 1 <= count <= MAX_STEPS:
        raise click.UsageError(f"--frames: must be from 1 to {MAX_STEPS}, got {count}")
    return [start + (end - start) * i / max(count - 1, 1) for i in range(count)]


def _resolve(options: Mapping[str, Any], texts: dict[str, str], spread: Spread) -> list[Moment]:
    check_place(options, texts)
    if options["ls"] is not None:
        return _in_season(options, texts, spread)
    place = _place(options)
    zone, start, end = _bounds(options, texts, None if is_on_mars(options) else place)
    sun = _on_mars if is_on_mars(options) else _on_earth
    with _named(next(iter(texts))):
        return [
            sun(start + timedelta(seconds=seconds), place, zone, options)
            for seconds in spread(0.0, (end - start).total_seconds())
        ]


def _bounds(
    options: Mapping[str, Any], texts: dict[str, str], place: Place | None
) -> tuple[tzinfo | None, datetime, datetime]:
    """Return the local clock, the first time and the last."""
    from skybake.ephemeris.times import find_zone, parse_end, parse_time

    zone = None
    if options["tz"] is not None:
        with _named("--tz"):
            zone = find_zone(options["tz"])
    (first, text), *others = texts.items()
    with _named(first):
        start = end = parse_time(text, place=place, zone=zone, day=options["date"])
    for last, text in others:
        with _named(last):
            end = parse_end(text, start, place=place, zone=zone, day=options["date"])
    return zone, start, end


def _on_earth(
    time: datetime, place: Place, zone: tzinfo | None, options: Mapping[str, Any]
) -> Moment:
    from skybake.ephemeris.earth import refraction, sun_position

    elevation, azimuth = sun_position(time, place)
    attributes = _attributes(time, place)
    if options["refraction"]:
        lift = refraction(elevation)
        elevation += lift
        attributes["skybake:refraction"] = math.degrees(lift)
    return Moment(time, _label(time, zone), elevation, azimuth, attributes)


def _on_mars(time: datetime, place: Place, zone: tzinfo | None, _: Mapping[str, Any]) -> Moment:
    from skybake.ephemeris.mars import mars_time, sun_in_season

    now = mars_time(time)
    hour_angle = now.hour_angle(place.longitude)
    sun = sun_in_season(now.solar_longitude, hour_angle, place.latitude)
    attributes = _attributes(time, place)
    attributes["skybake:solarLongitude"] = math.degrees(now.solar_longitude)
    attributes["skybake:trueSolarTime"] = _clock((hour_angle / (2 * math.pi) + 0.5) * _DAY)
    return Moment(time, _label(time, zone), *sun, attributes)


def _in_season(options: Mapping[str, Any], texts: dict[str, str], spread: Spread) -> list[Moment]:
    from skybake.ephemeris.mars import sun_in_season
    from skybake.ephemeris.times import parse_clock

    times = []
    for option, text in texts.items():
        with _named(option):
            times.append(parse_clock(text))
    start, end = times[0], times[-1]
    if len(times) > 1 and end <= start:
        end += _DAY
    place, season = _place(options), options["ls"]
    moments = []
    for seconds in spread(start, end):
        sun = sun_in_season(season, 2 * math.pi * (seconds / _DAY - 0.5), place.latitude)
        attributes = _attributes(None, place)
        attributes["skybake:solarLongitude"] = math.degrees(season)
        attributes["skybake:trueSolarTime"] = clock = _clock(seconds)
        label = f"Ls {math.degrees(season):g} {clock}"
        moments.append(Moment(None, label, *sun, attributes))
    return moments


def _place(options: Mapping[str, Any]) -> Place:
    from skybake.ephemeris.mars import SITES
    from skybake.ephemeris.place import Place

    if options["site"] is not None:
        return SITES[options["site"]]
    return Place(options["lat"], options["lon"])


def _attributes(time: datetime | None, place: Place) -> dict[str, str | float]:
    from skybake.ephemeris.times import utc_text

    where: dict[str, str | float] = {
        "skybake:latitude": math.degrees(place.latitude),
        "skybake:longitude": math.degrees(place.longitude),
    }
    return where if time is None else {"skybake:time": utc_text(time), **where}


def _label(time: datetime, zone: tzinfo | None) -> str:
    from skybake.ephemeris.times import local_text, utc_text

    return utc_text(time) if zone is None else local_text(time.astimezone(zone))


def _clock(seconds: float) -> str:
    """Write a time of day to a second."""
    minutes, second = divmod(round(seconds % _DAY), 60)
    return f"{minutes // 60 % 24:02}:{minutes % 60:02}:{second:02}"


@contextmanager
def _named(option: str) -> Iterator[None]:
    """Turn a fault of a value into wrong usage of an option."""
    try:
        yield
    except InputError as error:
        raise click.UsageError(f"{option}: {error}") from error
