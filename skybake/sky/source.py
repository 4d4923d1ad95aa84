"""Distant sources of light: the sun, or any other disc in the sky."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from skybake.angles import direction_from_angles
from skybake.errors import InputError
from skybake.optics.medium import Array


class Occluder(Protocol):
    """What covers a part of a source, such as a moon in front of the sun."""

    @property
    def uncovered(self) -> Array:
        """Share of the whole source's light that passes by, shape (wavelength,)."""
        ...

    def visible_share(self, azimuth: Array, zenith: Array) -> Array:
        """Share of the light from points of the source that passes by.

        Parameters
        ----------
        azimuth, zenith : ndarray of float64, shape (n,)
            Directions of the points as the observer sees them. [rad]

        Returns
        -------
        ndarray of float64, shape (n,)
            In [0, 1].
        """
        ...


@dataclass(frozen=True, eq=False, kw_only=True)
class Source:
    """A round source of light, so far away that its rays are parallel.

    Attributes
    ----------
    azimuth : float
        Compass bearing of its centre, 0 = north, clockwise. [rad]
    elevation : float
        Geometric elevation of its centre at the observer, in [-pi/2, pi/2]. [rad]
    irradiance : ndarray of float64, shape (wavelength,)
        On a plane above the atmosphere that faces it. [W m⁻² nm⁻¹]
    angular_radius : float
        Of its disc. [rad]
    limb_darkening : ndarray of float64, shape (2, wavelength)
        Coefficients u and v of I(mu)/I(1) = 1 - u (1 - mu) - v (1 - mu²).
    occluder : Occluder, optional
        What covers a part of the disc.

    Raises
    ------
    InputError
        If an angle is not finite or the elevation out of its range.
    """

    azimuth: float
    elevation: float
    irradiance: Array
    angular_radius: float
    limb_darkening: Array
    occluder: Occluder | None = None

    def __post_init__(self) -> None:
        """Refuse directions that do not exist."""
        check_direction("source", self.azimuth, self.elevation)

    @property
    def direction(self) -> Array:
        """Unit vector toward its centre: +Y up, -Z north, +X east."""
        return direction_from_angles(self.azimuth, self.elevation)

    @property
    def zenith(self) -> float:
        """Zenith angle of its centre. [rad]"""
        return math.pi / 2.0 - self.elevation

    @property
    def mu(self) -> float:
        """Cosine of the zenith angle of its centre."""
        return math.sin(self.elevation)


def check_direction(name: str, azimuth: float, elevation: float) -> None:
    """Refuse a direction that does not exist; `name` is whose it is.

    Raises
    ------
    InputError
        If an angle is not finite or the elevation is beyond the zenith or the nadir.
    """
    if not abs(elevation) <= math.pi / 2.0 + 1e-9:
        raise InputError(
            f"{name} elevation: must be from -90 to 90 deg, got {math.degrees(elevation):g} deg"
        )
    if not math.isfinite(azimuth):
        raise InputError(f"{name} azimuth: must be finite, got {azimuth}")
