"""The atmosphere as kernels read it: plain arrays, sampled at N wavelengths."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

ALTITUDE_NODES = 1024
"""Nodes of `Medium.density`; linear interpolation of exp(-h/1.2 km) is then good to 3e-5."""


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
    """

    r_bottom: float
    r_top: float
    density: Array
    scattering: Array
    extinction: Array
    phase: Array
    ground_albedo: Array


def altitude_nodes(r_bottom: float, r_top: float) -> Array:
    """Altitudes of the density nodes, quadratic so that they crowd at the ground. [km]"""
    return np.linspace(0.0, 1.0, ALTITUDE_NODES) ** 2 * (r_top - r_bottom)
