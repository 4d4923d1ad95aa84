"""Three colours in 32 bits: shared exponents, and small floats without a sign.

References
----------
EXT_texture_shared_exponent and EXT_packed_float, registry.khronos.org/OpenGL.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

RGB9E5_MAX = 65408.0
"""Largest value of a shared exponent of 5 bits over mantissas of 9 bits."""

UFLOAT11_MAX = 65024.0
UFLOAT10_MAX = 64512.0
"""Largest values of floats of 11 and of 10 bits, 5 of which are the exponent."""

_BIAS = 15
_RGB9E5_MANTISSA = 9
_SMALLEST_NORMAL = np.float32(2.0**-14)
_FLOAT_MANTISSA = 23
_FLOAT_BIAS = 127

Floats = npt.NDArray[np.float32]
Words = npt.NDArray[np.uint32]


def rgb9e5(rgb: Floats) -> Words:
    """Round colours to mantissas of 9 bits under a shared exponent.

    Parameters
    ----------
    rgb : ndarray of float32, shape (..., 3)
        From 0 to `RGB9E5_MAX`.

    Returns
    -------
    ndarray of uint32, shape (...)
        Red in the lowest bits, then green, blue and the exponent.
    """
    largest = rgb.max(axis=-1)
    exponent = np.where(largest > 0.0, np.maximum(np.frexp(largest)[1], -_BIAS), -_BIAS)
    # Rounding may carry the largest colour to a mantissa of one bit more.
    step = _step(exponent)
    exponent = exponent + (np.floor(largest / step + np.float32(0.5)) >= 2**_RGB9E5_MANTISSA)
    step = _step(exponent)
    words: Words = (exponent + _BIAS).astype(np.uint32) << np.uint32(3 * _RGB9E5_MANTISSA)
    for channel in range(3):
        mantissa = np.floor(rgb[..., channel] / step + np.float32(0.5)).astype(np.uint32)
        words |= mantissa << np.uint32(channel * _RGB9E5_MANTISSA)
    return words


def r11g11b10(rgb: Floats) -> Words:
    """Round colours to floats of 11, 11 and 10 bits, ties to even.

    Parameters
    ----------
    rgb : ndarray of float32, shape (..., 3)
        From 0 to `UFLOAT11_MAX`, blue to `UFLOAT10_MAX`.

    Returns
    -------
    ndarray of uint32, shape (...)
        Red in the lowest bits, then green and blue.
    """
    words = _small_floats(rgb[..., 0], 6)
    words |= _small_floats(rgb[..., 1], 6) << np.uint32(11)
    words |= _small_floats(rgb[..., 2], 5) << np.uint32(22)
    return words


def _step(exponent: npt.NDArray[np.integer]) -> Floats:
    return np.asarray(np.ldexp(np.float32(1.0), exponent - _RGB9E5_MANTISSA), np.float32)


def _small_floats(values: Floats, mantissa: int) -> Words:
    """Bits of floats without a sign, of an exponent of 5 bits and a mantissa of so many."""
    values = np.ascontiguousarray(values, np.float32)
    bits = values.view(np.uint32)
    shift = np.uint32(_FLOAT_MANTISSA - mantissa)
    # Half the last place that stays, less one unless that place is odd.
    rounding = np.uint32((1 << int(shift) - 1) - 1) + ((bits >> shift) & np.uint32(1))
    rebias = np.uint32((_FLOAT_BIAS - _BIAS) << _FLOAT_MANTISSA)
    is_normal = values >= _SMALLEST_NORMAL
    normal = np.where(is_normal, bits + rounding - rebias, np.uint32(0)) >> shift
    steps = np.rint(
        np.where(is_normal, np.float32(0.0), values) * np.float32(2.0 ** (14 + mantissa))
    )
    return np.where(is_normal, normal, steps.astype(np.uint32))
