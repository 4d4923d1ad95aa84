"""The light of stars that are too faint to be drawn singly."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np

from skybake.night.star_light import star_irradiance
from skybake.optics.medium import Array

_MAP = Path(__file__).parents[1] / "data" / "night" / "milky_way.npz"

COLOUR = 0.75
"""B-V of starlight, about that of the sun."""

DIFFUSE = 1.1
"""Factor for light that dust between the stars scatters."""

_LEVEL, _OCTAVE = 10.0, 20.0

SQUARE_DEGREE = math.radians(1.0) ** 2
"""[sr]"""

TO_GALAXY = np.array(
    [
        [-0.0548755604162154, -0.8734370902348850, -0.4838350155487132],
        [0.4941094278755837, -0.4448296299600112, 0.7469822444972189],
        [-0.8676661490190047, -0.1980763734312015, 0.4559837761750669],
    ]
)
"""Matrix from axes of J2000 to galactic ones (ESA 1997, The Hipparcos and Tycho Catalogues, vol. 1,
eq. 1.5.11)."""


def starlight(vectors: Array) -> Array:
    """Stars of V = 10 to the square degree, the magnitude of the light of faint stars.

    Parameters
    ----------
    vectors : ndarray of float64, shape (..., 3)
        Unit vectors in galactic axes.

    Returns
    -------
    ndarray of float64, shape (...)
        Of all that are fainter than V = 6.5, and of the dust that they light.
    """
    table = _load()
    rows, columns = table.shape
    latitude = np.degrees(np.arcsin(np.clip(vectors[..., 2], -1.0, 1.0)))
    longitude = np.degrees(np.arctan2(vectors[..., 1], vectors[..., 0])) % 360.0
    y, x = (90.0 - latitude) * (rows - 1) / 180.0, longitude * columns / 360.0
    i = np.minimum(y.astype(np.int64), rows - 2)
    j = x.astype(np.int64) % columns
    v, u, after = y - i, x - np.floor(x), (j + 1) % columns
    above = (1.0 - u) * table[i, j] + u * table[i, after]
    below = (1.0 - u) * table[i + 1, j] + u * table[i + 1, after]
    light: Array = DIFFUSE * ((1.0 - v) * above + v * below)
    return light


def starlight_spectrum(wavelengths: Array) -> Array:
    """Radiance of one star of V = 10 to the square degree. [W m⁻² sr⁻¹ nm⁻¹]"""
    one = star_irradiance(np.array([10.0]), np.array([COLOUR]), wavelengths)
    spectrum: Array = one[0] / SQUARE_DEGREE
    return spectrum


@cache
def _load() -> Array:
    with np.load(_MAP, allow_pickle=False) as arrays:
        table: Array = _LEVEL * 2.0 ** (arrays["code"].astype(np.float64) / _OCTAVE)
    return table
