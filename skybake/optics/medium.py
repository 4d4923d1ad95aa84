"""The atmosphere as kernels read it: plain arrays, sampled at N wavelengths."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.errors import PresetError
from skybake.optics.matrix import ELEMENTS, build_matrix, rayleigh_matrix, unpolarising_matrix
from skybake.optics.phase import SCATTERING_ANGLES, build_phase, phase_rayleigh, scattering_angles
from skybake.optics.profile import eval_profile
from skybake.optics.rayleigh import gas_scattering
from skybake.optics.spectrum import BANDWIDTH, eval_band_mean, eval_spectrum
from skybake.preset import Absorber, Aerosol, Constituent, Gas, Planet

Array = npt.NDArray[np.float64]

ALTITUDE_NODES = 1024
"""Nodes of `Medium.density`; linear interpolation of exp(-h/1.2 km) is then good to 3e-5."""

LANES = 4
"""Kernels take wavelengths, and the curves of a basis, in multiples of this number, so that loops
over them consist of whole vectors."""


class Medium(NamedTuple):
    """An atmosphere over a Lambertian sphere, sampled at fixed wavelengths.

    Attributes
    ----------
    r_bottom, r_top : float
        Radius of the ground and of the top of the atmosphere. [km]
    density : ndarray of float64, shape (ALTITUDE_NODES, constituent)
        Density relative to the one that the coefficients are given for, at the
        altitudes of `altitude_nodes`.
    scattering, extinction : ndarray of float64, shape (constituent, wavelength)
        Coefficients at relative density 1; absorption is their difference. [km⁻¹]
    phase : ndarray of float64, shape (constituent, SCATTERING_ANGLES, wavelength)
        Phase functions at `scattering_angles`; each integrates to 1 over the
        sphere. [sr⁻¹]
    ground_albedo : ndarray of float64, shape (wavelength,)
        Fraction of the irradiance that the ground returns, in [0, 1].
    matrix : ndarray of float64, shape (constituent, ELEMENTS, SCATTERING_ANGLES, wavelength)
        The other elements of the constituents' scattering matrices, see `skybake.optics.matrix`; of
        no constituent where light is not polarised. [sr⁻¹]
    """

    r_bottom: float
    r_top: float
    density: Array
    scattering: Array
    extinction: Array
    phase: Array
    ground_albedo: Array
    matrix: Array = np.zeros((0, ELEMENTS, SCATTERING_ANGLES, 0))


def altitude_nodes(r_bottom: float, r_top: float) -> Array:
    """Altitudes [km] of the density nodes, quadratic so that they crowd at the ground."""
    return np.linspace(0.0, 1.0, ALTITUDE_NODES) ** 2 * (r_top - r_bottom)


def build_medium(planet: Planet, wavelengths: Array, bandwidth: float = BANDWIDTH) -> Medium:
    """Sample a planet's atmosphere.

    Parameters
    ----------
    planet : Planet
        What the preset gives.
    wavelengths : ndarray, shape (wavelength,)
        In any order. [nm]
    bandwidth : float, optional
        Full width of the band over which the cross-sections of absorbing gases
        are averaged, for they have structure finer than the sampling. All else is
        taken at the wavelengths themselves. [nm]

    Returns
    -------
    Medium
        Constituents in the preset's order; of a planet without air a single one that does
        nothing to light.

    Raises
    ------
    PresetError
        If a wavelength is outside the preset's spectra, or a phase function is
        not normalised.
    """
    r_top = planet.radius + planet.atmosphere_top
    if not planet.constituents:
        return _vacuum(planet.radius, r_top, eval_spectrum(planet.ground.albedo, wavelengths))
    altitude = altitude_nodes(planet.radius, r_top)
    density = np.stack([eval_profile(c.profile, altitude) for c in planet.constituents], axis=1)
    # Kernels take the density as linear between nodes, so the trapezoid is its exact column.
    columns = _columns(density, altitude)
    for constituent, column in zip(planet.constituents, columns, strict=True):
        if not column > 0.0:
            raise PresetError(
                f"{planet.name}: constituents.{constituent.name}.profile: must be thicker than "
                f"{float(np.diff(altitude).max()):.2g} km, the widest step between altitudes"
            )
    scattering, absorption, phase, matrix = zip(
        *(
            _optics(constituent, column, wavelengths, bandwidth)
            for constituent, column in zip(planet.constituents, columns.tolist(), strict=True)
        ),
        strict=True,
    )
    return Medium(
        r_bottom=planet.radius,
        r_top=r_top,
        density=density,
        scattering=np.stack(scattering),
        extinction=np.stack(scattering) + np.stack(absorption),
        phase=np.stack(phase),
        ground_albedo=eval_spectrum(planet.ground.albedo, wavelengths),
        matrix=np.stack(matrix),
    )


def _vacuum(r_bottom: float, r_top: float, ground_albedo: Array) -> Medium:
    """Return a medium of one constituent that neither scatters nor absorbs."""
    nothing = np.zeros((1, ground_albedo.size))
    return Medium(
        r_bottom=r_bottom,
        r_top=r_top,
        density=np.ones((altitude_nodes(r_bottom, r_top).size, 1)),
        scattering=nothing,
        extinction=nothing,
        phase=_isotropic(ground_albedo.size)[None],
        ground_albedo=ground_albedo,
    )


def _isotropic(wavelengths: int) -> Array:
    """Phase function of what scatters nothing. [sr⁻¹]"""
    return np.full((SCATTERING_ANGLES, wavelengths), 1.0 / (4.0 * np.pi))


def vertical_columns(medium: Medium) -> Array:
    """Column of each constituent's relative density from the ground to the top. [km]"""
    return _columns(medium.density, altitude_nodes(medium.r_bottom, medium.r_top))


