"""The Moon as a light: where it stands, and how the sun lights the side that is seen."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.ephemeris.moon import MEAN_DISTANCE, MEAN_RADIUS
from skybake.errors import InputError
from skybake.units import degrees

Vector = tuple[float, float, float]

NEAREST, FARTHEST = 2.0 * MEAN_RADIUS, 1e7
"""Distances from which it is seen. [km]"""

PHASES = {"full": 0.0, "gibbous": 45.0, "quarter": 90.0, "crescent": 135.0, "new": 180.0}
"""Phase angles by name. [deg]"""


@dataclass(frozen=True)
class LitMoon:
    """The Moon as an observer sees it. Vectors are in the axes of a map: +Y up, -Z north, +X east.

    Attributes
    ----------
    azimuth, elevation : float
        Compass bearing of its centre, and elevation where it is shown. [rad]
    distance : float
        From the observer. [km]
    sun : tuple of 3 float
        Unit vector from the Moon toward the sun.
    pole, meridian : tuple of 3 float
        Unit vectors from its centre to the north pole and to where longitude and latitude are 0.
    sun_distance : float or None
        Of the Moon from the sun; None for that of the planet. [au]
    earth : tuple of 3 float, or None
        From the Moon to the centre of Earth, whose shadow may fall on it. [km]

    Raises
    ------
    InputError
        If an angle or a distance is out of its range.
    """

    azimuth: float
    elevation: float
    distance: float
    sun: Vector
    pole: Vector
    meridian: Vector
    sun_distance: float | None = None
    earth: Vector | None = None

    def __post_init__(self) -> None:
        """Refuse a moon that does not exist."""
        if not abs(self.elevation) <= math.pi / 2.0 + 1e-9:
            raise InputError(
                "moon elevation: must be from -90 to 90 deg, "
                f"got {math.degrees(self.elevation):g} deg"
            )
        if not math.isfinite(self.azimuth):
            raise InputError(f"moon azimuth: must be finite, got {self.azimuth}")
        if not NEAREST <= self.distance <= FARTHEST:
            raise InputError(
                f"moon distance: must be from {NEAREST:g} to {FARTHEST:g} km, "
                f"got {self.distance:g} km"
            )

    @property
    def direction(self) -> Vector:
        """Unit vector toward its centre."""
        return _direction(self.azimuth, self.elevation)

    @property
    def angular_radius(self) -> float:
        """Of its disc. [rad]"""
        return math.asin(MEAN_RADIUS / self.distance)

    @property
    def phase_angle(self) -> float:
        """Between sun and observer as seen from the Moon, 0 when full. [rad]"""
        x, y, z = self.direction
        return _angle((-x, -y, -z), self.sun)

    @property
    def illuminated_fraction(self) -> float:
        """Share of the disc that the sun lights, from 0 to 1."""
        return 0.5 * (1.0 + math.cos(self.phase_angle))

    @property
    def sub_observer(self) -> tuple[float, float]:
        """Longitude and latitude of the middle of the disc, which libration moves. [rad]"""
        x, y, z = self.direction
        return self._place((-x, -y, -z))

    @property
    def sub_solar(self) -> tuple[float, float]:
        """Longitude and latitude where the sun is in the zenith. [rad]"""
        return self._place(self.sun)

    def _place(self, toward: Vector) -> tuple[float, float]:
        east = _cross(self.pole, self.meridian)
        longitude = math.atan2(_dot(toward, east), _dot(toward, self.meridian))
        return longitude, math.asin(max(-1.0, min(1.0, _dot(toward, self.pole))))

    def recipe(self) -> dict[str, object]:
        """All that decides the pixels, in human-readable units, fit for JSON."""
        return {
            "moonlight_azimuth_deg": degrees(self.azimuth),
            "moonlight_elevation_deg": degrees(self.elevation),
            "moonlight_distance_km": self.distance,
            "moonlight_sun": _rounded(self.sun),
            "moonlight_pole": _rounded(self.pole),
            "moonlight_meridian": _rounded(self.meridian),
            "moonlight_sun_distance_au": self.sun_distance,
            "moonlight_earth_km": None if self.earth is None else _rounded(self.earth),
        }


def moon_by_hand(
    azimuth: float,
    elevation: float,
    phase: float | None,
    sun_azimuth: float,
    sun_elevation: float,
) -> LitMoon:
    """Return a Moon at its mean distance, without libration, north up.

    Parameters
    ----------
    azimuth, elevation : float
        Where it stands. [rad]
    phase : float or None
        Phase angle, from 0 when full to pi when new; None for what the sun's place makes of it.
        The lit side looks to the sun in either case. [rad]
    sun_azimuth, sun_elevation : float
        Where the sun stands. [rad]

    Raises
    ------
    InputError
        If an angle is out of its range.
    """
    if phase is not None and not 0.0 <= phase <= math.pi + 1e-9:
        raise InputError(f"moon phase: must be from 0deg to 180deg, got {math.degrees(phase):g}deg")
    centre, sun = _direction(azimuth, elevation), _direction(sun_azimuth, sun_elevation)
    toward = _scaled(centre, -1.0)
    if phase is not None:
        # A sun behind the observer or the Moon leaves the side open: the right one.
        beside = _across(sun, centre) or (math.cos(azimuth), 0.0, math.sin(azimuth))
        sun = _sum(_scaled(toward, math.cos(phase)), _scaled(beside, math.sin(phase)))
    pole = _across((0.0, 1.0, 0.0), centre) or (math.sin(azimuth), 0.0, -math.cos(azimuth))
    return LitMoon(azimuth, elevation, MEAN_DISTANCE, sun, pole, toward)


def _rounded(vector: Vector) -> list[float]:
    return [round(each, 9) for each in vector]


def _direction(azimuth: float, elevation: float) -> Vector:
    flat = math.cos(elevation)
    return flat * math.sin(azimuth), math.sin(elevation), -flat * math.cos(azimuth)


def _dot(one: Vector, other: Vector) -> float:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _cross(one: Vector, other: Vector) -> Vector:
    return (
        one[1] * other[2] - one[2] * other[1],
        one[2] * other[0] - one[0] * other[2],
        one[0] * other[1] - one[1] * other[0],
    )


def _scaled(one: Vector, factor: float) -> Vector:
    return factor * one[0], factor * one[1], factor * one[2]


def _sum(one: Vector, other: Vector) -> Vector:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def _angle(one: Vector, other: Vector) -> float:
    return math.atan2(math.hypot(*_cross(one, other)), _dot(one, other))


def _across(vector: Vector, axis: Vector) -> Vector | None:
    """Return the direction of what of a vector is square to an axis; None if nothing is."""
    part = _sum(vector, _scaled(axis, -_dot(vector, axis)))
    length = math.hypot(*part)
    return None if length < 1e-9 else _scaled(part, 1.0 / length)
