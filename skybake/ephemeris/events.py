"""Sunrise, sunset and other events: when the sun passes an elevation or the meridian."""

from __future__ import annotations

import math
from datetime import UTC, date, datetime, time, timedelta, timezone, tzinfo

from skybake.ephemeris.earth import hour_angle, sun_position
from skybake.ephemeris.place import Place
from skybake.errors import InputError

# The disc's upper edge, 16' above its centre, is seen on the horizon, where refraction lifts it
# by 34': the almanacs' convention.
_RISEN = math.radians(-50.0 / 60.0)

_CROSSINGS = {
    "sunrise": _RISEN,
    "sunset": _RISEN,
    "civil-dawn": math.radians(-6.0),
    "civil-dusk": math.radians(-6.0),
    "nautical-dawn": math.radians(-12.0),
    "nautical-dusk": math.radians(-12.0),
    "astronomical-dawn": math.radians(-18.0),
    "astronomical-dusk": math.radians(-18.0),
}
_MORNING = ("sunrise", "civil-dawn", "nautical-dawn", "astronomical-dawn")
_VERBS = {"sunrise": "rise", "sunset": "set"}

EVENTS = (*_CROSSINGS, "noon", "midnight")
"""Events of `event_time`."""

_DAY = timedelta(days=1)
_SECOND = timedelta(seconds=1)


def mean_solar_zone(place: Place) -> tzinfo:
    """Return the clock of mean solar time at a place."""
    return timezone(timedelta(seconds=round(place.longitude / (2.0 * math.pi) * 86_400.0)))


def event_time(event: str, day: date, place: Place, zone: tzinfo) -> datetime:
    """Return the time of an event.

    Parameters
    ----------
    event : str
        One of `EVENTS`. Those of the morning, and midnight, are the last before the true
        noon of the day, those of the evening the first after it; at high latitudes they
        may have another date.
    day : date
        By the local clock.
    place : Place
        Where.
    zone : tzinfo
        The local clock.

    Returns
    -------
    datetime
        In UTC, to a second.

    Raises
    ------
    InputError
        If the sun does not pass that elevation, as in polar night and midnight sun.
    """
    noon = _noon(day, place, zone)
    if event == "noon":
        return _whole(noon)
    is_morning = event == "midnight" or event in _MORNING
    midnight = _culmination(noon - _DAY / 2 if is_morning else noon + _DAY / 2, place, math.pi)
    if event == "midnight":
        return _whole(midnight)
    target = _CROSSINGS[event]
    lowest, highest = sun_position(midnight, place)[0], sun_position(noon, place)[0]
    if not lowest <= target <= highest:
        stays = "above" if lowest > target else "below"
        level = "the horizon" if event in _VERBS else f"{math.degrees(target):g}deg"
        verb = _VERBS.get(event, f"pass {level}")
        raise InputError(
            f"{event}: the sun does not {verb} at {place} on {day}, it stays {stays} {level}"
        )
    return _whole(_crossing(midnight, noon, target, place))


def _noon(day: date, place: Place, zone: tzinfo) -> datetime:
    """Return the sun's upper culmination on a day, or within 17 minutes of it."""
    start = datetime.combine(day, time(), zone).astimezone(UTC)
    since_midnight = timedelta(hours=start.hour, minutes=start.minute, seconds=start.second)
    mean_noon = _DAY / 2 - _DAY * (place.longitude / (2.0 * math.pi))
    return _culmination(start + (mean_noon - since_midnight) % _DAY, place, 0.0)


def _culmination(near: datetime, place: Place, angle: float) -> datetime:
    """Return when the sun has an hour angle, near a time."""
    # The hour angle grows by a turn a day to 1e-4, so an error of 17 minutes becomes 0.1 s
    # and then vanishes.
    for _ in range(3):
        off = math.remainder(hour_angle(near, place) - angle, 2.0 * math.pi)
        near -= _DAY * (off / (2.0 * math.pi))
    return near


def _crossing(low: datetime, high: datetime, target: float, place: Place) -> datetime:
    """Return when the sun passes an elevation, by bisection between below and above."""
    while abs(high - low) > _SECOND / 10:
        middle = low + (high - low) / 2
        if sun_position(middle, place)[0] < target:
            low = middle
        else:
            high = middle
    return low


def _whole(moment: datetime) -> datetime:
    return (moment + _SECOND / 2).replace(microsecond=0)
