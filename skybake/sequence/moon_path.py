"""Where a Moon stands in the frames of a sequence that no time puts there."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.ephemeris.lit_moon import LitMoon, moon_by_hand
from skybake.sequence.ramp import Ramp, at_share

SOUTH = math.pi
"""Bearing of a Moon that has none. [rad]"""


@dataclass(frozen=True)
class MoonPath:
    """A Moon whose place and phase are constant or change evenly, see `moon_by_hand`.

    Attributes
    ----------
    elevation, azimuth : float or Ramp
        Where it stands. [rad]
    phase : float, Ramp or None
        Phase angle; None for what the sun of each frame makes of it. [rad]
    """

    elevation: float | Ramp
    azimuth: float | Ramp = SOUTH
    phase: float | Ramp | None = None

    def at(self, share: float, sun_azimuth: float, sun_elevation: float) -> LitMoon:
        """Return the Moon after a share of the way.

        Raises
        ------
        InputError
            If an angle is out of its range.
        """
        azimuth, elevation = at_share(self.azimuth, share), at_share(self.elevation, share)
        phase = None if self.phase is None else at_share(self.phase, share)
        return moon_by_hand(azimuth, elevation, phase, sun_azimuth, sun_elevation)
