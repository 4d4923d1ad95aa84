"""How a picture shows a sky: exposure, white, display transform and frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from skybake.errors import InputError
from skybake.formats.preview import DEFAULT_VIEW, check_view
from skybake.image.vision import check_vision
from skybake.preset import Planet
from skybake.projection import Perspective

EV_WAYS = ("auto", "adapt")
SHOWN = ("light", "dop", "aop")
WHITE_BALANCES = ("auto", "none")
COLDEST, HOTTEST = 1000.0, 25_000.0
"""Colour temperatures that a white balance may have. [K]"""

SHOT_SIZE = (1024, 576)
"""Width and height of a shot. [pixel]"""

WhiteBalance = float | Literal["auto", "none"]

# Within these, a world is Earth: other haze, another ground or another season.
_EARTH_RADII = (6300.0, 6440.0)
_SOLAR_RADII = (690_000.0, 702_000.0)


@dataclass(frozen=True)
class PictureSettings:
    """How a picture shows a sky; nothing of it concerns the map.

    Attributes
    ----------
    ev : float, "auto", "adapt" or None
        Exposure value at ISO 100. Of a sequence, auto suits the frame with the highest sun and
        adapt each frame; None is auto, but adapt for contact sheets. Of a single
        map all three suit the map.
    view : {"aces1", "aces2"}
        Display transform.
    white_balance : float, "auto", "none" or None
        What becomes white: the light that falls on the ground, D65, or light of a colour
        temperature [K]. None is none on Earth and auto on other worlds.
    shot : Perspective or None
        Show this view in place of the map's own layout.
    vision : {"camera", "eye"}
        Whether the dark looks as to a camera, or as to the eye, which sees less colour in it.
    show : {"light", "dop", "aop"}
        Show the light, or its degree or angle of linear polarisation, see
        `skybake.image.polarisation_picture`.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    ev: float | Literal["auto", "adapt"] | None = None
    view: str = DEFAULT_VIEW
    white_balance: WhiteBalance | None = None
    shot: Perspective | None = None
    vision: str = "camera"
    show: str = SHOWN[0]

    def __post_init__(self) -> None:
        """Refuse what cannot be shown."""
        check_view(self.view)
        check_vision(self.vision)
        if self.show not in SHOWN:
            raise InputError(f"show: must be one of {', '.join(SHOWN)}, got {self.show!r}")
        if isinstance(self.ev, str) and self.ev not in EV_WAYS:
            raise InputError(f"ev: must be a number or {' or '.join(EV_WAYS)}, got {self.ev!r}")
        if self.white_balance is not None and not _is_white_balance(self.white_balance):
            raise InputError(
                f"white balance: must be {', '.join(WHITE_BALANCES)} or from {COLDEST:g} to "
                f"{HOTTEST:g} K, got {self.white_balance!r}"
            )

    @property
    def fixed_ev(self) -> float | None:
        """The exposure value, if it is given as a number."""
        return None if isinstance(self.ev, str) else self.ev


def shot(azimuth: float, elevation: float, fov: float) -> Perspective:
    """Return the view of a shot.

    Parameters
    ----------
    azimuth, elevation : float
        Compass bearing and height of its middle. [rad]
    fov : float
        Angle that its width covers. [rad]

    Raises
    ------
    InputError
        If an angle is out of its range.
    """
    return Perspective(*SHOT_SIZE, fov=fov, azimuth=azimuth, elevation=elevation)


def is_earth(planet: Planet) -> bool:
    """Whether a world is Earth, with whatever air, under the sun."""
    return has_size_of_earth(planet.radius, planet.star.radius)


def has_size_of_earth(radius: float, star_radius: float) -> bool:
    """Whether a world and its star are as large as Earth and the sun. [km]"""
    (least, most), (star_least, star_most) = _EARTH_RADII, _SOLAR_RADII
    return least <= radius <= most and star_least <= star_radius <= star_most


def white_balance_of(settings: PictureSettings, planet: Planet) -> WhiteBalance:
    """Return what a picture of a world takes as white."""
    if settings.white_balance is not None:
        return settings.white_balance
    return "none" if is_earth(planet) else "auto"


def _is_white_balance(value: WhiteBalance) -> bool:
    if isinstance(value, str):
        return value in WHITE_BALANCES
    return COLDEST <= value <= HOTTEST
