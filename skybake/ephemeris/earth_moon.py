"""Sun and Moon as seen from a place on Earth, to a few seconds of an eclipse."""

from __future__ import annotations

import math
from datetime import UTC, datetime

import ephem
import numpy as np
import numpy.typing as npt

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.earth import ephem_days
from skybake.ephemeris.mars import FIRST_YEAR, tt_less_utc
from skybake.ephemeris.place import Place
from skybake.ephemeris.topocentric import east_north_up

Array = npt.NDArray[np.float64]

_EQUATORIAL_RADIUS, _FLATTENING = 6378.137, 1.0 / 298.257223563
"""Of the ellipsoid of WGS 84. [km]"""

_LAST_LEAP_KNOWN = 2035
"""Year up to which terrestrial time is taken to be as far ahead of UTC as it is now."""

_DAY_SECONDS = 86_400.0


def sun_and_moon(time: datetime, place: Place, altitude: float) -> tuple[Array, Array]:
    """Return where the centres of sun and Moon are, without refraction.

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
    sun, moon : ndarray of float64, shape (3,)
        From the observer toward east, north and up, of date, with aberration. [km]

    Notes
    -----
    By libastro, with the observer on the ellipsoid. Its own estimate of how far terrestrial time
    is ahead of UTC, 5 s too much in 2026, is replaced by what is known from 1972 on.
    """
    days = ephem_days(time)
    observer = ephem.Observer()
    observer.lat, observer.lon, observer.date = place.latitude, place.longitude, days
    sidereal = float(observer.sidereal_time())
    year = time.astimezone(UTC).year
    if FIRST_YEAR <= year <= _LAST_LEAP_KNOWN:
        days += (tt_less_utc(time) - ephem.delta_t(days)) / _DAY_SECONDS
    here = observer_on_ellipsoid(place.latitude, altitude)
    return (
        east_north_up(_place(ephem.Sun(days)), sidereal, place.latitude, here),
        east_north_up(_place(ephem.Moon(days)), sidereal, place.latitude, here),
    )


def _place(body: ephem.Body) -> Array:
    """From the centre of Earth to a body, in the axes of its equator and equinox of date. [km]"""
    distance = body.earth_distance * ASTRONOMICAL_UNIT
    flat = math.cos(body.g_dec)
    direction = flat * math.cos(body.g_ra), flat * math.sin(body.g_ra), math.sin(body.g_dec)
    place: Array = distance * np.array(direction)
    return place


def observer_on_ellipsoid(latitude: float, altitude: float) -> tuple[float, float]:
    """Return distances of an observer from the axis and from the plane of the equator. [km]"""
    squared = _FLATTENING * (2.0 - _FLATTENING)
    normal = _EQUATORIAL_RADIUS / math.sqrt(1.0 - squared * math.sin(latitude) ** 2)
    return (
        (normal + altitude) * math.cos(latitude),
        (normal * (1.0 - squared) + altitude) * math.sin(latitude),
    )
