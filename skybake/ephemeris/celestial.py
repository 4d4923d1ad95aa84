"""How the stars stand over an observer on Earth or on Mars."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

J2000 = 2000.0

_ARCSECOND = math.radians(1.0 / 3600.0)
_ABERRATION = 20.49552 * _ARCSECOND
_OBLIQUITY = math.radians(23.4392911)

TO_ECLIPTIC = np.array(
    [
        [1.0, 0.0, 0.0],
        [0.0, math.cos(_OBLIQUITY), math.sin(_OBLIQUITY)],
        [0.0, -math.sin(_OBLIQUITY), math.cos(_OBLIQUITY)],
    ]
)
"""Matrix from axes of J2000 to those of its ecliptic."""

# Of J2000: IAU 2015 (Archinal et al. 2018) and Standish (1992), see docs/night.md.
_MARS_POLE = math.radians(317.681), math.radians(52.887)
_MARS_INCLINATION, _MARS_NODE = math.radians(1.850), math.radians(49.558)


@dataclass(frozen=True)
class CelestialFrame:
    """Rotation of the sky over an observer: all that a map needs to know of time and place.

    Attributes
    ----------
    planet : {"earth", "mars"}
        Where the observer is.
    sidereal_time : float
        Apparent right ascension, in the planet's own equator, of what culminates. [rad]
    latitude : float
        Of the observer's vertical. [rad]
    year : float
        Julian year, on which proper motion, precession, nutation and aberration depend; J2000
        if there is no date.
    """

    planet: str
    sidereal_time: float
    latitude: float
    year: float = J2000

    @property
    def has_date(self) -> bool:
        """Whether it is that of a date, on which planets are somewhere."""
        return self.year != J2000

    def directions(self, places: Array, motions: Array | None = None) -> Array:
        """Return where stars are seen, without refraction.

        Parameters
        ----------
        places : ndarray of float64, shape (n, 2)
            Right ascension and declination at J2000. [rad]
        motions : ndarray of float64, shape (n, 2), optional
            Proper motion toward east and north. [rad/yr]

        Returns
        -------
        ndarray of float64, shape (n, 3)
            Unit vectors: +Y up, -Z north, +X east.

        Notes
        -----
        On Earth within 2 arcsec of ERFA from 1900 to 2050; on Mars without precession and
        aberration, which are 16 arcsec at most.
        """
        vectors = _unit_vectors(places[:, 0], places[:, 1])
        if motions is not None:
            east, north = _tangents(places[:, 0], places[:, 1])
            moved = motions * (self.year - J2000)
            vectors = vectors + moved[:, :1] * east + moved[:, 1:] * north
        return self.seen(vectors)

    def seen(self, vectors: Array) -> Array:
        """Return where what is in directions of J2000 is seen, as of `directions`.

        Parameters
        ----------
        vectors : ndarray of float64, shape (n, 3)
            Of any length, in axes of J2000.
        """
        if self.planet == "earth":
            vectors = _normalised(vectors) + _velocity_of_earth(self._centuries)
        turned: Array = _normalised(vectors) @ self.rotation.T
        return turned

    @property
    def rotation(self) -> Array:
        """Matrix from axes of J2000 (x to the equinox, z to the north pole) to those of the map."""
        if self.planet == "earth":
            of_date = _nutation(self._centuries) @ _precession(self._centuries)
        else:
            of_date = _equator_of_mars()
        sine, cosine = math.sin(self.sidereal_time), math.cos(self.sidereal_time)
        meridian, east = np.array([cosine, sine, 0.0]), np.array([-sine, cosine, 0.0])
        pole = np.array([0.0, 0.0, 1.0])
        up = math.cos(self.latitude) * meridian + math.sin(self.latitude) * pole
        south = math.sin(self.latitude) * meridian - math.cos(self.latitude) * pole
        matrix: Array = np.stack([east, up, south]) @ of_date
        return matrix

    @property
    def _centuries(self) -> float:
        return (self.year - J2000) / 100.0


def to_ecliptic_of_date(year: float) -> Array:
    """Matrix from axes of J2000 to those of the ecliptic and the mean equinox of a Julian year."""
    t = (year - J2000) / 100.0
    matrix: Array = _about_x(_mean_obliquity(t)) @ _precession(t)
    return matrix


def _unit_vectors(right_ascension: Array, declination: Array) -> Array:
    cosine = np.cos(declination)
    return np.stack(
        [cosine * np.cos(right_ascension), cosine * np.sin(right_ascension), np.sin(declination)],
        axis=-1,
    )


def _tangents(right_ascension: Array, declination: Array) -> tuple[Array, Array]:
    """Return unit vectors toward east and north at places, shape (n, 3)."""
    zero = np.zeros_like(right_ascension)
    east = np.stack([-np.sin(right_ascension), np.cos(right_ascension), zero], axis=-1)
    return east, np.cross(_unit_vectors(right_ascension, declination), east)


def _normalised(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit


def _about_x(angle: float) -> Array:
    """Matrix to axes that are turned about x."""
    sine, cosine = math.sin(angle), math.cos(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])


def _about_y(angle: float) -> Array:
    sine, cosine = math.sin(angle), math.cos(angle)
    return np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])


def _about_z(angle: float) -> Array:
    sine, cosine = math.sin(angle), math.cos(angle)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _precession(t: float) -> Array:
    """Matrix from J2000 to the mean equator of date, t in Julian centuries.

    IAU 2006 (Capitaine, Wallace & Chapront 2003, Astron. Astrophys. 412, 567, eq. 40).
    """
    zeta = 2.650545 + t * (2306.083227 + t * (0.2988499 + t * 0.01801828))
    z = -2.650545 + t * (2306.077181 + t * (1.0927348 + t * 0.01826837))
    theta = t * (2004.191903 - t * (0.4294934 + t * 0.04182264))
    return _about_z(-z * _ARCSECOND) @ _about_y(theta * _ARCSECOND) @ _about_z(-zeta * _ARCSECOND)


def _mean_obliquity(t: float) -> float:
    """Of the ecliptic, t in Julian centuries. [rad]"""
    return _OBLIQUITY - math.radians(0.0130042) * t


def _nutation(t: float) -> Array:
    """Matrix from the mean equator of date to the true one.

    The four largest terms, good for 0.5 arcsec (Meeus 1998, Astronomical Algorithms, ch. 22).
    """
    node = math.radians(125.04452 - 1934.136261 * t)
    sun = math.radians(280.4665 + 36000.7698 * t)
    moon = math.radians(218.3165 + 481267.8813 * t)
    longitude = (
        -17.20 * math.sin(node)
        - 1.32 * math.sin(2.0 * sun)
        - 0.23 * math.sin(2.0 * moon)
        + 0.21 * math.sin(2.0 * node)
    ) * _ARCSECOND
    tilt = (
        9.20 * math.cos(node)
        + 0.57 * math.cos(2.0 * sun)
        + 0.10 * math.cos(2.0 * moon)
        - 0.09 * math.cos(2.0 * node)
    ) * _ARCSECOND
    mean = _mean_obliquity(t)
    return _about_x(-(mean + tilt)) @ _about_z(-longitude) @ _about_x(mean)


def _velocity_of_earth(t: float) -> Array:
    """Velocity of Earth over that of light, in axes of J2000 (Meeus 1998, ch. 23 and 25)."""
    anomaly = math.radians(357.52911 + 35999.05029 * t)
    centre = math.radians(1.9146) * math.sin(anomaly) + math.radians(0.02) * math.sin(2 * anomaly)
    # Longitudes are of date, and axes of J2000.
    sun = math.radians(280.4665 + (36000.7698 - 1.39697) * t) + centre
    perihelion = math.radians(102.93735)
    eccentricity = 0.016708634
    along = _ABERRATION * (math.sin(sun) - eccentricity * math.sin(perihelion))
    across = -_ABERRATION * (math.cos(sun) - eccentricity * math.cos(perihelion))
    return np.array([along, across * math.cos(_OBLIQUITY), across * math.sin(_OBLIQUITY)])


def _equator_of_mars() -> Array:
    """Matrix from J2000 to the equator of Mars, x to its northern spring equinox."""
    pole = _unit_vectors(*np.array(_MARS_POLE))
    sine = math.sin(_MARS_INCLINATION)
    in_ecliptic = np.array(
        [
            sine * math.sin(_MARS_NODE),
            -sine * math.cos(_MARS_NODE),
            math.cos(_MARS_INCLINATION),
        ]
    )
    orbit = _about_x(-_OBLIQUITY) @ in_ecliptic
    # Where the sun stands at Ls 0, it crosses the equator northward.
    equinox = _normalised(np.cross(pole, orbit))
    return np.stack([equinox, np.cross(pole, equinox), pole])
