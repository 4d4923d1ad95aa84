"""The content of a preset, as frozen dataclasses in the units of the code."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.preset.clouds_model import CloudLayer
from skybake.preset.optics_model import Phase, Spectrum


@dataclass(frozen=True, slots=True)
class ExponentialProfile:
    """Density exp(-h / scale_height), 1 at the ground; scale height in km."""

    scale_height: float


@dataclass(frozen=True, slots=True)
class TentProfile:
    """Density that falls linearly from 1 at `center` to 0 at `half_width` from it [km]."""

    center: float
    half_width: float


@dataclass(frozen=True, slots=True)
class TabulatedProfile:
    """Density at altitudes [km]; log-linear where both neighbours are positive, else linear."""

    altitude: tuple[float, ...]
    density: tuple[float, ...]


Profile = ExponentialProfile | TentProfile | TabulatedProfile


@dataclass(frozen=True, slots=True)
class Gas:
    """Molecules that scatter by their refractive index.

    Attributes
    ----------
    pressure, temperature : float
        Where the profile's density is 1. [Pa], [K]
    composition : tuple of (str, float)
        Mole fractions by the names of `skybake.preset.constituents.GASES`.
    """

    name: str
    profile: Profile
    pressure: float
    temperature: float
    composition: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class Absorber:
    """Molecules that only absorb, by their column over the ground.

    Attributes
    ----------
    column : float
        Molecules over the ground. [m⁻²]
    cross_section : Spectrum
        Absorption per molecule. [m²]
    """

    name: str
    profile: Profile
    column: float
    cross_section: Spectrum


@dataclass(frozen=True, slots=True)
class Aerosol:
    """Particles, by their vertical optical depth.

    Attributes
    ----------
    optical_depth, optical_depth_wavelength : float
        Extinction from the ground to the top at this wavelength [nm].
    extinction_spectrum : Spectrum or float
        Extinction against wavelength in any scale, or an Angstrom exponent.
    single_scattering_albedo : Spectrum
        Scattering over extinction, in [0, 1].
    """

    name: str
    profile: Profile
    optical_depth: float
    optical_depth_wavelength: float
    extinction_spectrum: Spectrum | float
    single_scattering_albedo: Spectrum
    phase: Phase


@dataclass(frozen=True, slots=True)
class Coefficients:
    """Anything, by its coefficients where the profile's density is 1, in km⁻¹."""

    name: str
    profile: Profile
    scattering: Spectrum
    absorption: Spectrum
    phase: Phase


Constituent = Gas | Absorber | Aerosol | Coefficients


@dataclass(frozen=True, slots=True)
class Ground:
    """A Lambertian sphere; albedo in [0, 1]."""

    albedo: Spectrum


@dataclass(frozen=True, slots=True)
class Star:
    """The sun of a planet.

    Attributes
    ----------
    radius, distance : float
        Of its photosphere; from the planet. [km]
    irradiance : Spectrum
        On a plane that faces it from 1 au. [W m⁻² nm⁻¹]
    limb_darkening_u, limb_darkening_v : Spectrum
        Coefficients of I(mu)/I(1) = 1 - u (1 - mu) - v (1 - mu²).
    """

    radius: float
    distance: float
    irradiance: Spectrum
    limb_darkening_u: Spectrum
    limb_darkening_v: Spectrum

    @property
    def angular_radius(self) -> float:
        """Half the angle under which the planet sees the disc, in radians."""
        return math.asin(self.radius / self.distance)

    @property
    def dilution(self) -> float:
        """Irradiance at the planet relative to that at 1 au."""
        return (ASTRONOMICAL_UNIT / self.distance) ** 2


@dataclass(frozen=True, slots=True)
class Planet:
    """A world: everything that a sky depends on except the observer and the time.

    Attributes
    ----------
    name : str
        The preset's name, or its file's without the ending.
    title : str
        Human-readable, one line.
    radius, atmosphere_top : float
        Of the ground; altitude above which there is vacuum. [km]
    rendering : {"spectral", "rgb"}
        Whether radiances are integrated over a spectrum, or three wavelengths
        stand for red, green and blue.
    wavelengths : tuple of float or None
        The wavelengths to render [nm]; None leaves the choice to the renderer.
    constituents : tuple of Constituent
        In the preset's order.
    recipe : dict
        The preset as read, with what it extends and what was set, fit for JSON:
        enough to make the planet again, given the user's own tables, whose SHA-256
        is under ``"files"``. What was set is repeated under ``"set"``.
    data_quality : str or None
        Human-readable: where the data are weak; None if they are not.
    clouds : tuple of CloudLayer
        In the preset's order; may overlap.
    """

    name: str
    title: str
    radius: float
    atmosphere_top: float
    rendering: Literal["spectral", "rgb"]
    wavelengths: tuple[float, ...] | None
    star: Star
    ground: Ground
    constituents: tuple[Constituent, ...]
    recipe: dict[str, Any] = field(compare=False)
    data_quality: str | None = None
    clouds: tuple[CloudLayer, ...] = ()
