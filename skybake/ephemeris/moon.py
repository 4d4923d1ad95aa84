"""A moon near the sun, as an observer sees it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.errors import InputError
from skybake.units import degrees

MEAN_DISTANCE = 384_400.0
"""Of the Moon from Earth. [km]"""

MEAN_RADIUS = 1737.4
"""Of the Moon (IAU 2015, Archinal et al. 2018). [km]"""

MEAN_DIAMETER = 2.0 * math.asin(MEAN_RADIUS / MEAN_DISTANCE)
"""Of the Moon's disc from its mean distance. [rad]"""

LARGEST_DIAMETER = math.radians(20.0)


@dataclass(frozen=True)
class Moon:
    """A round body that may be in front of the sun.

    Attributes
    ----------
    azimuth : float
        Compass bearing of its centre: 0 = north, clockwise. [rad]
    elevation : float
        Geometric elevation of its centre at the observer; what lifts the sun lifts it too. [rad]
    diameter : float
        Angular diameter as the observer sees it. [rad]
    distance : float
        From the observer, infinite for one without parallax: it covers the sun alike from
        everywhere. [km]

    Raises
    ------
    InputError
        If an angle is not finite or out of its range, or a length is not greater than 0.
    """

    azimuth: float
    elevation: float
    diameter: float = MEAN_DIAMETER
    distance: float = MEAN_DISTANCE

    def __post_init__(self) -> None:
        """Refuse moons that do not exist."""
        if not abs(self.elevation) <= math.pi / 2.0 + 1e-9:
            raise InputError(
                "moon elevation: must be from -90 to 90 deg, "
                f"got {math.degrees(self.elevation):g} deg"
            )
        if not math.isfinite(self.azimuth):
            raise InputError(f"moon azimuth: must be finite, got {self.azimuth}")
        if not 0.0 < self.diameter <= LARGEST_DIAMETER + 1e-9:
            raise InputError(
                f"moon diameter: must be greater than 0deg and at most "
                f"{math.degrees(LARGEST_DIAMETER):g}deg, got {math.degrees(self.diameter):g}deg"
            )
        if not self.distance > 0.0:
            raise InputError(f"moon distance: must be greater than 0 km, got {self.distance:g} km")

    def recipe(self) -> dict[str, float | None]:
        """All that decides the pixels, in human-readable units, fit for JSON."""
        return {
            "moon_azimuth_deg": degrees(self.azimuth),
            "moon_elevation_deg": degrees(self.elevation),
            "moon_diameter_deg": degrees(self.diameter),
            "moon_distance_km": self.distance if math.isfinite(self.distance) else None,
        }


def separation(
    azimuth: float, elevation: float, other_azimuth: float, other_elevation: float
) -> float:
    """Angle between two directions, also a small one to full precision. [rad]"""
    rise = math.sin(0.5 * (elevation - other_elevation)) ** 2
    turn = math.sin(0.5 * (azimuth - other_azimuth)) ** 2
    squared = rise + math.cos(elevation) * math.cos(other_elevation) * turn
    return 2.0 * math.asin(min(1.0, math.sqrt(squared)))


def reaches(
    moon: Moon,
    sun_azimuth: float,
    sun_elevation: float,
    sun_radius: float,
    sun_distance: float,
    reach: float,
) -> bool:
    """Whether a moon may cover a part of the sun from some place around the observer.

    Parameters
    ----------
    moon : Moon
        As the observer sees it.
    sun_azimuth, sun_elevation, sun_radius : float
        The sun's centre and its angular radius as the observer sees them. [rad]
    sun_distance : float
        [km]
    reach : float
        Distance of the farthest of these places. [km]
    """
    if moon.distance >= sun_distance:
        return False
    apart = separation(moon.azimuth, moon.elevation, sun_azimuth, sun_elevation)
    radius = moon.distance * math.sin(0.5 * moon.diameter)
    nearest = moon.distance - reach
    if nearest <= radius or not math.isfinite(moon.distance):
        return math.isfinite(moon.distance) or apart < sun_radius + 0.5 * moon.diameter
    shift = math.asin(reach / moon.distance) + reach / sun_distance
    return apart < sun_radius * (1.0 + reach / sun_distance) + math.asin(radius / nearest) + shift
