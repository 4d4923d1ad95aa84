"""How the air of Earth bends the light of the sun, for observers in and above it.

Refractivity falls exponentially with the refractional radius x = n r, in which Bouguer's law makes
a ray straight: at its lowest point x is its impact parameter. Rays that leave the air again are
bent on both sides of that point, by 68' where they graze the ground.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from skybake.ephemeris.place import GROUND_RADII

ON_HORIZON = math.radians(34.0 / 60.0)
"""Refraction of a sun that is seen on the horizon at sea level, by almanacs' convention. [rad]"""

REFRACTIVITY = 2.82e-4
"""Of air of 1010 hPa and 10 °C at 550 nm (Ciddor, Appl. Opt. 35, 1996)."""

_RADIUS = (1.0 + REFRACTIVITY) * GROUND_RADII["earth"]

SCALE_HEIGHT = 0.5 * math.pi * _RADIUS * (REFRACTIVITY / ON_HORIZON) ** 2
"""Of the refractivity, such that refraction on the horizon is `ON_HORIZON`. [km]"""

_FADES_OVER = math.radians(5.0)
_FIRST_ASYMPTOTIC = 5.0
_HALVINGS = 60


@dataclass(frozen=True)
class Refraction:
    """Bending of light on its way to an observer.

    Attributes
    ----------
    altitude : float
        Of the observer above the ground, at least 0. [km]

    References
    ----------
    S. B. Healy and J.-N. Thépaut, "Assimilation experiments with CHAMP GPS radio occultation
    measurements", Q. J. R. Meteorol. Soc. 132, 2006 (bending by exponential refractivity).
    """

    altitude: float

    @cached_property
    def _radius(self) -> float:
        """Refractional radius of the observer. [km]"""
        radius = GROUND_RADII["earth"] + self.altitude
        refractional = radius
        for _ in range(20):
            refractional = radius * (1.0 + refractivity(refractional))
        return refractional

    @cached_property
    def horizon(self) -> float:
        """Apparent elevation of the ground's edge, at most 0. [rad]"""
        return -math.acos(min(_RADIUS / self._radius, 1.0))

    @cached_property
    def set(self) -> float:
        """Geometric elevation of what is seen on the horizon. [rad]"""
        return self.horizon - self.bending(self.horizon)

    def bending(self, apparent: float) -> float:
        """Return by how much light is bent that arrives from an apparent elevation. [rad]"""
        impact = self._radius * math.cos(apparent)
        beyond = (self._radius - impact) / SCALE_HEIGHT
        side = math.sqrt(math.pi / (SCALE_HEIGHT * (self._radius + impact)))
        outside = refractivity(self._radius) * impact * side * _scaled_erfc(math.sqrt(beyond))
        if apparent >= 0.0:
            return outside
        return refractivity(impact) * math.sqrt(2.0 * math.pi * impact / SCALE_HEIGHT) - outside

    def lift(self, elevation: float) -> float:
        """Return apparent less geometric elevation at a geometric one. [rad]

        Below what is seen on the horizon it fades to 0 within 5 deg.
        """
        if elevation <= self.set:
            share = min((self.set - elevation) / _FADES_OVER, 1.0)
            fade = 1.0 - share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
            return fade * (self.horizon - self.set)
        low, high = self.horizon, 0.5 * math.pi
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if middle - self.bending(middle) < elevation:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high) - elevation


def refractivity(refractional_radius: float) -> float:
    """Refractivity n - 1 at a refractional radius [km]."""
    return REFRACTIVITY * math.exp((_RADIUS - refractional_radius) / SCALE_HEIGHT)


def _scaled_erfc(x: float) -> float:
    """Return exp(x²) erfc(x) for x of at least 0."""
    if x < _FIRST_ASYMPTOTIC:
        return math.exp(x * x) * math.erfc(x)
    y = 0.5 / (x * x)
    return (1.0 - y * (1.0 - 3.0 * y * (1.0 - 5.0 * y))) / (x * math.sqrt(math.pi))
