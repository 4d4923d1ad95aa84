"""The sky around one observer as a table, and its evaluation at the pixels of a map.

The table holds, for directions around the observer, the RGB that each lobe of
`skybake.sky.lobes` multiplies. What it interpolates is therefore smooth even
where a phase function has a peak; the peak is applied per pixel. Directions
are split at the planet's horizon and, seen from space, at the top of the
atmosphere, and nothing is interpolated across these edges.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Array
from skybake.transport.kernel import inner_kernel, kernel

Table = npt.NDArray[np.float32]

LATITUDES = 120
AZIMUTHS = 33
AZIMUTHS_TWILIGHT = 97
EDGE = 1e-7
"""Angle by which the tables stay away from the horizon itself. [rad]"""


class SkyView(NamedTuple):
    """A sky for one observer and one sun, folded into a colour space.

    Attributes
    ----------
    zenith_first : float
        Zenith angle at which the air begins: 0 inside it, beyond 0 from space. [rad]
    zenith_horizon : float
        Zenith angle of the planet's horizon. [rad]
    sun_zenith : float
        Zenith angle of the sun. [rad]
    table : ndarray of float32, shape (2, latitude, azimuth, 3 * lobe)
        Above the horizon and below it, azimuths from the sun's to the opposite one;
        channels are R, G and B with all lobes each.
    curves : ndarray of float32, shape (SCATTERING_ANGLES, lobe)
        Lobes over the scattering angle.
    """

    zenith_first: float
    zenith_horizon: float
    sun_zenith: float
    table: Table
    curves: Table


def horizon_angles(r: float, r_bottom: float, r_top: float) -> tuple[float, float]:
    """Zenith angles at which the air begins and at which the ground begins. [rad]"""
    first = math.pi - math.asin(r_top / r) if r > r_top else 0.0
    return first, math.pi - math.asin(min(1.0, r_bottom / r))


def table_directions(
    zenith_first: float, zenith_horizon: float, azimuths: int
) -> tuple[Array, Array]:
    """Zenith angles, shape (2, LATITUDES), and azimuths, shape (azimuths,), of the nodes. [rad]

    Notes
    -----
    Latitudes crowd quadratically toward the horizon from both sides.
    """
    x = np.linspace(0.0, 1.0, LATITUDES)
    above = zenith_horizon - (zenith_horizon - zenith_first) * (1.0 - x) ** 2
    below = zenith_horizon + (math.pi - zenith_horizon) * x**2
    above = np.minimum(above, zenith_horizon - EDGE)
    below = np.maximum(below, zenith_horizon + EDGE)
    return np.stack([above, below]), np.linspace(0.0, math.pi, azimuths)


@inner_kernel
def _cubic(x, size, out):
    """Catmull-Rom weights of four nodes around `x`; returns the first, which may be -1."""
    i = min(max(int(x), 0), size - 2)
    s = min(max(x - i, 0.0), 1.0)
    out[0] = 0.5 * s * (-1.0 + s * (2.0 - s))
    out[1] = 1.0 + 0.5 * s * s * (3.0 * s - 5.0)
    out[2] = 0.5 * s * (1.0 + s * (4.0 - 3.0 * s))
    out[3] = 0.5 * s * s * (s - 1.0)
    return i - 1


@inner_kernel
def _latitude_weights(view, side, zenith, out):
    """Weights of four latitudes; at a table's edge the missing node is extrapolated."""
    size = view.table.shape[1]
    if side == 1:
        span = math.pi - view.zenith_horizon
        x = math.sqrt(max(zenith - view.zenith_horizon, 0.0) / span)
    else:
        span = view.zenith_horizon - view.zenith_first
        x = 1.0 - math.sqrt(max(view.zenith_horizon - zenith, 0.0) / span)
    i = _cubic(x * (size - 1), size, out)
    if i < 0:
        ghost = out[0]
        out[0], out[1], out[2] = out[1] + 3.0 * ghost, out[2] - 3.0 * ghost, out[3] + ghost
        out[3] = 0.0
        return 0
    if i > size - 4:
        ghost = out[3]
        out[3], out[2], out[1] = out[2] + 3.0 * ghost, out[1] - 3.0 * ghost, out[0] + ghost
        out[0] = 0.0
        return size - 4
    return i


@inner_kernel
def _fill_latitude(view, side, zenith, j_first, j_last, weights, out):
    """Interpolate the table at one zenith angle into rows of `out`, (azimuth + 2, channel).

    Row j holds azimuth j - 1; rows 0 and -1 mirror the neighbours of the sun's
    meridian, about which the sky is symmetric.
    """
    i = _latitude_weights(view, side, zenith, weights)
    azimuths, channels = view.table.shape[2], view.table.shape[3]
    a, b = np.float32(weights[0]), np.float32(weights[1])
    c, d = np.float32(weights[2]), np.float32(weights[3])
    table = view.table[side]
    for row in range(j_first, j_last):
        j = azimuths - 1 - abs(azimuths - 1 - abs(row - 1))
        for k in range(channels):
            out[row, k] = (
                a * table[i, j, k]
                + b * table[i + 1, j, k]
                + c * table[i + 2, j, k]
                + d * table[i + 3, j, k]
            )


