"""Scattering by molecules, from their refractive index and anisotropy."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.constants import BOLTZMANN, STANDARD_NUMBER_DENSITY
from skybake.preset import Gas

Array = npt.NDArray[np.float64]


def gas_scattering(gas: Gas, wavelengths: Array) -> tuple[Array, Array]:
    """Scattering coefficient and depolarisation of a mixture.

    Parameters
    ----------
    gas : Gas
        Composition, pressure and temperature.
    wavelengths : ndarray, shape (wavelength,)
        [nm]

    Returns
    -------
    scattering : ndarray of float64, shape (wavelength,)
        [km⁻¹]
    depolarisation : ndarray of float64, shape (wavelength,)
        Ratio for natural light.
    """
    total = sum(fraction for _, fraction in gas.composition)
    cross_section = np.zeros(len(wavelengths))
    isotropic = np.zeros(len(wavelengths))
    for name, fraction in gas.composition:
        refractivity, king = _GASES[name](wavelengths)
        one = fraction / total * _isotropic_cross_section(refractivity, wavelengths)
        isotropic += one
        cross_section += one * king
    # Mixing keeps the sums of isotropic and anisotropic scattering, hence of sigma and sigma / F.
    king = cross_section / isotropic
    number_density = gas.pressure / (BOLTZMANN * gas.temperature)
    return cross_section * number_density * 1e3, depolarisation_from_king(king)


def depolarisation_from_king(king: Array) -> Array:
    """Depolarisation ratio of natural light: F = (6 + 3 rho) / (6 - 7 rho)."""
    return 6.0 * (king - 1.0) / (3.0 + 7.0 * king)


def _isotropic_cross_section(refractivity: Array, wavelengths: Array) -> Array:
    """Cross-section [m²] without King factor, from n - 1 at the standard number density.

    Bodhaine et al. (1999), equation 2.
    """
    square = (1.0 + refractivity) ** 2
    wavelength = wavelengths * 1e-9
    ratio = (square - 1.0) / (square + 2.0) / STANDARD_NUMBER_DENSITY
    cross_section: Array = 24.0 * np.pi**3 * ratio**2 / wavelength**4
    return cross_section


def _dry_air(wavelengths: Array) -> tuple[Array, Array]:
    """Refractivity and King factor of dry air with 400 ppm CO2: Bodhaine et al. (1999)."""
    carbon_dioxide = 400e-6
    inverse_square = (1e-3 * wavelengths) ** -2.0  # um⁻²
    at_300_ppm = 1e-8 * (
        8060.51 + 2480990.0 / (132.274 - inverse_square) + 17455.7 / (39.32957 - inverse_square)
    )
    refractivity = at_300_ppm * (1.0 + 0.54 * (carbon_dioxide - 300e-6))
    nitrogen = 1.034 + 3.17e-4 * inverse_square
    oxygen = 1.096 + 1.385e-3 * inverse_square + 1.448e-4 * inverse_square**2
    percent = 100.0 * carbon_dioxide
    king = (78.084 * nitrogen + 20.946 * oxygen + 0.934 + percent * 1.15) / (
        78.084 + 20.946 + 0.934 + percent
    )
    return refractivity, king


def _carbon_dioxide(wavelengths: Array) -> tuple[Array, Array]:
    """Bideau-Mehu et al. (1973) as scaled by Sneep & Ubachs (2005); He et al. (2021)."""
    nu2 = (1e7 / wavelengths) ** 2  # cm⁻²
    refractivity = 1.1427e3 * (
        5799.25 / (128908.9**2 - nu2)
        + 120.05 / (89223.8**2 - nu2)
        + 5.3334 / (75037.5**2 - nu2)
        + 4.3244 / (67837.7**2 - nu2)
        + 0.1218145e-4 / (2418.136**2 - nu2)
    )
    return refractivity, 1.1364 + 25.3e-12 * nu2


def _nitrogen(wavelengths: Array) -> tuple[Array, Array]:
    """Sneep & Ubachs (2005), two branches that meet at 468 nm; He et al. (2021)."""
    nu2 = (1e7 / wavelengths) ** 2
    short = 5677.465 + 318.81874e12 / (14.4e9 - nu2)
    long = 6498.2 + 307.43305e12 / (14.4e9 - nu2)
    return 1e-8 * np.where(nu2 > 21360.0**2, short, long), 1.034 + 3.17e-12 * nu2


def _argon(wavelengths: Array) -> tuple[Array, Array]:
    """Sneep & Ubachs (2005); a noble gas has no anisotropy."""
    nu2 = (1e7 / wavelengths) ** 2
    return 1e-8 * (6432.135 + 286.06021e12 / (14.4e9 - nu2)), np.ones(len(wavelengths))


def _methane(wavelengths: Array) -> tuple[Array, Array]:
    """He et al. (2021); a tetrahedron has no anisotropy."""
    nu2 = (1e7 / wavelengths) ** 2  # cm⁻²
    return 1e-8 * (3603.09 + 4.40362e14 / (1.1741e10 - nu2)), np.ones(len(wavelengths))


def _hydrogen(wavelengths: Array) -> tuple[Array, Array]:
    """Peck & Huang (1977), at 0 deg C; polarisabilities along and across the axis: Hohm (1993)."""
    inverse_square = (1e-3 * wavelengths) ** -2.0  # um⁻²
    at_freezing = 1e-6 * (14895.6 / (180.7 - inverse_square) + 4903.7 / (92.0 - inverse_square))
    energy_square = (1e7 / wavelengths / 219474.6305) ** 2  # of the photon, in hartree
    along = 1.62632 / (0.23940245 - energy_square)
    across = 1.40105 / (0.29486069 - energy_square)
    anisotropy = (along - across) / ((along + 2.0 * across) / 3.0)
    return at_freezing * _FROM_FREEZING, 1.0 + 2.0 / 9.0 * anisotropy**2


def _helium(wavelengths: Array) -> tuple[Array, Array]:
    """Mansfield & Peck (1969), at 0 deg C; a noble gas has no anisotropy."""
    inverse_square = (1e-3 * wavelengths) ** -2.0  # um⁻²
    at_freezing = 0.01470091 / (423.98 - inverse_square)
    return at_freezing * _FROM_FREEZING, np.ones(len(wavelengths))


_FROM_FREEZING = 273.15 / 288.15
"""Refractivity at 0 deg C to that at the standard number density, of 15 deg C."""

_GASES = {
    "dry_air": _dry_air,
    "co2": _carbon_dioxide,
    "n2": _nitrogen,
    "ar": _argon,
    "ch4": _methane,
    "h2": _hydrogen,
    "he": _helium,
}
