"""From radiance per unit irradiance to what an eye sees of it."""

from __future__ import annotations

import numpy as np

from skybake.colour.observer import xyz_weights
from skybake.colour.space import find_colour_space, rgb_from_xyz
from skybake.optics.medium import Array
from skybake.optics.spectrum import star_spectrum
from skybake.sky.sky import WAVELENGTHS, Sky


def luminous_weights(sky: Sky) -> Array:
    """Weights from radiance per unit irradiance [sr⁻¹] to XYZ [cd m⁻²], (wavelength, 3)."""
    star = star_spectrum(sky.star)
    if sky.planet.rendering == "spectral":
        return xyz_weights(sky.wavelengths, *star)
    # Three wavelengths stand for R, G and B, and the sun for white of its illuminance.
    illuminance = xyz_weights(WAVELENGTHS, *star)[:, 1].sum()
    xyz_from_rgb = np.linalg.inv(rgb_from_xyz(find_colour_space("lin_rec709")))
    weights: Array = illuminance * xyz_from_rgb.T
    return weights
