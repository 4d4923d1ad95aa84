"""Where an observer is on a planet."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.errors import ArgumentError

PLANETS = ("earth", "mars")
"""Planets for which the sun's position is known."""

MEAN_DISTANCES = {"earth": 1.0, "mars": 1.5237}
"""Semi-major axes of their orbits, as the presets have them. [au]"""

GROUND_RADII = {"earth": 6371.0, "mars": 3389.5}
"""Mean radii, as the presets have them. [km]"""


@dataclass(frozen=True)
class Place:
    """A place on a planet.

    Attributes
    ----------
    latitude : float
        Positive in the north, from -pi/2 to pi/2; geodetic on Earth, planetocentric on
        Mars, as maps have it. [rad]
    longitude : float
        Positive in the east. [rad]
    planet : {"earth", "mars"}
        Which planet.

    Raises
    ------
    ArgumentError
        If a value is not finite or out of its range.
    """

    latitude: float
    longitude: float
    planet: str = "earth"

    def __post_init__(self) -> None:
        """Refuse coordinates that do not exist."""
        if not abs(self.latitude) <= math.pi / 2.0 + 1e-9:
            raise ArgumentError(
                "{latitude}: must be from -90deg to 90deg, got {angle:g}deg",
                angle=math.degrees(self.latitude),
            )
        if not math.isfinite(self.longitude):
            raise ArgumentError("{longitude}: must be finite, got {angle}", angle=self.longitude)
        if self.planet not in PLANETS:
            raise ArgumentError(
                "{planet}: must be one of {known}, got {name!r}",
                known=", ".join(PLANETS),
                name=self.planet,
            )

    def __str__(self) -> str:
        """Human-readable degrees."""
        return (
            f"{abs(math.degrees(self.latitude)):.2f}{'S' if self.latitude < 0.0 else 'N'} "
            f"{abs(math.degrees(self.longitude)):.2f}{'W' if self.longitude < 0.0 else 'E'}"
        )


def _site(latitude: float, longitude: float) -> Place:
    return Place(math.radians(latitude), math.radians(longitude), "mars")


SITES = {
    "ares-vallis": _site(19.13, -33.22),
    "chryse": _site(22.27, -47.95),
    "elysium": _site(4.50, 135.62),
    "gale": _site(-4.59, 137.44),
    "green-valley": _site(68.22, -125.75),
    "gusev": _site(-14.57, 175.47),
    "jezero": _site(18.44, 77.45),
    "meridiani": _site(-1.95, -5.53),
    "olympus-mons": _site(18.65, -133.80),
    "utopia": _site(47.64, 134.29),
}
"""Planetocentric latitude and east longitude (IAU 2000), to 0.05 deg, of where these
landed, as their missions report: Pathfinder, Viking 1 (Michael et al. 1976), InSight
(Golombek et al. 2020), Curiosity, Phoenix, Spirit, Perseverance, Opportunity and Viking 2;
and of the mountain (USGS Gazetteer of Planetary Nomenclature)."""


def find_place(
    *,
    latitude: float | None = None,
    longitude: float | None = None,
    site: str | None = None,
    solar_longitude: float | None = None,
) -> Place:
    """Return the place that is given by its coordinates or, on Mars, by its name.

    Parameters
    ----------
    latitude, longitude : float, optional
        As of `Place`. [rad]
    site : str, optional
        One of `SITES` instead.
    solar_longitude : float, optional
        The season, if it is given as that of Mars; coordinates are then of Mars. [rad]

    Raises
    ------
    ArgumentError
        If too few or too many coordinates are given.
    """
    if (latitude is None) != (longitude is None):
        given, missing = (
            ("latitude", "longitude") if longitude is None else ("longitude", "latitude")
        )
        raise ArgumentError(f"{{{given}}}: needs {{{missing}}} as well")
    if site is not None:
        if latitude is not None:
            raise ArgumentError("{site}: cannot be combined with {latitude} and {longitude}")
        if site not in SITES:
            raise ArgumentError(
                "{site}: must be one of {known}, got {name!r}", known=", ".join(SITES), name=site
            )
        return SITES[site]
    if latitude is None or longitude is None:
        raise ArgumentError("{place}: needs {latitude} and {longitude}, or on Mars {site}")
    return Place(latitude, longitude, "earth" if solar_longitude is None else "mars")


def check_planet(place: Place, planet: str | None) -> None:
    """Refuse a sun that is seen from one planet for the atmosphere of another.

    Parameters
    ----------
    place : Place
        Where the sun is seen from.
    planet : str or None
        Planet of the atmosphere; None if that is not known.

    Raises
    ------
    ArgumentError
        If they are different ones, or the planet is not one of `PLANETS`.
    """
    if planet is None or planet == place.planet:
        return
    if planet not in PLANETS:
        problem = "the sun's path is known for Earth and Mars only, give {sun_elevation} instead"
    elif place.planet == "mars":
        problem = "is on Mars"
    else:
        problem = "is on Earth, a place on Mars needs {site} or {solar_longitude}"
    raise ArgumentError(f"{{place}}: {problem} (the preset is of {{planet}})", planet=planet)
