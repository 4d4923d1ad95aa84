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


SKY_ON_SCREEN = 0.36
"""Scene-linear value of a sky's mean: a stop above middle grey, as photographs have it."""

PLANET_ON_SCREEN = 0.7
"""Most that the mean of what is below the horizontal may come to, be it snow or a planet
below black space."""

_BEYOND = 8.0
_STARS = 0.01
_NO_LIGHT = 1e-30
_DARKEST_EV = -20.0


def auto_ev(
    luminance: npt.NDArray[np.floating],
    solid_angle: npt.ArrayLike = 1.0,
    above: npt.ArrayLike = True,
) -> float:
    """Exposure value for a picture of a sky, as a camera meters it.

    Parameters
    ----------
    luminance : ndarray of float
        Finite. [cd m⁻²]
    solid_angle : array_like of float, optional
        What each value counts, in any unit; broadcast to `luminance`. 0 leaves it out, as
        the sun's disc should be.
    above : array_like of bool, optional
        Which values are above the horizontal; broadcast to `luminance`.

    Returns
    -------
    float
        Exposure value at ISO 100, at least -20; 0 for a map without light.

    Notes
    -----
    The higher of two exposures. One brings the sky's mean of log luminance over solid angle to
    `SKY_ON_SCREEN`, and lets the light around the sun go white. The other brings the same mean
    of all that is below, there weighted with luminance besides, to `PLANET_ON_SCREEN`: from
    space that is the lit part of the planet and its limb, however little of the view they are
    and however dark the night side is. Both are smooth in whatever moves, since no
    pixel enters or leaves a mean by a threshold.

    What is more than eight stops above the sky's mean counts as eight stops: a disc that
    nobody has told of. Where less than a hundredth of the sky is lit, it is no sky but a sun
    in black space.
    """
    sample = np.maximum(np.asarray(luminance, np.float64), 0.0)
    weights = np.broadcast_to(np.asarray(solid_angle, np.float64), sample.shape)
    is_above = np.broadcast_to(np.asarray(above, np.bool_), sample.shape)
    lit = (sample > _NO_LIGHT) & (weights > 0.0)
    exposures = []
    sky, planet = lit & is_above, lit & ~is_above
    is_sky = weights[sky].sum() > _STARS * weights[is_above].sum()
    if sky.any() and (is_sky or not planet.any()):
        stops, share = np.log2(sample[sky]), weights[sky]
        mean = np.average(stops, weights=share)
        mean = np.average(np.minimum(stops, mean + _BEYOND), weights=share)
        exposures.append(mean - math.log2(SKY_ON_SCREEN))
    if planet.any():
        light = sample[planet]
        mean = np.average(np.log2(light), weights=weights[planet] * light)
        exposures.append(mean - math.log2(PLANET_ON_SCREEN))
    if not exposures:
        return 0.0
    return max(float(max(exposures)) - math.log2(luminance_from_ev(0.0)), _DARKEST_EV)
