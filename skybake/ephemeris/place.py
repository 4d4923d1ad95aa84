"""Where an observer stands on a planet."""

from __future__ import annotations

import math
from typing import NamedTuple


class Place(NamedTuple):
    """A place on a planet.

    Attributes
    ----------
    latitude : float
        Positive in the north; geodetic on Earth, planetocentric on Mars, as maps have
        it. [rad]
    longitude : float
        Positive in the east. [rad]
    """

    latitude: float
    longitude: float

    def __str__(self) -> str:
        """Degrees for people."""
        return (
            f"{abs(math.degrees(self.latitude)):.2f}{'S' if self.latitude < 0.0 else 'N'} "
            f"{abs(math.degrees(self.longitude)):.2f}{'W' if self.longitude < 0.0 else 'E'}"
        )
