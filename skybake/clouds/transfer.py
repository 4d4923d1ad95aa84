"""What the transfer of light through a layer is solved for: its voxels, and what enters them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.clouds.quadrature import Quadrature
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]


class Voxels(NamedTuple):
    """A tile of voxels whose forward peaks count as not scattered.

    Attributes
    ----------
    extinction : ndarray of float32, shape (z, y, x)
        [km⁻¹]
    spacing : ndarray of float64, shape (3,)
        Along z, y and x. [km]
    beam : ndarray of float32, shape (z, y, x)
        Mean over a voxel of a beam of the sun that enters with 1.
    leaving : float
        Mean of that beam beneath the layer.
    """

    extinction: Floats
    spacing: Array
    beam: Floats
    leaving: float


class Entering(NamedTuple):
    """Light that enters a layer, by channel.

    Attributes
    ----------
    sun : ndarray of float64, shape (channel, z)
        Irradiance facing the sun at the altitudes of voxels, without clouds.
    above : ndarray of float64, shape (channel, direction)
        Radiance of the sky along the downward directions.
    below, below_lit : ndarray of float64, shape (channel, direction)
        Radiance along the upward directions without clouds: what is in proportion to all light that
        comes down, and what the sun lights in the air beneath.
    down : ndarray of float64, shape (channel,)
        Irradiance of a horizontal plane at the base without clouds, by the sky alone.
    down_sun : ndarray of float64, shape (channel,)
        The same by the sun.
    sun_share : ndarray of float64, shape (channel,)
        What clouds above leave of the sun.
    clear_single, clear_diffuse : ndarray of float64, shape (channel, 2, height, direction)
        Radiance without clouds along the downward and along the upward directions, at heights that
        divide the layer evenly from its base to its top: what air scattered once, and the rest.
    """

    sun: Array
    above: Array
    below: Array
    below_lit: Array
    down: Array
    down_sun: Array
    sun_share: Array
    clear_single: Array
    clear_diffuse: Array


class Scattering(NamedTuple):
    """How voxels scatter along discrete directions.

    Attributes
    ----------
    order : int
        Highest degree.
    quadrature : Quadrature
        The directions.
    moments : ndarray of float64, shape (order + 1,)
        chi_l of the truncated phase function.
    sun : ndarray of float64, shape (3,)
        Unit vector toward the sun.
    """

    order: int
    quadrature: Quadrature
    moments: Array
    sun: Array