def vertical_optical_depth(medium: Medium) -> Array:
    """Optical depth of each constituent from the ground to the top, (constituent, wavelength)."""
    optical_depth: Array = vertical_columns(medium)[:, None] * medium.extinction
    return optical_depth


def _columns(density: Array, altitude: Array) -> Array:
    return np.asarray(np.trapezoid(density, altitude, axis=0))


def pad_wavelengths(medium: Medium) -> Medium:
    """Repeat the last wavelength until their number is a multiple of `LANES`."""
    last = medium.ground_albedo.size - 1
    index = np.minimum(np.arange(-(-(last + 1) // LANES) * LANES), last)
    without = np.zeros((*medium.matrix.shape[:-1], index.size))
    matrix = medium.matrix[..., index] if len(medium.matrix) else without
    return medium._replace(
        scattering=np.ascontiguousarray(medium.scattering[:, index]),
        extinction=np.ascontiguousarray(medium.extinction[:, index]),
        phase=np.ascontiguousarray(medium.phase[:, :, index]),
        matrix=np.ascontiguousarray(matrix),
        ground_albedo=medium.ground_albedo[index],
    )


def _optics(
    constituent: Constituent, column: float, wavelengths: Array, bandwidth: float
) -> tuple[Array, Array, Array, Array]:
    """Scattering and absorption [km⁻¹], phase function and matrix [sr⁻¹]; `column` in km."""
    if isinstance(constituent, Gas):
        scattering, depolarisation = gas_scattering(constituent, wavelengths)
        phase = phase_rayleigh(np.cos(scattering_angles())[:, None], depolarisation)
        return scattering, np.zeros(len(wavelengths)), phase, rayleigh_matrix(depolarisation)
    if isinstance(constituent, Absorber):
        cross_section = eval_band_mean(constituent.cross_section, wavelengths, bandwidth)
        absorption = cross_section * constituent.column / column
        phase = _isotropic(len(wavelengths))
        return np.zeros(len(wavelengths)), absorption, phase, unpolarising_matrix(phase)
    phase = build_phase(constituent.phase, wavelengths)
    matrix = build_matrix(constituent.phase, phase, wavelengths)
    if isinstance(constituent, Aerosol):
        extinction = aerosol_optical_depth(constituent, wavelengths) / column
        albedo = eval_spectrum(constituent.single_scattering_albedo, wavelengths)
        return albedo * extinction, (1.0 - albedo) * extinction, phase, matrix
    return (
        eval_spectrum(constituent.scattering, wavelengths),
        eval_spectrum(constituent.absorption, wavelengths),
        phase,
        matrix,
    )


def aerosol_optical_depth(aerosol: Aerosol, wavelengths: Array) -> Array:
    """Vertical optical depth from the ground to the top, shape (wavelength,)."""
    reference = np.array([aerosol.optical_depth_wavelength])
    if isinstance(aerosol.extinction_spectrum, float):
        relative = (wavelengths / reference) ** -aerosol.extinction_spectrum
    else:
        relative = eval_spectrum(aerosol.extinction_spectrum, wavelengths)
        relative = relative / eval_spectrum(aerosol.extinction_spectrum, reference)
    optical_depth: Array = aerosol.optical_depth * relative
    return optical_depth
