"""Phobos and Deimos as seen from Mars.

Their orbits lie in their equators and their mean longitudes are those of their prime meridians,
which face Mars, as of the IAU's working group (Archinal et al. 2011, Celest. Mech. Dyn. Astr. 109,
101); distances and eccentricities are mean elements of JPL (Jacobson 2010, Astron. J. 139, 668).
What the mean elements leave out is about 0.1 deg of the longitude of Phobos, which it goes
in 8 s.
"""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.mars import (
    EQUATORIAL_RADIUS,
    POLAR_RADIUS,
    mars_time,
    planetographic_latitude,
    tt_less_utc,
)
from skybake.ephemeris.place import Place
from skybake.ephemeris.topocentric import east_north_up

Array = npt.NDArray[np.float64]

PHOBOS_RADIUS, DEIMOS_RADIUS = 10.2, 5.5
"""Of discs as large as the silhouettes, which are ellipses of 11.4 by 9.1 and of 6.0 by 5.1 km
(Willner et al. 2014; Thomas 1993), as seen from Mars. [km]"""

_J2000 = datetime(2000, 1, 1, 12, tzinfo=UTC)
_POLE = math.radians(317.68143), math.radians(52.88650)
"""Right ascension and declination of the pole of Mars. [rad]"""

_INCLINATION, _NODE = math.radians(1.850), math.radians(49.558)
"""Of the orbit of Mars to the ecliptic of J2000. [rad]"""

_ECLIPTIC = math.radians(23.4392911)
"""Obliquity of the ecliptic of J2000. [rad]"""


class _Orbit(NamedTuple):
    """A moon's orbit at a time."""

    pole: tuple[float, float]
    longitude: float
    anomaly: float
    axis: float
    eccentricity: float


def sun_and_moons(
    time: datetime, place: Place, altitude: float
) -> tuple[Array, list[tuple[Array, float]]]:
    """Return where the sun's centre is, and that of each moon with its radius.

    Parameters
    ----------
    time : datetime
        Aware.
    place : Place
        Below the observer, on the ellipsoid.
    altitude : float
        Of the observer above it. [km]

    Returns
    -------
    sun : ndarray of float64, shape (3,)
        From the observer toward east, north and up. [km]
    moons : list of (ndarray of float64, float)
        The same of Phobos and Deimos, and their radii. [km]

    Raises
    ------
    InputError
        As of `mars_time`.
    """
    now = mars_time(time)
    axes = _equator(_POLE)
    sun = axes @ _sun(now.solar_longitude) * now.sun_distance * ASTRONOMICAL_UNIT
    sidereal = math.atan2(sun[1], sun[0]) + now.hour_angle(place.longitude)
    vertical = planetographic_latitude(place.latitude)
    here = _observer(place.latitude, vertical, altitude)
    days = (time - _J2000) / timedelta(days=1) + tt_less_utc(time) / 86_400.0
    return east_north_up(sun, sidereal, vertical, here), [
        (east_north_up(axes @ moon, sidereal, vertical, here), radius)
        for _, moon, radius in moons_from_centre(days)
    ]


def moons_from_centre(days: float) -> list[tuple[str, Array, float]]:
    """Return the moons' names, where they are from the centre of Mars, and their radii.

    Parameters
    ----------
    days : float
        Terrestrial time since J2000. [d]

    Returns
    -------
    list of (str, ndarray of float64, float)
        In axes of the Earth's equator of J2000 [km], and [km].
    """
    return [
        ("phobos", _on_orbit(_phobos(days)), PHOBOS_RADIUS),
        ("deimos", _on_orbit(_deimos(days)), DEIMOS_RADIUS),
    ]


def _phobos(days: float) -> _Orbit:
    century = days / 36_525.0
    node = math.radians(169.51 - 0.4357640 * days)
    anomaly = math.radians((192.93 + 1128.4096700 * days + 8.864 * century**2) % 360.0)
    meridian = 35.06 + 1128.8445850 * days + 8.864 * century**2 - 1.42 * math.sin(node)
    pole = (
        math.radians(317.68 - 0.108 * century + 1.79 * math.sin(node)),
        math.radians(52.90 - 0.061 * century - 1.08 * math.cos(node)),
    )
    return _Orbit(pole, math.radians((meridian + 180.0) % 360.0), anomaly, 9376.0, 0.0151)


def _deimos(days: float) -> _Orbit:
    century = days / 36_525.0
    node = math.radians(53.47 - 0.0181510 * days)
    meridian = 79.41 + 285.1618970 * days - 0.520 * century**2
    meridian += -2.58 * math.sin(node) + 0.19 * math.cos(node)
    pole = (
        math.radians(316.65 - 0.108 * century + 2.98 * math.sin(node)),
        math.radians(53.52 - 0.061 * century - 1.78 * math.cos(node)),
    )
    return _Orbit(pole, math.radians((meridian + 180.0) % 360.0), 0.0, 23_458.0, 0.0)


def _on_orbit(orbit: _Orbit) -> Array:
    """From the centre of Mars to a moon, in the axes of the Earth's equator of J2000. [km]"""
    e, anomaly = orbit.eccentricity, orbit.anomaly
    centre = 2.0 * e * math.sin(anomaly) + 1.25 * e**2 * math.sin(2.0 * anomaly)
    distance = orbit.axis * (1.0 - e**2) / (1.0 + e * math.cos(anomaly + centre))
    longitude = orbit.longitude + centre
    first, second, _ = _equator(orbit.pole)
    place: Array = distance * (math.cos(longitude) * first + math.sin(longitude) * second)
    return place


def _equator(pole: tuple[float, float]) -> Array:
    """Axes of an equator as rows: its ascending node on that of Earth, 90 deg on, its pole."""
    right, up = pole
    axis = np.array([math.cos(up) * math.cos(right), math.cos(up) * math.sin(right), math.sin(up)])
    node = np.array([-math.sin(right), math.cos(right), 0.0])
    return np.stack([node, np.cross(axis, node), axis])


def _sun(solar_longitude: float) -> Array:
    """Direction from Mars to the sun, in the axes of the Earth's equator of J2000."""
    flat = math.sin(_INCLINATION)
    x, y, z = flat * math.sin(_NODE), -flat * math.cos(_NODE), math.cos(_INCLINATION)
    sine, cosine = math.sin(_ECLIPTIC), math.cos(_ECLIPTIC)
    normal = np.array([x, y * cosine - z * sine, y * sine + z * cosine])
    equinox = np.cross(_equator(_POLE)[2], normal)
    equinox /= np.linalg.norm(equinox)
    direction: Array = math.cos(solar_longitude) * equinox
    direction += math.sin(solar_longitude) * np.cross(normal, equinox)
    return direction


def _observer(latitude: float, vertical: float, altitude: float) -> tuple[float, float]:
    """Distances from the axis and the plane of the equator, of a planetocentric latitude. [km]"""
    across = math.cos(latitude) / EQUATORIAL_RADIUS, math.sin(latitude) / POLAR_RADIUS
    radius = 1.0 / math.hypot(*across)
    return (
        radius * math.cos(latitude) + altitude * math.cos(vertical),
        radius * math.sin(latitude) + altitude * math.sin(vertical),
    )
