"""The sun through a day, for a slider that shows when it rises and sets."""

from __future__ import annotations

import math
from datetime import UTC, tzinfo
from typing import Any

from skybake.ephemeris.events import EVENTS, mean_solar_zone
from skybake.ephemeris.local_clock import find_zone
from skybake.ephemeris.moment import Moment, TimeSpan, sun_at
from skybake.errors import ArgumentError
from skybake.studio.reader import DayRequest

STEP = 600.0
"""Between two points of the curve. [s]"""

_HALF_DAYS = {"earth": "12h", "mars": "12h20min"}


def day_of(request: DayRequest) -> dict[str, Any]:
    """Return the events of a day and the elevation of the sun through it, fit for JSON.

    Parameters
    ----------
    request : DayRequest
        Where and when.

    Returns
    -------
    dict
        ``date``, ``zone``, ``events`` in the order of time and ``curve``. Each point has ``time``,
        which is what the option takes, ``label`` by the local clock, and ``elevation_deg`` and
        ``azimuth_deg`` of the sun.

    Raises
    ------
    ArgumentError
        If there is no such day.
    """
    season = request.solar_longitude
    half = _HALF_DAYS[request.place.planet]
    # Minutes after noon are right for any clock, whose own hours the option takes by other rules.
    ends = ("00:00", "23:50") if season is not None else (f"noon-{half}", f"noon+{half}")
    span = TimeSpan(
        *ends,
        request.place,
        every=STEP,
        zone=request.zone,
        day=request.day,
        solar_longitude=season,
        refraction=request.refraction,
        altitude=request.altitude,
    )
    moments = span.moments()
    zone = None if season is not None else _zone(request)
    times = _times(len(moments), from_noon=season is None)
    curve = [_point(text, one, zone) for text, one in zip(times, moments, strict=True)]
    events = [_point(name, one, zone) | {"name": name} for name, one in _events(request)]
    events.sort(key=lambda point: _order(point, curve))
    clock = "mean solar time" if request.zone is None else request.zone
    return {
        "date": None if request.day is None else request.day.isoformat(),
        "zone": "true solar time" if season is not None else clock,
        "events": events,
        "curve": curve,
    }


def _events(request: DayRequest) -> list[tuple[str, Moment]]:
    found = []
    for name in EVENTS:
        try:
            moment = sun_at(
                name,
                request.place,
                zone=request.zone,
                day=request.day,
                solar_longitude=request.solar_longitude,
                refraction=request.refraction,
                altitude=request.altitude,
            )
        except ArgumentError:
            # In polar night or day, as the curve shows.
            continue
        found.append((name, moment))
    return found


def _times(count: int, *, from_noon: bool) -> list[str]:
    """Return what the option ``time`` takes for the points of the curve."""
    step = round(STEP / 60.0)
    if not from_noon:
        return [f"{step * i // 60:02}:{step * i % 60:02}" for i in range(count)]
    return [_offset(step * (i - count // 2)) for i in range(count)]


def _offset(minutes: int) -> str:
    if not minutes:
        return "noon"
    hours, rest = divmod(abs(minutes), 60)
    length = (f"{hours}h" if hours else "") + (f"{rest}min" if rest else "")
    return f"noon{'+' if minutes > 0 else '-'}{length}"


def _point(text: str, moment: Moment, zone: tzinfo | None) -> dict[str, Any]:
    return {
        "time": text,
        "label": _label(moment, zone),
        "elevation_deg": round(math.degrees(moment.sun_elevation), 4),
        "azimuth_deg": round(math.degrees(moment.sun_azimuth) % 360.0, 4),
        "utc": None if moment.time is None else moment.time.timestamp(),
    }


def _label(moment: Moment, zone: tzinfo | None) -> str:
    if moment.time is None:
        return moment.label.rpartition(" ")[2][:5]
    return f"{moment.time.astimezone(zone or UTC):%H:%M}"


def _zone(request: DayRequest) -> tzinfo:
    return mean_solar_zone(request.place) if request.zone is None else find_zone(request.zone)


def _order(point: dict[str, Any], curve: list[dict[str, Any]]) -> Any:
    return point["label"] if curve[0]["utc"] is None else point["utc"]
