"""The light of stars by their magnitude and colour."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from skybake.optics.medium import Array

_TABLE = Path(__file__).parents[1] / "data" / "night" / "star_colours.csv"
_FIRST_ROW = 5

_SECOND_RADIATION_CONSTANT = 1.438776877e7
"""[nm K]"""

_REFERENCE = 550.0
"""Wavelength at which the table states irradiances. [nm]"""


def star_irradiance(v: Array, b_v: Array, wavelengths: Array) -> Array:
    """Irradiance by stars above the air.

    Parameters
    ----------
    v, b_v : ndarray of float64, shape (n,)
        Magnitudes and colours of Johnson's system; beyond -0.35 to 3.4, where no star is, a colour
        is that of the nearer end. [mag]
    wavelengths : ndarray of float64, shape (wavelength,)
        [nm]

    Returns
    -------
    ndarray of float64, shape (n, wavelength)
        Of the black body that has the B-V, which is hotter than the star where hydrogen absorbs,
        and has its colour. [W m⁻² nm⁻¹]
    """
    colours, temperatures, levels = _table()
    # Inverse temperatures are almost linear in the colour.
    inverse = np.interp(b_v, colours, 1.0 / temperatures)[:, None]
    level = np.interp(b_v, colours, levels)[:, None] * 10.0 ** (-0.4 * v[:, None])
    x = _SECOND_RADIATION_CONSTANT * inverse
    shape = (_REFERENCE / wavelengths) ** 5 * np.expm1(x / _REFERENCE) / np.expm1(x / wavelengths)
    irradiance: Array = level * shape
    return irradiance


@cache
def _table() -> Array:
    """Colours, temperatures [K] and irradiances at 550 nm of V = 0, shape (3, n)."""
    lines = _TABLE.read_text(encoding="utf-8").splitlines()
    table = np.array([line.split(",") for line in lines[_FIRST_ROW:]], dtype=np.float64)
    table.flags.writeable = False
    return table.T
