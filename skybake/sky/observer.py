"""Where light is looked at from."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.errors import InputError
from skybake.optics.medium import Medium

LOWEST_EYE = 1e-8
"""Altitude of an observer on the ground: ten micrometres, so that a horizon exists. [km]"""


@dataclass(frozen=True)
class Observer:
    """A place above the ground, inside the atmosphere or outside.

    Attributes
    ----------
    altitude : float
        Above the ground, at least 0. [km]

    Raises
    ------
    InputError
        If the altitude is negative or not finite.
    """

    altitude: float = 0.0

    def __post_init__(self) -> None:
        """Refuse places that do not exist."""
        if not 0.0 <= self.altitude < math.inf:
            raise InputError(f"altitude: must be at least 0 m, got {self.altitude * 1e3:g} m")

    def radius(self, medium: Medium) -> float:
        """Distance from the planet's centre. [km]"""
        return medium.r_bottom + max(self.altitude, LOWEST_EYE)
