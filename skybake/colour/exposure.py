"""What luminance an RGB of one stands for, in files and in previews."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError

UNITS = ("ev15", "nits")
"""Units of a file by name: exposed for EV 15, or candelas per square metre."""


def luminance_from_ev(ev: float) -> float:
    """Luminance that an exposure value brings to 1, in cd m⁻².

    Parameters
    ----------
    ev : float
        Exposure value at ISO 100, within -30 to 40.

    Raises
    ------
    InputError
        If it lies outside.

    Notes
    -----
    ``1.2 * 2**ev``: the saturation luminance of a camera by ISO 2720 and ISO 12232,
    78 / (100 * 0.65) = 1.2 cd m⁻² s at a lens transmittance of 0.65.

    References
    ----------
    S. Lagarde and C. de Rousiers, "Moving Frostbite to Physically Based Rendering",
    2014, section 5.1.2.
    """
    if not -30.0 <= ev <= 40.0:
        raise InputError(f"ev: must be within -30 to 40, got {ev:g}")
    return 1.2 * math.pow(2.0, ev)


def luminance_from_units(units: str) -> float:
    """Luminance of an RGB of (1, 1, 1) by the name of the unit, in cd m⁻².

    Raises
    ------
    InputError
        If the name is not one of `UNITS`.
    """
    if units not in UNITS:
        raise InputError(f"units: must be one of {', '.join(UNITS)}, got {units!r}")
    return 1.0 if units == "nits" else luminance_from_ev(15.0)


_SAMPLES = 256
_SKY = 0.36
_HIGHLIGHT = 2.0
_SUN_FREE = 0.99
_MOSTLY = 0.95
_DARK = 0.01
_PLANET = 0.8
_NO_LIGHT = 1e-30
_DARKEST_EV = -20.0


def auto_ev(luminance: npt.NDArray[np.floating]) -> float:
    """Exposure value at which a sky map is legible, by day, at night and in space.

    Parameters
    ----------
    luminance : ndarray of float, shape (row, column)
        Finite; an equirect map if it is twice as wide as high, else any image, each
        pixel of which counts the same. [cd m⁻²]

    Returns
    -------
    float
        Exposure value at ISO 100, at least -20; 0 for a map without light.

    Notes
    -----
    The mean of log luminance over solid angle is brought to 0.36, a stop above middle
    grey, as a sky is shown. The mean goes over the hemisphere above, unless that is black
    beside the rest as it is in space, and over what is brighter than a hundredth of
    its 99th percentile, which the sun does not reach: black space and the night side do
    not count. Then 95 % of the whole map are kept below 2, which the display
    transforms still tell from white; seen from high up the ground decides by that.
    """
    rows, columns = luminance.shape
    step = max(1, rows // _SAMPLES)
    sample = np.asarray(luminance[step // 2 :: step, step // 2 :: step], np.float64)
    weight = np.ones(len(sample))
    above = slice(None)
    if columns == 2 * rows:
        weight = np.sin((np.arange(len(sample)) + 0.5) * (np.pi / len(sample)))
        above = slice(0, max(1, len(sample) // 2))
    weights = np.broadcast_to(weight[:, None], sample.shape)

    mostly = _weighted_quantile(sample, weights, _MOSTLY)
    bright = _weighted_quantile(sample, weights, _SUN_FREE)
    bright_above = _weighted_quantile(sample[above], weights[above], _SUN_FREE)
    if bright == 0.0 and sample.any():
        # Seen from far away, the planet is less than a hundredth of the sky.
        bright = _weighted_quantile(sample[sample > 0.0], weights[sample > 0.0], _PLANET)
    elif bright_above >= _DARK * bright:
        sample, weights, bright = sample[above], weights[above], bright_above
    lit = sample >= max(_DARK * bright, _NO_LIGHT)
    if not lit.any():
        return 0.0
    log_mean = float(np.average(np.log2(sample[lit]), weights=weights[lit]))
    for_sky = log_mean - math.log2(_SKY)
    for_highlights = math.log2(max(mostly, _NO_LIGHT) / _HIGHLIGHT)
    return max(max(for_sky, for_highlights) - math.log2(luminance_from_ev(0.0)), _DARKEST_EV)


def _weighted_quantile(
    values: npt.NDArray[np.float64], weights: npt.NDArray[np.float64], share: float
) -> float:
    """Smallest value with at least this share of the weight at or below it."""
    order = np.argsort(values, axis=None)
    below = np.cumsum(weights.ravel()[order])
    return float(values.ravel()[order[np.searchsorted(below, share * below[-1])]])
