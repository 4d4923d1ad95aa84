"""What of the night a map shows besides the sun's light."""

from __future__ import annotations

import math
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


BRIGHTEST = 100.0
"""Largest factor of the light of the sky between stars."""


BRIGHTEST_CITY = 1.0
"""Largest luminance of the zenith by lamps. [cd m⁻²]"""


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
    is_shown : bool
        False leaves out all lights of the night.
    airglow : float
        Of Earth, 1 at a mean solar flux; from 0 to `BRIGHTEST`.
    zodiacal : float
        Of sunlight that dust between the planets scatters, 1 as it is; from 0 to `BRIGHTEST`.
    city : float
        Luminance of the zenith by lamps of cities, from 0 to `BRIGHTEST_CITY`. [cd m⁻²]
    city_azimuth : float or None
        Compass bearing of the city; None for one all around. [rad]
    """

    frame: CelestialFrame | None = None
    stars: str = "include"
    faintest_star: float = FAINTEST_STAR
    is_refracted: bool = False
    is_shown: bool = True
    airglow: float = 1.0
    zodiacal: float = 1.0
    city: float = 0.0
    city_azimuth: float | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be shown."""
        if self.stars not in STARS:
            raise InputError(f"stars: must be one of {', '.join(STARS)}, got {self.stars!r}")
        if not BRIGHTEST_STAR <= self.faintest_star <= FAINTEST_STAR:
            raise InputError(
                f"stars: magnitude must be from {BRIGHTEST_STAR:g}, of the brightest star, to "
                f"{FAINTEST_STAR:g}, got {self.faintest_star:g}"
            )

        for name in ("airglow", "zodiacal"):
            if not 0.0 <= getattr(self, name) <= BRIGHTEST:
                raise InputError(
                    f"{name}: must be from 0 to {BRIGHTEST:g}, got {getattr(self, name):g}"
                )

        if not 0.0 <= self.city <= BRIGHTEST_CITY:
            raise InputError(
                f"light pollution: must be from 0 to {1e3 * BRIGHTEST_CITY:g}mcd, "
                f"got {1e3 * self.city:g}mcd"
            )
        if self.city_azimuth is not None and not math.isfinite(self.city_azimuth):
            raise InputError(f"light pollution: azimuth must be finite, got {self.city_azimuth}")

    @property
    def is_lit(self) -> bool:
        """Whether it has any lights."""
        return self.is_shown and self.frame is not None

    @property
    def shows_glow(self) -> bool:
        """Whether the sky between stars has a light of its own."""
        return self.is_lit and self.stars != "only"

    @property
    def is_plate(self) -> bool:
        """Whether maps hold stars and nothing else."""
        return self.shows_stars and self.stars == "only"

    @property
    def shows_stars(self) -> bool:
        """Whether there can be any."""
        return self.is_lit and self.stars != "exclude"

    def check_altitude(self, altitude: float, top: float) -> None:
        """Refuse cities whose glow has no zenith, seen from above the atmosphere's top. [km]

        Raises
        ------
        InputError
            That names the altitude.
        """
        if self.city > 0.0 and altitude >= top:
            raise InputError(
                f"light pollution: must be seen from below the top of the air at {top:g} km, "
                f"got an altitude of {altitude:g} km"
            )

    def recipe(self) -> dict[str, Any]:
        """All that decides the pixels, in human-readable units, fit for JSON."""
        if self.frame is None or not self.is_shown:
            return {}
        return {
            "stars": self.stars,
            "faintest_star_mag": self.faintest_star,
            "airglow": self.airglow if self.frame.planet == "earth" else 0.0,
            "zodiacal": self.zodiacal,
            "sidereal_time_deg": degrees(self.frame.sidereal_time),
            "vertical_latitude_deg": degrees(self.frame.latitude),
            "julian_year": self.frame.year,
            "stars_refracted": self.is_refracted,
            **self._city_recipe(),
        }

    def _city_recipe(self) -> dict[str, Any]:
        if self.city == 0.0:
            return {}
        azimuth = self.city_azimuth
        return {
            "light_pollution_cd_m2": self.city,
            "light_pollution_azimuth_deg": None if azimuth is None else degrees(azimuth),
        }


def night_of(night: Night, frame: CelestialFrame, planet: str | None) -> Night:
    """Return the night of a world by how the stars stand.

    Airglow is Earth's, which has none over Mars, and zodiacal light is known up to Mars alone.
    """
    return replace(
        night,
        frame=frame,
        airglow=night.airglow if planet in {"earth", "mars"} else 0.0,
        zodiacal=night.zodiacal if planet in {"earth", "mars"} else 0.0,
    )


def night_at(night: Night, moment: Moment) -> Night:
    """Return the night as a moment has it."""
    return replace(night, frame=moment.celestial, is_refracted=moment.is_refracted)
