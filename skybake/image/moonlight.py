"""Whether a map shows the Moon as a light, and which."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from skybake.ephemeris.lit_moon import LitMoon
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment

MOONS = ("include", "exclude", "only")


@dataclass(frozen=True)
class Moonlight:
    """The Moon in a map.

    Attributes
    ----------
    moon : LitMoon or None
        Where it stands; None leaves it out.
    shown : {"include", "exclude", "only"}
        Whether the map holds its disc and its light, or no other.
    """

    moon: LitMoon | None = None
    shown: str = "include"

    def __post_init__(self) -> None:
        """Refuse what cannot be shown."""
        if self.shown not in MOONS:
            raise InputError(f"moon: must be one of {', '.join(MOONS)}, got {self.shown!r}")

    @property
    def is_alone(self) -> bool:
        """Whether the map holds no other light."""
        return self.shown == "only" and self.moon is not None

    def recipe(self) -> dict[str, Any]:
        """All that decides the pixels, in human-readable units, fit for JSON."""
        if self.moon is None or self.shown == "exclude":
            return {}
        return {"moonlight": self.shown, **self.moon.recipe()}


def moonlight_at(moonlight: Moonlight, moment: Moment) -> Moonlight:
    """Return the moonlight as a moment has it."""
    return replace(moonlight, moon=moment.lit_moon)
