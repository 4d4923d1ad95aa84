"""Where planets and moons are seen from Earth and from Mars.

By libastro, which has VSOP87 (Bretagnon & Francou 1988), in axes of J2000.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import ephem
import numpy as np
import numpy.typing as npt

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.celestial import J2000, CelestialFrame, to_ecliptic_of_date
from skybake.ephemeris.mars import EQUATORIAL_RADIUS, POLAR_RADIUS
from skybake.ephemeris.mars_moons import moons_from_centre
from skybake.ephemeris.place import GROUND_RADII

Array = npt.NDArray[np.float64]

PLANETS = ("mercury", "venus", "earth", "mars", "jupiter", "saturn", "uranus")
"""Those that are ever brighter than V = 6.5."""

_YEAR = 365.25
_J2000_DAYS = 36525.0
"""From the epoch of libastro. [d]"""

_LIGHT_TIME = ASTRONOMICAL_UNIT / 299792.458 / 86400.0
"""Of an astronomical unit. [d]"""


class Body(NamedTuple):
    """A planet, or a moon of one, at a time.

    Attributes
    ----------
    name : str
        In English, lower case.
    vector : ndarray of float64, shape (3,)
        From the observer, in axes of J2000. [km]
    sun : ndarray of float64, shape (3,)
        From it to the sun, in the same axes. [km]
    radius : float
        Of its disc, 0 of what is seen as a point. [km]
    centre : ndarray of float64, shape (3,)
        From the centre of the observer's planet, in the same axes. [km]
    """

    name: str
    vector: Array
    sun: Array
    radius: float
    centre: Array


def bodies_over(frame: CelestialFrame, altitude: float = 0.0) -> list[Body]:
    """Return planets, Earth's moon from Mars, and Phobos and Deimos.

    Parameters
    ----------
    frame : CelestialFrame
        The observer and the time; without a date there are none.
    altitude : float, optional
        Of the observer above the ground. [km]

    Notes
    -----
    Directions from the centres of Earth and of Mars are within 2 arcsec of JPL's DE421 from 1980
    to 2050. From Mars aberration is left out, 16 arcsec; Phobos and Deimos are within 0.1 deg.
    """
    if not frame.has_date:
        return []
    date = _J2000_DAYS + (frame.year - J2000) * _YEAR
    here = observer_from_centre(frame, altitude)
    if frame.planet == "mars":
        return [*_from_mars(date, here), *_moons_of_mars(date, here)]
    earth_to_sun = _astrometric("sun", date)
    bodies = []
    for name in PLANETS:
        if name == "earth":
            continue
        centre = _astrometric(name, date)
        bodies.append(Body(name, centre - here, earth_to_sun - centre, 0.0, centre))
    return bodies


def observer_from_centre(frame: CelestialFrame, altitude: float) -> Array:
    """Return where the observer is from the planet's centre, in axes of J2000. [km]"""
    vertical = frame.latitude
    if frame.planet == "mars":
        # On the ellipsoid, of the vertical's latitude.
        flat = (POLAR_RADIUS / EQUATORIAL_RADIUS) ** 2
        across = EQUATORIAL_RADIUS / math.sqrt(
            math.cos(vertical) ** 2 + flat * math.sin(vertical) ** 2
        )
        axial, equatorial = flat * across * math.sin(vertical), across * math.cos(vertical)
    else:
        # On a sphere: the ellipsoid moves the nearest planet by 0.1 arcsec.
        radius = GROUND_RADII["earth"]
        axial, equatorial = radius * math.sin(vertical), radius * math.cos(vertical)
    axial += altitude * math.sin(vertical)
    equatorial += altitude * math.cos(vertical)
    sine, cosine = math.sin(vertical), math.cos(vertical)
    in_map = np.array(
        [
            0.0,
            axial * sine + equatorial * cosine,
            equatorial * sine - axial * cosine,
        ]
    )
    here: Array = in_map @ frame.rotation
    return here


def _from_mars(date: float, here: Array) -> list[Body]:
    """Return planets and Earth's moon from Mars, each when its light left it."""
    mars = _heliocentric("mars", date)
    bodies = []
    for name in ("mercury", "venus", "earth", "moon", "jupiter", "saturn", "uranus"):
        place = _heliocentric(name, date)
        for _ in range(2):
            away = float(np.linalg.norm(place - mars)) / ASTRONOMICAL_UNIT
            place = _heliocentric(name, date - away * _LIGHT_TIME)
        centre = place - mars
        bodies.append(Body(name, centre - here, -place, 0.0, centre))
    return bodies


def _moons_of_mars(date: float, here: Array) -> list[Body]:
    days = date - _J2000_DAYS + ephem.delta_t(ephem.Date(date)) / 86400.0
    to_sun = -_heliocentric("mars", date)
    return [
        Body(name, centre - here, to_sun - centre, radius, centre)
        for name, centre, radius in moons_from_centre(days)
    ]


def _heliocentric(name: str, date: float) -> Array:
    """Return where a body is from the sun at a date, in axes of J2000. [km]"""
    earth = -_astrometric("sun", date)
    if name == "earth":
        return earth
    if name == "moon":
        return earth + _astrometric(name, date)
    body = getattr(ephem, name.capitalize())(ephem.Date(date))
    cosine = math.cos(body.hlat)
    of_date = np.array(
        [cosine * math.cos(body.hlon), cosine * math.sin(body.hlon), math.sin(body.hlat)]
    )
    years = (date - _J2000_DAYS) / _YEAR
    place: Array = of_date @ to_ecliptic_of_date(J2000 + years)
    return place * float(body.sun_distance) * ASTRONOMICAL_UNIT


def _astrometric(name: str, date: float) -> Array:
    """Return where a body is from the centre of Earth, in axes of J2000. [km]"""
    body = getattr(ephem, name.capitalize())()
    body.compute(date, epoch=ephem.J2000)
    right_ascension, declination = float(body.a_ra), float(body.a_dec)
    cosine = math.cos(declination)
    unit = np.array(
        [
            cosine * math.cos(right_ascension),
            cosine * math.sin(right_ascension),
            math.sin(declination),
        ]
    )
    place: Array = float(body.earth_distance) * ASTRONOMICAL_UNIT * unit
    return place
