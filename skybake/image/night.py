"""What of the night a map shows besides the sun's light."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from skybake.ephemeris.celestial import CelestialFrame
from skybake.errors import InputError
from skybake.units import degrees

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment

STARS = ("include", "exclude", "only")

FAINTEST_STAR = 6.5
"""Of the catalogue, in V. [mag]"""

BRIGHTEST_STAR = -1.44
"""Sirius, in V. [mag]"""


@dataclass(frozen=True)
class Night:
    """Which stars are shown, and how they stand.

    Attributes
    ----------
    frame : CelestialFrame or None
        How they stand; None shows none.
    stars : {"include", "exclude", "only"}
        Whether the map holds stars, or nothing else.
    faintest_star : float
        Magnitude V up to which stars are shown, from `BRIGHTEST_STAR` to `FAINTEST_STAR`. [mag]
    is_refracted : bool
        Whether the air of Earth raises them.
    """

    frame: CelestialFrame | None = None
    stars: str = "include"
    faintest_star: float = FAINTEST_STAR
    is_refracted: bool = False

    def __post_init__(self) -> None:
        """Refuse what cannot be shown."""
        if self.stars not in STARS:
            raise InputError(f"stars: must be one of {', '.join(STARS)}, got {self.stars!r}")
        if not BRIGHTEST_STAR <= self.faintest_star <= FAINTEST_STAR:
            raise InputError(
                f"stars: magnitude must be from {BRIGHTEST_STAR:g}, of the brightest star, to "
                f"{FAINTEST_STAR:g}, got {self.faintest_star:g}"
            )

    @property
    def shows_stars(self) -> bool:
        """Whether there can be any."""
        return self.frame is not None and self.stars != "exclude"

    def recipe(self) -> dict[str, Any]:
        """All that decides the pixels, in human-readable units, fit for JSON."""
        if self.frame is None or self.stars == "exclude":
            return {}
        return {
            "stars": self.stars,
            "faintest_star_mag": self.faintest_star,
            "sidereal_time_deg": degrees(self.frame.sidereal_time),
            "vertical_latitude_deg": degrees(self.frame.latitude),
            "julian_year": self.frame.year,
            "stars_refracted": self.is_refracted,
        }


def night_at(night: Night, moment: Moment) -> Night:
    """Return the night as a moment has it."""
    return replace(night, frame=moment.celestial, is_refracted=moment.is_refracted)
