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
        If it is outside.

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


def ev_from_luminance(luminance: float) -> float:
    """Exposure value that brings a luminance [cd m⁻²] to 1; inverse of `luminance_from_ev`."""
    return math.log2(luminance / 1.2)


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


_SKY = 0.36
_SUN_FREE = 0.99
_MOSTLY = 0.95
_HIGHLIGHT_SHARE = 0.6
_DARK = 0.01
_PLANET = 0.8
_NO_LIGHT = 1e-30
_DARKEST_EV = -20.0


def auto_ev(
    luminance: npt.NDArray[np.floating],
    solid_angle: npt.ArrayLike = 1.0,
    above: npt.ArrayLike = True,
) -> float:
    """Exposure value at which a sky map is legible, by day, at night and in space.

    Parameters
    ----------
    luminance : ndarray of float
        Finite. [cd m⁻²]
    solid_angle : array_like of float, optional
        What each value counts, in any unit; broadcast to `luminance`.
    above : array_like of bool, optional
        Which values are above the horizontal; broadcast to `luminance`. If none is, all count.

    Returns
    -------
    float
        Exposure value at ISO 100, at least -20; 0 for a map without light.

    Notes
    -----
    An exposure for the whole brings the mean of log luminance over solid angle to 0.36,
    a stop above middle grey, as a sky is shown. An exposure for the highlights brings
    them to 1, where the display transforms still keep hue. If the highlights ask for
    less light, the exposure goes three fifths of the way to theirs, in stops: the
    glow around the sun keeps its colour, and the rest of the sky its shape.

    Highlights are the 99th percentile of the hemisphere above, which the sun's disc does
    not reach but its aureole does, or the 95th of the whole map, which the ground
    reaches that is seen from high up. The mean is taken over the upper hemisphere too, unless
    that is black beside the rest as it is in space, and over what is brighter than a
    hundredth of that 99th percentile: black space and the night side do not count.
    """
    sample = np.asarray(luminance, np.float64)
    weights = np.broadcast_to(np.asarray(solid_angle, np.float64), sample.shape).ravel()
    upper = np.broadcast_to(np.asarray(above, np.bool_), sample.shape).ravel()
    if not upper.any():
        upper = np.ones_like(upper)
    sample = sample.ravel()

    mostly = _weighted_quantile(sample, weights, _MOSTLY)
    bright = _weighted_quantile(sample, weights, _SUN_FREE)
    bright_above = _weighted_quantile(sample[upper], weights[upper], _SUN_FREE)
    if bright == 0.0 and sample.any():
        # Seen from far away, the planet is less than a hundredth of the sky.
        bright = _weighted_quantile(sample[sample > 0.0], weights[sample > 0.0], _PLANET)
    elif bright_above >= _DARK * bright:
        sample, weights, bright = sample[upper], weights[upper], bright_above
    lit = sample >= max(_DARK * bright, _NO_LIGHT)
    if not lit.any():
        return 0.0
    for_whole = float(np.average(np.log2(sample[lit]), weights=weights[lit])) - math.log2(_SKY)
    for_highlights = math.log2(max(mostly, bright, _NO_LIGHT))
    for_both = for_whole + _HIGHLIGHT_SHARE * max(0.0, for_highlights - for_whole)
    return max(for_both - math.log2(luminance_from_ev(0.0)), _DARKEST_EV)


def _weighted_quantile(
    values: npt.NDArray[np.float64], weights: npt.NDArray[np.float64], share: float
) -> float:
    """Smallest value with at least this share of the weight at or below it."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(below, share * below[-1])]])
