"""Light of the air in front of pixels, interpolated in volumes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.aerial.sight import BELOW, OUTSIDE, find_place, look_through
from skybake.aerial.volume import SPREAD, TAPS, Volume
from skybake.jit.kernel import kernel
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]


class AirScratch(NamedTuple):
    """Work space of `fill_air`; each thread needs its own.

    Attributes
    ----------
    place, direction : ndarray of float64
        Of a pixel, see `find_place`.
    weights : ndarray of float64, shape (3, 4)
        Of nodes of the angle, the azimuth and the way.
    sums : ndarray of float32, shape (3 * curve,)
        Values of a pixel.
    """

    place: Array
    direction: Array
    weights: Array
    sums: Floats


def allocate_air(*volumes: Volume) -> AirScratch:
    """Make the work space for lookups in volumes."""
    most = max(volume.light.shape[3] for volume in volumes)
    return AirScratch(np.empty(6), np.empty(3), np.empty((3, TAPS)), np.empty(most, np.float32))


@kernel
def fill_air(
    eye, lens, above, below, depth, factor, is_planar, first, last, scratch, light, passing
):
    """Write the light between a camera and what its pixels show, and what passes.

    Parameters
    ----------
    eye, lens : Eye, Lens
        The camera.
    above, below : Volume
        Light above the horizon and below it.
    depth, factor, is_planar
        As of `survey`. Where a depth is 0 or infinite no air is written.
    first, last : int
        Rows to fill.
    scratch : AirScratch
        Work space.
    light, passing : ndarray of float32, shape (row, column, 3)
        Receive RGB.
    """
    place, direction = scratch.place, scratch.direction
    for i in range(first, last):
        for j in range(depth.shape[1]):
            for c in range(3):
                light[i, j, c] = 0.0
                passing[i, j, c] = 1.0
            length = look_through(lens, i, j, direction)
            distance = depth[i, j] * factor
            if is_planar:
                distance *= length
            if not 0.0 < distance < math.inf:
                continue
            side = find_place(eye, direction, distance, place)
            if side == BELOW:
                _add_air(below, place, scratch, light[i, j], passing[i, j])
            elif side != OUTSIDE:
                _add_air(above, place, scratch, light[i, j], passing[i, j])


@kernel
def _add_air(volume, place, scratch, light, passing):
    rows, columns, ends, values = volume.light.shape
    weights, sums = scratch.weights, scratch.sums
    row = _cubic((place[0] - volume.angle_first) / volume.angle_step, rows, weights[0])
    around = place[1] / math.pi * (columns - 1)
    column = min(int(around), columns - 2)
    weights[1, 1] = around - column
    weights[1, 0] = 1.0 - weights[1, 1]
    way = math.log(place[2] + volume.near) + SPREAD * place[2]
    end = _cubic((way - volume.way_first) / volume.way_step, ends, weights[2])
    w0, w1 = np.float32(weights[2, 0]), np.float32(weights[2, 1])
    w2, w3 = np.float32(weights[2, 2]), np.float32(weights[2, 3])
    for k in range(values):
        sums[k] = np.float32(0.0)
    for p in range(TAPS):
        for q in range(2):
            weight = np.float32(weights[0, p] * weights[1, q])
            f0, f1, f2, f3 = w0 * weight, w1 * weight, w2 * weight, w3 * weight
            nodes = volume.light[row + p, column + q]
            at_0, at_1, at_2, at_3 = nodes[end], nodes[end + 1], nodes[end + 2], nodes[end + 3]
            for k in range(values):
                sums[k] += f0 * at_0[k] + f1 * at_1[k] + f2 * at_2[k] + f3 * at_3[k]
    curves = values // 3
    half = 0.5 * (volume.curves.shape[0] - 1)
    near, far = 0.5 * (1.0 - place[4]), 0.5 * (1.0 + place[4])
    x = half * math.sqrt(math.sqrt(2.0 * min(near, far)))
    x = x if near < far else 2.0 * half - x
    i = min(int(x), volume.curves.shape[0] - 2)
    u = x - i
    for c in range(3):
        light[c] = 0.0
        for k in range(curves):
            low, high = volume.curves[i, k], volume.curves[i + 1, k]
            light[c] += (low + u * (high - low)) * sums[c * curves + k] * place[3]
        dimming = 0.0
        for p in range(TAPS):
            for t in range(TAPS):
                dimming += weights[0, p] * weights[2, t] * volume.dimming[row + p, end + t, c]
        passing[c] = 1.0 - dimming * place[3]


@kernel
def _cubic(x, size, out):
    """Write weights of Lagrange's cubic through four nodes; return the first of them."""
    x = min(max(x, 0.0), size - 1.0)
    first = min(max(int(x) - 1, 0), size - TAPS)
    t = x - first
    out[0] = -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0
    out[1] = t * (t - 2.0) * (t - 3.0) / 2.0
    out[2] = -t * (t - 1.0) * (t - 3.0) / 2.0
    out[3] = t * (t - 1.0) * (t - 2.0) / 6.0
    return first
