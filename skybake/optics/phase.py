"""Phase functions and the scattering angles at which they are tabulated."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.errors import PresetError
from skybake.optics.spectrum import check_range, eval_spectrum
from skybake.preset import (
    CornetteShanksPhase,
    HenyeyGreensteinPhase,
    Phase,
    RayleighPhase,
    TabulatedPhase,
)

Array = npt.NDArray[np.float64]

SCATTERING_ANGLES = 1025
"""Nodes of a tabulated phase function: 512 intervals in each hemisphere."""


def scattering_angles() -> Array:
    """Scattering angles at which phase functions are tabulated.

    Returns
    -------
    ndarray of float64, shape (SCATTERING_ANGLES,)
        Ascending from 0 to pi. [rad]

    Notes
    -----
    In the forward hemisphere sin(theta/2) = x**2 / sqrt(2) for uniform x in
    [0, 1]; the backward one mirrors it. Nodes crowd at both ends (0.035 deg
    apart at 1 deg, 0.3 deg at 90 deg), and a kernel finds its node from the
    distance between two unit vectors, 2*sin(theta/2), which unlike an arc
    cosine keeps its precision in the aureole.
    """
    x = np.linspace(0.0, 1.0, SCATTERING_ANGLES // 2 + 1)
    forward = 2.0 * np.arcsin(x**2 / np.sqrt(2.0))
    return np.concatenate([forward, np.pi - forward[-2::-1]])


def build_phase(phase: Phase, wavelengths: Array) -> Array:
    """Tabulate a phase function.

    Parameters
    ----------
    phase : Phase
        What the preset gives.
    wavelengths : ndarray, shape (wavelength,)
        [nm]

    Returns
    -------
    ndarray of float64, shape (SCATTERING_ANGLES, wavelength)
        At `scattering_angles`. [sr⁻¹]

    Raises
    ------
    PresetError
        If a wavelength is outside the preset's spectra, or a table's integral
        over the sphere is not 1 within 1 %.
    """
    if isinstance(phase, TabulatedPhase):
        return _tabulated(phase, wavelengths)
    nu = np.cos(scattering_angles())[:, None]
    if isinstance(phase, RayleighPhase):
        return phase_rayleigh(nu, eval_spectrum(phase.depolarisation, wavelengths))
    if isinstance(phase, HenyeyGreensteinPhase):
        return phase_henyey_greenstein(nu, eval_spectrum(phase.asymmetry, wavelengths))
    if isinstance(phase, CornetteShanksPhase):
        return phase_cornette_shanks(nu, eval_spectrum(phase.asymmetry, wavelengths))
    first = phase_henyey_greenstein(nu, eval_spectrum(phase.first_asymmetry, wavelengths))
    second = phase_henyey_greenstein(nu, eval_spectrum(phase.second_asymmetry, wavelengths))
    fraction = eval_spectrum(phase.first_fraction, wavelengths)
    return fraction * first + (1.0 - fraction) * second


def phase_rayleigh(nu: Array, depolarisation: Array) -> Array:
    """Rayleigh scattering of natural light by anisotropic molecules, in sr⁻¹.

    Chandrasekhar (1950), section 18: gamma = rho / (2 - rho).
    """
    gamma = depolarisation / (2.0 - depolarisation)
    weight = 3.0 / (16.0 * np.pi * (1.0 + 2.0 * gamma))
    return weight * (1.0 + 3.0 * gamma + (1.0 - gamma) * nu**2)


def phase_henyey_greenstein(nu: Array, asymmetry: Array) -> Array:
    """Henyey & Greenstein (1941), equation 2, in sr⁻¹."""
    g = asymmetry
    return (1.0 - g**2) / (4.0 * np.pi * (1.0 + g**2 - 2.0 * g * nu) ** 1.5)


def phase_cornette_shanks(nu: Array, asymmetry: Array) -> Array:
    """Cornette & Shanks (1992), equation 8, in sr⁻¹."""
    ratio = 1.5 * (1.0 + nu**2) / (2.0 + asymmetry**2)
    return ratio * phase_henyey_greenstein(nu, asymmetry)


def integrate_phase(phase: Array) -> Array:
    """Integral over the sphere of phase functions at `scattering_angles`; 1 if normalised.

    Parameters
    ----------
    phase : ndarray, shape (SCATTERING_ANGLES, ...)
        Taken as linear in the cosine between nodes. [sr⁻¹]
    """
    # Differences of sin²(theta/2) keep the digits that differences of cosines lose at 0.
    half = np.sin(scattering_angles() / 2.0) ** 2
    integral: Array = 4.0 * np.pi * np.trapezoid(phase, half, axis=0)
    return integral


def _tabulated(phase: TabulatedPhase, wavelengths: Array) -> Array:
    angles = scattering_angles()
    bands = np.stack(
        [np.exp(np.interp(angles, phase.angle, np.log(values))) for values in phase.values], axis=1
    )
    if not phase.wavelength:
        table = np.repeat(bands, len(wavelengths), axis=1)
    else:
        check_range(phase.where, phase.wavelength, wavelengths)
        position = np.interp(wavelengths, phase.wavelength, np.arange(len(phase.wavelength)))
        left = np.minimum(position.astype(int), len(phase.wavelength) - 2)
        fraction = position - left
        table = (1.0 - fraction) * bands[:, left] + fraction * bands[:, left + 1]
    integral = integrate_phase(table)
    for wavelength, value in zip(wavelengths, integral, strict=True):
        if not abs(value - 1.0) <= 0.01:
            raise PresetError(
                f"{phase.where}: must integrate to 1 over the sphere within 1 %, "
                f"got {value:.4f} at {wavelength:g} nm"
            )
    normalised: Array = table / integral
    return normalised


def eval_phase(phase: Array, nu: Array) -> Array:
    """Interpolate tabulated phase functions.

    Parameters
    ----------
    phase : ndarray of float64, shape (constituent, SCATTERING_ANGLES, wavelength)
        At `scattering_angles`. [sr⁻¹]
    nu : ndarray of float64, shape (n,)
        Cosines of scattering angles, in [-1, 1].

    Returns
    -------
    ndarray of float64, shape (n, constituent, wavelength)
        Linear in the nodes' coordinate. [sr⁻¹]
    """
    middle = SCATTERING_ANGLES // 2
    forward = middle * np.sqrt(np.sqrt(np.maximum(1.0 - nu, 0.0)))
    backward = 2 * middle - middle * np.sqrt(np.sqrt(np.maximum(1.0 + nu, 0.0)))
    position = np.where(nu > 0.0, forward, backward)
    left = np.minimum(position.astype(int), SCATTERING_ANGLES - 2)
    fraction = (position - left)[:, None, None]
    table = phase.transpose(1, 0, 2)
    interpolated: Array = (1.0 - fraction) * table[left] + fraction * table[left + 1]
    return interpolated