@inner_kernel
def _fill_curves(view, half_sine_squared, out):
    """Interpolate the lobes at the angle whose half has this squared sine, shape (lobe,)."""
    last = view.curves.shape[0] - 1
    if half_sine_squared < 0.5:
        x = math.sqrt(math.sqrt(2.0 * half_sine_squared)) * (0.5 * last)
    else:
        x = last - math.sqrt(math.sqrt(2.0 * max(1.0 - half_sine_squared, 0.0))) * (0.5 * last)
    i = min(int(x), last - 1)
    u = np.float32(x - i)
    for q in range(out.size):
        out[q] = view.curves[i, q] + u * (view.curves[i + 1, q] - view.curves[i, q])


@inner_kernel
def _add_pixel(latitude, j, weights, share, curves, out):
    """Add `share` of the radiance at azimuth rows j..j+3 to `out`, shape (3,)."""
    a, b = np.float32(share * weights[0]), np.float32(share * weights[1])
    c, d = np.float32(share * weights[2]), np.float32(share * weights[3])
    lobes = curves.size
    for k in range(3):
        total = np.float32(0.0)
        for q in range(lobes):
            p = k * lobes + q
            total += curves[q] * (
                a * latitude[j, p]
                + b * latitude[j + 1, p]
                + c * latitude[j + 2, p]
                + d * latitude[j + 3, p]
            )
        out[k] += total


@kernel
def fill_directions(view, zenith, azimuth, height, first, last, out):
    """Evaluate a sky at pixels.

    Parameters
    ----------
    view : SkyView
        The table.
    zenith : ndarray of float64, shape (row, 1) or (row, column)
        Zenith angles of the pixels' centres; one column if a row shares its. [rad]
    azimuth : ndarray of float64, shape (1, column) or (row, column)
        Azimuths relative to the sun; one row if all rows share it. [rad]
    height : float
        Extent of a pixel in zenith angle, over which the edges of the planet and of
        its air are smoothed by the share of the pixel on either side. [rad]
    first, last : int
        Rows to fill.
    out : ndarray of float32, shape (last - first, column, 3)
        Receives RGB.
    """
    azimuths, channels = view.table.shape[2], view.table.shape[3]
    latitude = np.empty((2, azimuths + 2, channels), np.float32)
    curves = np.empty(view.curves.shape[1], np.float32)
    weights = np.empty(4)
    columns = out.shape[1]
    node = np.empty(columns)
    across_squared = np.empty(columns)
    shares_zenith, shares_azimuth = zenith.shape[1] == 1, azimuth.shape[0] == 1
    for i in range(first, last):
        if i == first or not shares_azimuth:
            for j in range(columns):
                phi = azimuth[0 if shares_azimuth else i, j]
                phi = abs(phi - 2.0 * math.pi * math.floor(phi / (2.0 * math.pi) + 0.5))
                node[j] = phi / math.pi * (azimuths - 1)
                across_squared[j] = math.sin(0.5 * phi) ** 2
        above = below = theta_above = theta_below = 0.0
        along_squared = sines = 0.0
        for j in range(columns):
            row = min(int(node[j]), azimuths - 2)
            if j == 0 or not shares_zenith:
                theta = zenith[i, 0 if shares_zenith else j]
                above, theta_above, below, theta_below = _split_pixel(view, theta, height)
                along_squared = math.sin(0.5 * (theta - view.sun_zenith)) ** 2
                sines = math.sin(theta) * math.sin(view.sun_zenith)
                j_first, j_last = (0, azimuths + 2) if shares_zenith else (row, row + 4)
                for side in range(2):
                    if (above if side == 0 else below) > 0.0:
                        theta_here = theta_above if side == 0 else theta_below
                        _fill_latitude(
                            view, side, theta_here, j_first, j_last, weights, latitude[side]
                        )
            _cubic(node[j], azimuths, weights)
            _fill_curves(view, min(along_squared + sines * across_squared[j], 1.0), curves)
            pixel = out[i - first, j]
            for k in range(3):
                pixel[k] = 0.0
            if above > 0.0:
                _add_pixel(latitude[0], row, weights, above, curves, pixel)
            if below > 0.0:
                _add_pixel(latitude[1], row, weights, below, curves, pixel)


@inner_kernel
def _split_pixel(view, theta, height):
    """Shares of a pixel above and below the horizon, and the zenith angle of each's middle."""
    low, high = theta - 0.5 * height, theta + 0.5 * height
    begin = max(low, view.zenith_first) if view.zenith_first > 0.0 else low
    end = min(high, view.zenith_horizon)
    above = max(end - begin, 0.0) / height
    theta_above = theta if above > 0.999 else 0.5 * (begin + end)
    begin = max(low, view.zenith_horizon)
    below = max(high - begin, 0.0) / height
    theta_below = theta if below > 0.999 else 0.5 * (begin + high)
    return above, theta_above, below, theta_below
