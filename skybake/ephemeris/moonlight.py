"""How the Moon lights a place on Earth at a time."""

from __future__ import annotations

import math
from collections.abc import Callable
from datetime import datetime

import numpy as np
import numpy.typing as npt

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.earth import J2000_DAYS, ephem_days, sidereal_time
from skybake.ephemeris.earth_moon import observer_on_ellipsoid, sun_and_moon
from skybake.ephemeris.lit_moon import LitMoon, Vector
from skybake.ephemeris.place import Place
from skybake.ephemeris.topocentric import east_north_up, turn

Array = npt.NDArray[np.float64]

_TILT = math.radians(1.5424)
"""Of the Moon's equator to the ecliptic (IAU 2015)."""

_CENTURY = 36525.0


def lit_moon_at(
    time: datetime,
    place: Place,
    altitude: float,
    lift: Callable[[float], float] | None = None,
) -> LitMoon:
    """Return the Moon at a time.

    Parameters
    ----------
    time : datetime
        Aware.
    place : Place
        On Earth, below the observer.
    altitude : float
        Of the observer. [km]
    lift : callable, optional
        Returns by how much refraction raises what is at a geometric elevation. [rad]

    Returns
    -------
    LitMoon
        Of date, with parallax and light-time. Refraction turns it as a whole, as it does the sun.

    Notes
    -----
    By libastro, and axes by Cassini's laws (Meeus 1998, ch. 53), without physical libration: the
    middle of the disc is right to 0.05 deg.
    """
    sun, moon = sun_and_moon(time, place, altitude)
    sidereal, days = sidereal_time(time, place), ephem_days(time) - J2000_DAYS
    pole, meridian = (
        east_north_up(axis, sidereal, place.latitude, (0.0, 0.0)) for axis in _axes(days)
    )
    centre = east_north_up(
        np.zeros(3), sidereal, place.latitude, observer_on_ellipsoid(place.latitude, altitude)
    )
    distance = float(np.linalg.norm(moon))
    from_moon = sun - moon
    sun_distance = float(np.linalg.norm(from_moon))
    vectors = [moon / distance, from_moon / sun_distance, pole, meridian, centre - moon]
    if lift is not None:
        elevation = math.asin(vectors[0][2])
        raised = _raised(vectors[0], elevation + lift(elevation))
        vectors = [turn(vectors[0], raised, each) for each in vectors]
    where, toward_sun, to_pole, to_meridian, earth = (_in_map(each) for each in vectors)
    x, y, z = where
    return LitMoon(
        azimuth=math.atan2(x, -z) % (2.0 * math.pi),
        elevation=math.asin(max(-1.0, min(1.0, y))),
        distance=distance,
        sun=toward_sun,
        pole=to_pole,
        meridian=to_meridian,
        sun_distance=sun_distance / ASTRONOMICAL_UNIT,
        earth=earth,
    )


def _axes(days: float) -> tuple[Array, Array]:
    """North pole and prime meridian of the Moon in the axes of Earth's equator of date."""
    t = days / _CENTURY
    node = math.radians(125.0446 - 1934.1363 * t)
    longitude = math.radians(218.3165 + 481267.8813 * t)
    pole = np.array(
        [
            -math.sin(_TILT) * math.sin(node),
            math.sin(_TILT) * math.cos(node),
            math.cos(_TILT),
        ]
    )
    descending = np.array([-math.cos(node), -math.sin(node), 0.0])
    along = longitude - node
    meridian = math.cos(along) * descending + math.sin(along) * np.cross(pole, descending)
    obliquity = math.radians(23.4392911 - 0.0130042 * t)
    sine, cosine = math.sin(obliquity), math.cos(obliquity)
    to_equator = np.array([[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])
    return to_equator @ pole, to_equator @ meridian


def _raised(direction: Array, elevation: float) -> Array:
    """Return a direction (east, north, up) at another elevation."""
    flat = math.hypot(direction[0], direction[1])
    scale = math.cos(elevation) / max(flat, 1e-12)
    return np.array([scale * direction[0], scale * direction[1], math.sin(elevation)])


def _in_map(vector: Array) -> Vector:
    """From east, north and up to the axes of a map."""
    east, north, up = vector.tolist()
    return east, up, -north
