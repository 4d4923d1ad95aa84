"""When and where the stars stand how."""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta

from skybake.ephemeris import earth, mars
from skybake.ephemeris.celestial import J2000, CelestialFrame
from skybake.ephemeris.place import Place

_J2000 = datetime(2000, 1, 1, 12, tzinfo=UTC)
_YEAR = timedelta(days=365.25)


def frame_at(time: datetime, place: Place) -> CelestialFrame:
    """Return how the stars stand at a time.

    Parameters
    ----------
    time : datetime
        Aware.
    place : Place
        On Earth or on Mars.
    """
    year = J2000 + (time - _J2000) / _YEAR
    if place.planet == "mars":
        now = mars.mars_time(time)
        hour_angle = now.hour_angle(place.longitude)
        return frame_in_season(now.solar_longitude, hour_angle, place.latitude, year)
    return CelestialFrame("earth", earth.sidereal_time(time, place), place.latitude, year)


def frame_in_season(
    solar_longitude: float, hour_angle: float, latitude: float, year: float = J2000
) -> CelestialFrame:
    """Return how the stars stand on Mars in a season, at a local true solar time.

    Parameters
    ----------
    solar_longitude : float
        Of the sun, Ls. [rad]
    hour_angle : float
        Of the sun: local true solar time as an angle since noon. [rad]
    latitude : float
        Of the observer, planetocentric. [rad]
    year : float, optional
        Julian year.
    """
    sine = math.cos(mars.OBLIQUITY) * math.sin(solar_longitude)
    right_ascension = math.atan2(sine, math.cos(solar_longitude))
    sidereal_time = (right_ascension + hour_angle) % (2.0 * math.pi)
    return CelestialFrame("mars", sidereal_time, mars.planetographic_latitude(latitude), year)
