"""Scattering matrices: how scattering polarises light, and turns light that is polarised.

A matrix is given relative to the plane of scattering by P11, the phase function, and by P12, P22
and P33; light that is polarised circularly is left out. P12 below 0 polarises across that plane.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.optics.phase import eval_phase, scattering_angles
from skybake.optics.spectrum import check_range, eval_spectrum
from skybake.optics.wigner import wigner
from skybake.preset import (
    Absorber,
    Aerosol,
    Gas,
    Phase,
    Planet,
    PolarisationTable,
    RayleighPhase,
    TabulatedPhase,
)

Array = npt.NDArray[np.float64]

ELEMENTS = 3
"""P12, P22 and P33."""


def unpolarised_constituents(planet: Planet) -> list[str]:
    """Names of the constituents that scatter without a matrix, and count as unpolarised."""
    names = []
    for constituent in planet.constituents:
        if isinstance(constituent, (Gas, Absorber)) or _is_known(constituent.phase):
            continue
        if isinstance(constituent, Aerosol) or any(constituent.scattering.values):
            names.append(constituent.name)
    return names


def _is_known(phase: Phase) -> bool:
    if isinstance(phase, TabulatedPhase):
        return phase.polarisation is not None
    return isinstance(phase, RayleighPhase)


def build_matrix(phase: Phase, values: Array, wavelengths: Array) -> Array:
    """Tabulate the matrix that belongs to a phase function.

    Parameters
    ----------
    phase : Phase
        What the preset gives.
    values : ndarray, shape (SCATTERING_ANGLES, wavelength)
        The phase function itself. [sr⁻¹]
    wavelengths : ndarray, shape (wavelength,)
        [nm]

    Returns
    -------
    ndarray of float64, shape (ELEMENTS, SCATTERING_ANGLES, wavelength)
        [sr⁻¹]
    """
    if isinstance(phase, RayleighPhase):
        return rayleigh_matrix(eval_spectrum(phase.depolarisation, wavelengths))
    if isinstance(phase, TabulatedPhase) and phase.polarisation is not None:
        p12, p33 = _ratios(phase.polarisation, wavelengths)
        return np.stack([values * p12, values, values * p33])
    return unpolarising_matrix(values)


def _ratios(table: PolarisationTable, wavelengths: Array) -> Array:
    """P12 and P33 over P11, shape (2, SCATTERING_ANGLES, wavelength)."""
    check_range(table.where, table.wavelength, wavelengths)
    position = np.interp(wavelengths, table.wavelength, np.arange(len(table.wavelength)))
    left = np.minimum(position.astype(int), len(table.wavelength) - 2)
    share = position - left
    angles = scattering_angles()
    ratios = []
    for element in (table.p12, table.p33):
        bands = np.stack([np.interp(angles, table.angle, each) for each in element], axis=1)
        ratios.append((1.0 - share) * bands[:, left] + share * bands[:, left + 1])
    return np.stack(ratios)


def rayleigh_matrix(depolarisation: Array) -> Array:
    """Elements of Rayleigh scattering by anisotropic molecules.

    Parameters
    ----------
    depolarisation : ndarray, shape (wavelength,)
        Ratio of natural light.

    Returns
    -------
    ndarray of float64, shape (ELEMENTS, SCATTERING_ANGLES, wavelength)
        [sr⁻¹]

    References
    ----------
    J. E. Hansen and L. D. Travis, Space Sci. Rev. 16, 1974, equation 2.15.
    """
    nu = np.cos(scattering_angles())[:, None]
    isotropic = (1.0 - depolarisation) / (1.0 + 0.5 * depolarisation)
    scale = 3.0 / (16.0 * np.pi) * isotropic
    return np.stack([scale * (nu**2 - 1.0), scale * (nu**2 + 1.0), scale * 2.0 * nu])


def unpolarising_matrix(phase: Array) -> Array:
    """Elements of a constituent of which the phase function alone is known.

    It polarises nothing, and leaves light polarised that it scatters, as spheres do: P33 / P22
    is that of dipoles.

    Parameters
    ----------
    phase : ndarray, shape (SCATTERING_ANGLES, wavelength)
        [sr⁻¹]

    Returns
    -------
    ndarray of float64, shape (ELEMENTS, SCATTERING_ANGLES, wavelength)
        [sr⁻¹]
    """
    nu = np.cos(scattering_angles())[:, None]
    return np.stack([np.zeros_like(phase), phase, phase * 2.0 * nu / (1.0 + nu**2)])


def scattering_plane(mu: Array, mu_s: Array, nu: Array) -> Array:
    """Turn of light that was polarised along the plane of view and sun, to the vertical plane.

    Parameters
    ----------
    mu, mu_s, nu : ndarray, shape (ray,)
        Cosines of the zenith angles of view and sun, and of the angle between them. The sun
        is to the left of the view.

    Returns
    -------
    ndarray of float64, shape (ray, 2)
        Q and U of light whose E-vector is in the plane of view and sun: 1 and 0 where that is
        vertical, or undefined.
    """
    sines = (1.0 - mu**2) * (1.0 - nu**2)
    known = sines > 1e-24
    upward = (mu_s - mu * nu) / np.sqrt(np.where(known, sines, 1.0))
    upward = np.where(known, np.clip(upward, -1.0, 1.0), 1.0)
    return np.stack([2.0 * upward**2 - 1.0, 2.0 * upward * np.sqrt(1.0 - upward**2)], axis=-1)


def matrix_moments(matrix: Array, phase: Array, order: int) -> Array:
    """Coefficients of matrices in generalised spherical functions.

    Parameters
    ----------
    matrix : ndarray, shape (constituent, ELEMENTS, SCATTERING_ANGLES, wavelength)
        [sr⁻¹]
    phase : ndarray, shape (constituent, SCATTERING_ANGLES, wavelength)
        P11. [sr⁻¹]
    order : int
        Highest l.

    Returns
    -------
    ndarray of float64, shape (constituent, 3, order + 1, wavelength)
        beta_l, alpha2_l and alpha3_l relative to the mean of P11, such that the moments of
        scattered light are chi_l I + beta_l E, beta_l I + alpha2_l E and alpha3_l B.
    """
    theta = scattering_angles()
    step = np.diff(theta)
    offset = 0.5 / np.sqrt(3.0)
    nodes = np.concatenate([theta[:-1] + (0.5 - offset) * step, theta[:-1] + (0.5 + offset) * step])
    mu = np.cos(nodes)
    weight = np.pi * np.concatenate([step, step]) * np.sin(nodes)
    functions = [wigner(0, 2, order, mu), wigner(2, 2, order, mu), wigner(2, -2, order, mu)]
    across, same, opposite = (each * weight for each in functions)
    moments = np.empty((len(matrix), ELEMENTS, order + 1, matrix.shape[-1]))
    for c, elements in enumerate(matrix):
        p12, p22, p33 = eval_phase(elements, mu).transpose(1, 0, 2)
        size = weight @ eval_phase(phase[c : c + 1], mu)[:, 0]
        sums, differences = same @ (p22 + p33), opposite @ (p22 - p33)
        moments[c] = across @ p12, 0.5 * (sums + differences), 0.5 * (sums - differences)
        moments[c] /= size
    return moments
