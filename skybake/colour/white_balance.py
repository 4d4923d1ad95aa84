"""What light a picture shows as white."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.colour.observer import load_observer
from skybake.colour.space import BRADFORD, D65, ColourSpace, bradford, rgb_from_xyz, xyz_from_xy
from skybake.errors import InputError

Array = npt.NDArray[np.float64]

_DAYLIGHT_FROM = 4000.0
_SECOND_RADIATION_CONSTANT = 1.438776877e7  # nm K

_WHOLE = 5.0
"""Ratio of a light's largest response to its smallest up to which one adapts to it wholly."""


def white_from_kelvin(kelvin: float) -> Array:
    """Light of a colour temperature: daylight from 4000 K on, and a black body below.

    Parameters
    ----------
    kelvin : float
        From 1000 to 25000. [K]

    Returns
    -------
    ndarray of float64, shape (3,)
        XYZ of luminance 1; 6504 K is D65.

    References
    ----------
    CIE 015:2018, 4.1.2 (daylight by its temperature).
    """
    if kelvin >= _DAYLIGHT_FROM:
        return xyz_from_xy(*_daylight(kelvin))
    wavelength, xyz_bar = load_observer()
    xyz = black_body(wavelength, kelvin) @ xyz_bar
    white: Array = xyz / xyz[1]
    return white


def black_body(wavelength: Array, kelvin: Array | float) -> Array:
    """Spectral radiance of a black body [K] at wavelengths [nm], in a unit of its own."""
    radiance: Array = wavelength**-5 / np.expm1(_SECOND_RADIATION_CONSTANT / (wavelength * kelvin))
    return radiance


def _daylight(kelvin: float) -> tuple[float, float]:
    """CIE xy of a phase of daylight."""
    inverse = 1e3 / kelvin
    if kelvin <= 7000.0:
        x = 0.244063 + inverse * (0.09911 + inverse * (2.9678 - 4.6070 * inverse))
    else:
        x = 0.237040 + inverse * (0.24748 + inverse * (1.9018 - 2.0064 * inverse))
    return x, -3.0 * x * x + 2.87 * x - 0.275


def balance(space: ColourSpace, white: Array) -> Array:
    """Matrix on the linear RGB of a space that makes a light look as D65 does.

    Parameters
    ----------
    space : ColourSpace
        Of the pixels.
    white : ndarray of float64, shape (3,)
        XYZ of the light, of any luminance.

    Returns
    -------
    ndarray of float64, shape (3, 3)
        ``balanced = matrix @ rgb``. Luminance of the light is kept.

    Raises
    ------
    InputError
        If it is no light.
    """
    if not (np.isfinite(white).all() and white[1] > 0.0):
        raise InputError(f"white balance: must be by a light, got XYZ {white.tolist()}")
    d65 = xyz_from_xy(*D65)
    to_rgb = rgb_from_xyz(space)
    to_d65 = bradford(white / white[1], d65)
    matrix: Array = to_rgb @ to_d65 @ np.linalg.inv(to_rgb)
    return matrix


def automatic_white(light: Array) -> Array:
    """Return what an eye or a camera takes as white in a light.

    Parameters
    ----------
    light : ndarray of float64, shape (3,)
        XYZ, of any luminance above 0.

    Returns
    -------
    ndarray of float64, shape (3,)
        XYZ. The light itself, unless a receptor hardly responds to it: then something between
        it and D65, down to D65 where the ratio of responses is 25 or more. Nothing could be
        told from the noise that a gain of so much makes, and in Titan's haze all is orange.
    """
    d65 = BRADFORD @ xyz_from_xy(*D65)
    responses = (BRADFORD @ light) / d65
    least = max(float(responses.min() / responses.max()), 1e-9)
    if least * _WHOLE >= 1.0:
        return light
    wanted = min(1.0, 1.0 / (_WHOLE * _WHOLE * least))
    share = (1.0 - wanted) / (1.0 - least)
    mixed = 1.0 - share + share * np.maximum(responses / responses.max(), 0.0)
    white: Array = np.linalg.solve(BRADFORD, mixed * d65)
    return white


def chromaticity(xyz: Array) -> tuple[float, float]:
    """CIE xy of a light."""
    x, y, _ = (xyz / xyz.sum()).tolist()
    return x, y
