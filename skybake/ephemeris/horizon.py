"""How an observer sees the sun on the horizon: dip, refraction and the sun's upper edge."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris import earth
from skybake.ephemeris.place import GROUND_RADII
from skybake.ephemeris.refraction import ON_HORIZON, SCALE_HEIGHT, Refraction
from skybake.errors import ArgumentError

_SUN_RADIUS = 695_700.0  # km

# The almanacs' convention: the sun's radius from 1 au.
_RADIUS_ON_EARTH = math.radians(16.0 / 60.0)


@dataclass(frozen=True)
class Horizon:
    """The horizon of an observer.

    Attributes
    ----------
    planet : {"earth", "mars"}
        Where it is; on Mars the air is too thin to bend light visibly.
    altitude : float
        Of the observer above the ground, at least 0. [km]
    refraction : bool
        Whether the air of Earth bends the light.

    Raises
    ------
    ArgumentError
        If the altitude is not finite or below the ground.
    """

    planet: str
    altitude: float = 0.0
    refraction: bool = True

    def __post_init__(self) -> None:
        """Refuse an observer below the ground."""
        if not 0.0 <= self.altitude < math.inf:
            raise ArgumentError(
                "{altitude}: must be at least 0 km, got {altitude_km:g}", altitude_km=self.altitude
            )

    @property
    def dip(self) -> float:
        """How far the horizon is below the horizontal. [rad]"""
        radius = GROUND_RADII[self.planet]
        return math.acos(radius / (radius + self.altitude))

    def lift(self, elevation: float) -> float:
        """Return by how much refraction raises the sun at a geometric elevation. [rad]

        At sea level it is Sæmundsson's. Higher up it is what `Refraction` finds, to which
        Sæmundsson's difference from it at sea level is added, as far as there is air; both
        count from what is seen on the horizon.
        """
        if not self.refraction or self.planet != "earth":
            return 0.0
        if self.altitude == 0.0:
            return earth.refraction(elevation)
        air = Refraction(self.altitude)
        at_sea = elevation - air.set - ON_HORIZON
        rest = earth.refraction(at_sea) - Refraction(0.0).lift(at_sea)
        # The air raises the ground's edge as well, which maps show at the dip.
        kept = (-self.dip - air.set) / (air.horizon - air.set)
        lift = kept * air.lift(elevation) + rest * math.exp(-self.altitude / SCALE_HEIGHT)
        return max(lift, 0.0)

    def risen(self, sun_distance: float) -> float:
        """Return the elevation at which the sun's upper edge appears on the horizon.

        Parameters
        ----------
        sun_distance : float
            [au]

        Returns
        -------
        float
            Geometric, of the sun's centre: at sea level on Earth -50', or -16' without
            refraction; the dip lower from above the ground, where rays are bent more. [rad]
        """
        if self.planet == "earth":
            return -_RADIUS_ON_EARTH + self.edge
        return -math.asin(_SUN_RADIUS / (sun_distance * ASTRONOMICAL_UNIT)) - self.dip

    @property
    def edge(self) -> float:
        """Geometric elevation of what is seen on the horizon of Earth. [rad]"""
        if not self.refraction:
            return -self.dip
        return -ON_HORIZON if self.altitude == 0.0 else Refraction(self.altitude).set
