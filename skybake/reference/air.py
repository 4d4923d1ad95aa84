"""A medium at one wavelength, arranged for following one photon at a time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Medium, altitude_nodes
from skybake.optics.phase import scattering_angles

Array = npt.NDArray[np.float64]


class Air(NamedTuple):
    """An atmosphere at one wavelength.

    Attributes
    ----------
    r_bottom : float
        Radius of the ground. [km]
    altitude : ndarray of float64, shape (node,)
        Altitudes of the nodes, from 0 to the top; everything between two nodes
        is linear in altitude. [km]
    extinction : ndarray of float64, shape (node,)
        Extinction coefficient. [km⁻¹]
    scattering : ndarray of float64, shape (constituent, node)
        Scattering coefficients. [km⁻¹]
    phase : ndarray of float64, shape (constituent, scattering angle)
        Phase functions at `scattering_angles`. [sr⁻¹]
    lobe : ndarray of float64, shape (constituent, scattering angle - 1)
        Probability of each interval of scattering angle, per solid angle: what
        directions are drawn from. [sr⁻¹]
    lobe_cumulative : ndarray of float64, shape (constituent, scattering angle)
        Probability of scattering by less than each angle.
    matrix : ndarray of float64, shape (constituent, ELEMENTS, scattering angle)
        The other elements of their matrices, see `Medium.matrix`. [sr⁻¹]
    albedo : float
        Lambertian albedo of the ground.
    """

    r_bottom: float
    altitude: Array
    extinction: Array
    scattering: Array
    phase: Array
    lobe: Array
    lobe_cumulative: Array
    matrix: Array
    albedo: float


def air_at(medium: Medium, wavelength: int) -> Air:
    """Pick one wavelength out of `medium`, by its index."""
    phase = np.ascontiguousarray(medium.phase[:, :, wavelength])
    lobe, cumulative = _lobes(phase)
    return Air(
        r_bottom=float(medium.r_bottom),
        altitude=altitude_nodes(medium.r_bottom, medium.r_top),
        extinction=medium.density @ medium.extinction[:, wavelength],
        scattering=np.ascontiguousarray((medium.density * medium.scattering[:, wavelength]).T),
        phase=phase,
        lobe=lobe,
        lobe_cumulative=cumulative,
        matrix=_matrix(medium, wavelength),
        albedo=float(medium.ground_albedo[wavelength]),
    )


def _matrix(medium: Medium, wavelength: int) -> Array:
    if not len(medium.matrix):
        return np.empty((0, 0, 0))
    return np.ascontiguousarray(medium.matrix[..., wavelength])


def _lobes(phase: Array) -> tuple[Array, Array]:
    """Histogram of each phase function over scattering angle, and its running sum.

    A histogram is enough, since every sample is weighted by what it represents
    divided by the probability that it was in fact drawn with.
    """
    # 1 - cos(theta) = 2 sin²(theta/2) keeps its digits near 0, where cos does not.
    versine = 2.0 * np.sin(0.5 * scattering_angles()) ** 2
    solid_angle = 2.0 * np.pi * np.diff(versine)
    mass = 0.5 * (phase[:, 1:] + phase[:, :-1]) * solid_angle
    total = mass.sum(axis=1, keepdims=True)
    mass /= np.where(total > 0.0, total, 1.0)
    cumulative = np.concatenate([np.zeros((len(phase), 1)), np.cumsum(mass, axis=1)], axis=1)
    return mass / solid_angle, cumulative
