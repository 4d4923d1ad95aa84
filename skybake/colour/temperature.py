"""The temperature of the black body that a light looks most like."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

from skybake.colour.observer import load_observer
from skybake.colour.white_balance import black_body

Array = npt.NDArray[np.float64]

COOLEST, HOTTEST = 1000.0, 25000.0
"""Temperatures between which one is told. [K]"""

FARTHEST = 0.05
"""Distance from black bodies in the CIE 1960 diagram up to which a light has a temperature."""

_MIRED = 1e6


def correlated_temperature(xyz: Array) -> float | None:
    """Correlated colour temperature of a light.

    Parameters
    ----------
    xyz : ndarray of float64, shape (3,)
        Of any luminance.

    Returns
    -------
    float or None
        None of no light, and of one that no black body from `COOLEST` to `HOTTEST` looks
        like within `FARTHEST`. [K]

    References
    ----------
    CIE 015:2018, 9.5: the temperature of the Planckian radiator whose chromaticity is nearest
    in the diagram of (u, v) of CIE 1960; to be used up to a distance of 0.05.
    """
    if not (np.isfinite(xyz).all() and xyz[1] > 0.0):
        return None
    mired, locus = _locus()
    light = _uv(xyz)
    chord = np.diff(locus, axis=0)
    share = ((light - locus[:-1]) * chord).sum(axis=1) / (chord**2).sum(axis=1)
    nearest = locus[:-1] + np.clip(share, 0.0, 1.0)[:, None] * chord
    distance = np.linalg.norm(light - nearest, axis=1)
    best = int(np.argmin(distance))
    is_beyond = (best == 0 and share[0] < 0.0) or (best == len(chord) - 1 and share[-1] > 1.0)
    if is_beyond or distance[best] > FARTHEST:
        return None
    within = float(np.clip(share[best], 0.0, 1.0))
    return _MIRED / float(mired[best] + within * (mired[best + 1] - mired[best]))


@cache
def _locus() -> tuple[Array, Array]:
    """Reciprocal temperatures [1/MK] and (u, v) of black bodies."""
    mired = np.arange(_MIRED / HOTTEST, _MIRED / COOLEST + 0.5)
    wavelength, xyz_bar = load_observer()
    radiance = black_body(wavelength, (_MIRED / mired)[:, None])
    return mired, _uv(radiance @ xyz_bar)


def _uv(xyz: Array) -> Array:
    """Chromaticities of CIE 1960."""
    x, y, z = np.moveaxis(xyz, -1, 0)
    whole = x + 15.0 * y + 3.0 * z
    return np.stack([4.0 * x / whole, 6.0 * y / whole], axis=-1)
