"""Where the moons of Earth and Mars are in front of the sun, at a time and a place."""

from __future__ import annotations

import math
from datetime import datetime

import numpy as np
import numpy.typing as npt

from skybake.ephemeris import earth_moon, mars_moons
from skybake.ephemeris.moon import MEAN_RADIUS, Moon
from skybake.ephemeris.place import Place
from skybake.ephemeris.topocentric import turn

Array = npt.NDArray[np.float64]


def moon_before_sun(
    time: datetime, place: Place, altitude: float, sun_azimuth: float, sun_elevation: float
) -> Moon:
    """Return the moon that is nearest to the sun, of those between sun and observer.

    Parameters
    ----------
    time : datetime
        Aware.
    place : Place
        Below the observer.
    altitude : float
        Of the observer. [km]
    sun_azimuth, sun_elevation : float
        Where the sun is said to be, with the refraction that lifts it. The moon is turned with
        it, so that it is beside the sun as it is in truth. [rad]

    Raises
    ------
    InputError
        As of the planet's sun.
    """
    if place.planet == "mars":
        sun, moons = mars_moons.sun_and_moons(time, place, altitude)
    else:
        sun, moon = earth_moon.sun_and_moon(time, place, altitude)
        moons = [(moon, MEAN_RADIUS)]
    where, radius = min(moons, key=lambda each: _angle(sun, each[0]) - each[1] / _length(each[0]))
    turned = turn(sun, _direction(sun_azimuth, sun_elevation), where)
    distance = _length(turned)
    return Moon(
        azimuth=math.atan2(turned[0], turned[1]) % (2.0 * math.pi),
        elevation=math.asin(max(-1.0, min(1.0, turned[2] / distance))),
        diameter=2.0 * math.asin(min(radius / distance, 1.0)),
        distance=distance,
    )


def _direction(azimuth: float, elevation: float) -> Array:
    flat = math.cos(elevation)
    return np.array([flat * math.sin(azimuth), flat * math.cos(azimuth), math.sin(elevation)])


def _angle(one: Array, other: Array) -> float:
    return math.atan2(_length(np.cross(one, other)), float(one @ other))


def _length(vector: Array) -> float:
    return float(np.linalg.norm(vector))
