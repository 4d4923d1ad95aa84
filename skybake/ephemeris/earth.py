"""The sun as seen from Earth."""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta

import ephem

from skybake.ephemeris.place import Place

# PyEPHEM counts days from here. Its own conversion of dates takes those before 1582 as
# Julian ones, where datetime has the Gregorian calendar throughout.
_DUBLIN_EPOCH = datetime(1899, 12, 31, 12, tzinfo=UTC)

J2000_DAYS = 36525.0
"""2000-01-01 12:00 as `ephem_days` counts it. [d]"""

# Sæmundsson's formula has a pole at -5.1 deg, and no light of a sun below this grazes
# an atmosphere that is dense enough to bend it much.
_LIFT_FADES = math.radians(-1.0)
_LIFT_ENDS = math.radians(-5.0)


def sun_position(time: datetime, place: Place) -> tuple[float, float]:
    """Return the position of the sun's centre, without refraction.

    Parameters
    ----------
    time : datetime
        Aware.
    place : Place
        On the ground.

    Returns
    -------
    elevation, azimuth : float
        Topocentric, of date: with parallax, aberration and nutation. The elevation is
        geometric, from the horizontal; the azimuth is a compass bearing, 0 = north,
        clockwise, from 0 to 2 pi. [rad]

    Notes
    -----
    By libastro, which has VSOP87 (Bretagnon and Francou 1988), and within 0.001 deg of
    SPA (Reda and Andreas 2004) from 1000 to 3000. Far from the present the rotation of
    Earth is not known as well.
    """
    sun, _ = _observe(time, place)
    return float(sun.alt), float(sun.az)


def sun_distance(time: datetime) -> float:
    """Return how far the sun is from the centre of Earth, by libastro's VSOP87. [au]"""
    sun = ephem.Sun(ephem_days(time))
    return float(sun.earth_distance)


def hour_angle(time: datetime, place: Place) -> float:
    """Return how far the sun has moved past the upper meridian, -pi to pi. [rad]"""
    sun, observer = _observe(time, place)
    return math.remainder(observer.sidereal_time() - sun.ra, 2.0 * math.pi)


def sidereal_time(time: datetime, place: Place) -> float:
    """Return the apparent right ascension of what culminates, 0 to 2 pi. [rad]"""
    _, observer = _observe(time, place)
    return float(observer.sidereal_time())


def refraction(elevation: float) -> float:
    """Return by how much refraction at sea level raises the sun.

    Parameters
    ----------
    elevation : float
        Geometric. [rad]

    Returns
    -------
    float
        Apparent elevation less the geometric one, never negative. [rad]

    Notes
    -----
    Sæmundsson (1986, Sky and Telescope 72, 70), for 1010 hPa and 10 °C, with Meeus's
    term that makes it vanish in the zenith: 29' at 0, 34' for a sun that is seen on the
    horizon. From -1 deg to -5 deg, where the sun is not visible, a smoothstep of fifth
    degree fades it out, so value, slope and curvature have no step, and the apparent
    elevation never falls while the geometric one rises.
    """
    if elevation <= _LIFT_ENDS:
        return 0.0
    degrees = math.degrees(elevation)
    argument = math.radians(degrees + 10.3 / (degrees + 5.11))
    arcminutes = 1.02 / math.tan(argument) + 0.0019279
    share = min((elevation - _LIFT_ENDS) / (_LIFT_FADES - _LIFT_ENDS), 1.0)
    fade = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return max(fade * math.radians(arcminutes / 60.0), 0.0)


def _observe(time: datetime, place: Place) -> tuple[ephem.Sun, ephem.Observer]:
    observer = ephem.Observer()
    observer.pressure = 0.0
    observer.lat, observer.lon = place.latitude, place.longitude
    observer.date = ephem_days(time)
    return ephem.Sun(observer), observer


def ephem_days(time: datetime) -> float:
    """Return a time as PyEPHEM counts it. [d]"""
    return (time - _DUBLIN_EPOCH) / timedelta(days=1)
