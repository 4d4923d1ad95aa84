"""Where a camera is aimed by the name of what it is to show."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.ephemeris.lit_moon import LitMoon
from skybake.errors import InputError
from skybake.preset import Planet
from skybake.projection import Perspective
from skybake.projection.perspective import WIDEST
from skybake.sky.observer import LOWEST_EYE
from skybake.sky.table import horizon_angles

AIMS = ("sun", "moon", "horizon", "limb", "planet")

USUAL_FOV = math.radians(50.0)

LIMB_HEIGHTS = 20.0
"""Width of a picture of the limb in heights of the atmosphere, as it is seen."""

MARGIN = 1.08
"""Height of a picture of the planet over that of its disc."""


@dataclass(frozen=True)
class Aim:
    """What is in the middle of a picture.

    Attributes
    ----------
    name : {"sun", "moon", "horizon", "limb", "planet"} or None
        What it is; None for a direction.
    azimuth : float or None
        Compass bearing of the direction, or of the place at the horizon or the limb; None for that
        of the sun. The planet is seen with north up. [rad]
    elevation : float
        Of a direction. [rad]
    """

    name: str | None = "horizon"
    azimuth: float | None = None
    elevation: float = 0.0


@dataclass(frozen=True)
class Lookout:
    """From where a picture is taken, and where the sun is.

    Attributes
    ----------
    planet : Planet
        The world.
    altitude : float
        Of the camera above the ground. [km]
    sun_azimuth, sun_elevation : float
        [rad]
    moon : LitMoon or None
        Where the Moon is, if it is shown.
    """

    planet: Planet
    altitude: float
    sun_azimuth: float
    sun_elevation: float
    moon: LitMoon | None = None

    @property
    def is_in_space(self) -> bool:
        """Whether the atmosphere is seen from outside."""
        return self.altitude > self.planet.atmosphere_top

    @property
    def edges(self) -> tuple[float, float]:
        """Zenith angles at which the atmosphere and the ground begin. [rad]"""
        bottom = self.planet.radius
        top = bottom + self.planet.atmosphere_top
        return horizon_angles(bottom + max(self.altitude, LOWEST_EYE), bottom, top)


def aimed(
    aim: Aim,
    lookout: Lookout,
    size: tuple[int, int],
    *,
    fov: float | None = None,
    roll: float = 0.0,
) -> Perspective:
    """Return the picture that is aimed at something.

    Parameters
    ----------
    aim : Aim
        At what.
    lookout : Lookout
        From where.
    size : tuple of int
        Width and height of the picture. [pixel]
    fov : float, optional
        Angle that its width covers; by default 50 deg, but for the planet what frames all of it,
        and for the limb at most `LIMB_HEIGHTS` heights of the atmosphere. [rad]
    roll : float, optional
        See `roll_frame`. [rad]

    Raises
    ------
    InputError
        If the limb or the planet is to be seen from within the atmosphere, no picture is wide
        enough for the planet, or there is no Moon.
    """
    azimuth, elevation = _direction(aim, lookout)
    width, height = size
    if fov is None:
        fov = _usual_fov(aim, lookout, width / max(height, 1))
    return Perspective(width, height, fov, azimuth, elevation, roll)


def _direction(aim: Aim, lookout: Lookout) -> tuple[float, float]:
    azimuth = lookout.sun_azimuth if aim.azimuth is None else aim.azimuth
    if aim.name is None:
        return azimuth, aim.elevation
    if aim.name == "sun":
        return lookout.sun_azimuth, lookout.sun_elevation
    if aim.name == "moon":
        if lookout.moon is None:
            raise InputError("look: moon must be in the sky, got none")
        return lookout.moon.azimuth, lookout.moon.elevation
    if aim.name != "horizon" and not lookout.is_in_space:
        raise InputError(
            f"look: {aim.name} needs a camera above the atmosphere, "
            f"{lookout.planet.atmosphere_top:g} km, got {lookout.altitude:g} km"
        )
    if aim.name == "planet":
        return 0.0, -math.pi / 2.0
    return azimuth, math.pi / 2.0 - lookout.edges[1]


def _usual_fov(aim: Aim, lookout: Lookout, aspect: float) -> float:
    first, horizon = lookout.edges
    if aim.name == "limb":
        return min(USUAL_FOV, LIMB_HEIGHTS * (horizon - first))
    if aim.name != "planet":
        return USUAL_FOV
    radius = math.pi - first
    half_width = MARGIN * math.tan(radius) * max(aspect, 1.0)
    fov = 2.0 * math.atan(half_width)
    if fov > WIDEST:
        raise InputError(
            f"look: planet must fit into a picture {math.degrees(WIDEST):g} deg wide, got "
            f"{math.degrees(fov):.1f} deg; a camera farther away sees all of it, or give a field "
            "of view"
        )
    return fov
