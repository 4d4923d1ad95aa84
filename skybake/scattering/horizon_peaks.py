"""What forward peaks scatter of diffuse light across the horizon.

`ScaledMedium` lets diffuse light that was scattered within a forward peak go straight on, which
holds where that light varies little over the peak's width. At the horizon it does not: half of
a peak there looks at the ground. The difference, between diffuse light that peaks scatter and the
same light going straight on, is held around the horizon.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.delta_m import ScaledMedium

LAST_SINE = 0.6
"""Distance from the horizon, in sines of elevation, up to which the difference is held."""

SIDE = 8
"""Nodes of that distance on either side of the horizon, crowded toward it."""


class HorizonPeaks(NamedTuple):
    """What peaks scatter of the difference across the horizon.

    Attributes
    ----------
    source : ndarray of float32, shape (altitude, sun, elevation, order * wavelength)
        Per unit irradiance and scattering coefficient of what is peaked, at the altitudes
        and suns of the diffuse field: terms cos(m * azimuth) of its orders. Elevations are
        `SIDE` above the local horizon and then `SIDE` below, each from the horizon on;
        none in a medium whose peaks are too weak to matter. [sr⁻¹]
    """

    source: npt.NDArray[np.float32]


def no_horizon_peaks(scaled: ScaledMedium) -> HorizonPeaks:
    """Difference in a medium without peaks that matter."""
    return HorizonPeaks(np.zeros((1, 1, 0, scaled.mixture.size), np.float32))


@kernel
def fill_elevation_weights(peaks, r_bottom, radius, mu, out):
    """First of the four nodes around an elevation and Lagrange's weights of them; -1 for none."""
    if peaks.source.shape[2] == 0:
        return -1
    ratio = min(r_bottom / radius, 1.0)
    above = mu + math.sqrt(1.0 - ratio * ratio)
    x = math.sqrt(abs(above) / LAST_SINE) * (SIDE - 1)
    if x >= SIDE - 1.0:
        return -1
    first = min(max(int(x) - 1, 0), SIDE - 4)
    a, b, c, d = x - first, x - first - 1.0, x - first - 2.0, x - first - 3.0
    out[0] = -b * c * d / 6.0
    out[1] = a * c * d / 2.0
    out[2] = -a * b * d / 2.0
    out[3] = a * b * c / 6.0
    return first if above >= 0.0 else first + SIDE


@kernel
def add_horizon_peaks(peaks, low, u, sun, node, weights, emitted, orders, series, out):
    """Add what a step scatters of the difference at one sun, flat by order and wavelength.

    Parameters
    ----------
    peaks : HorizonPeaks
        The difference.
    low, u : int, float
        Altitude's node below and the share of the one above.
    sun : int
        The sun's node.
    node, weights : int, ndarray
        Result of `fill_elevation_weights`.
    emitted : ndarray, shape (wavelength,)
        What the step scatters in peaks toward the observer.
    orders : int
        Terms that are wanted.
    series, out : ndarray of float32, shape (order * wavelength,)
        Work space, and the terms that are added to.
    """
    wavelengths = emitted.size
    size = orders * wavelengths
    series[:size] = np.float32(0.0)
    for i in range(2):
        share = u if i == 1 else 1.0 - u
        for q in range(4):
            weight = np.float32(share * weights[q])
            values = peaks.source[low + i, sun, node + q]
            for p in range(size):
                series[p] += weight * values[p]
    for m in range(orders):
        for k in range(wavelengths):
            p = m * wavelengths + k
            out[p] += np.float32(emitted[k]) * series[p]
