"""Linear polarisation along a path that is followed backward.

A path carries the matrix by which Stokes vectors (I, Q, U) that arrive at its end reach the
observer, over the weight that the path has for intensity alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.reference.directions import angle_node, dot

Array = npt.NDArray[np.float64]


class Track(NamedTuple):
    """Polarisation of one path; empty arrays for a path that is followed without it.

    Attributes
    ----------
    matrix : ndarray of float64, shape (3, 3)
        What Stokes vectors from along the path's last direction become at the observer.
    frame : ndarray of float64, shape (3,)
        Unit vector across the path from which their angles count, counter-clockwise as seen
        along the path.
    stokes : ndarray of float64, shape (3,)
        What the path has brought.
    """

    matrix: Array
    frame: Array
    stokes: Array


def no_track() -> Track:
    """Track of a path that is followed without polarisation."""
    return Track(np.empty((0, 0)), np.empty(0), np.empty(0))


def new_track() -> Track:
    """Room for the polarisation of one path after another."""
    return Track(np.empty((3, 3)), np.empty(3), np.zeros(3))


@kernel
def begin_track(track, up, direction):
    """Begin a path: angles count from the vertical plane, that of the x axis on the vertical."""
    if track.stokes.size == 0:
        return
    for i in range(3):
        for j in range(3):
            track.matrix[i, j] = 1.0 if i == j else 0.0
    along = dot(up, direction)
    x, y, z = (
        up[0] - along * direction[0],
        up[1] - along * direction[1],
        up[2] - along * direction[2],
    )
    norm = math.sqrt(x * x + y * y + z * z)
    if norm < 1e-9:
        # The sun's vertical plane is that of x and z.
        x, y, z, norm = -math.copysign(1.0, along), 0.0, 0.0, 1.0
    track.frame[0], track.frame[1], track.frame[2] = x / norm, y / norm, z / norm


@kernel
def lose_polarisation(track):
    """Meet the ground, which sends back light that is not polarised."""
    for i in range(track.matrix.shape[0]):
        track.matrix[i, 1] = track.matrix[i, 2] = 0.0


@kernel
def _turn_to_plane(track, direction, turned):
    """Count angles from the plane of two directions; returns the sine of the angle between them."""
    nu = dot(direction, turned)
    x, y, z = (
        turned[0] - nu * direction[0],
        turned[1] - nu * direction[1],
        turned[2] - nu * direction[2],
    )
    sine = math.sqrt(x * x + y * y + z * z)
    if sine < 1e-12:
        return 0.0
    a, b, c = track.frame[0], track.frame[1], track.frame[2]
    along = (x * a + y * b + z * c) / sine
    # The frame times the direction points to the left.
    left = (
        x * (b * direction[2] - c * direction[1])
        + y * (c * direction[0] - a * direction[2])
        + z * (a * direction[1] - b * direction[0])
    ) / sine
    cosine2, sine2 = along * along - left * left, 2.0 * along * left
    for i in range(3):
        even, odd = track.matrix[i, 1], track.matrix[i, 2]
        track.matrix[i, 1] = even * cosine2 + odd * sine2
        track.matrix[i, 2] = odd * cosine2 - even * sine2
    track.frame[0], track.frame[1], track.frame[2] = x / sine, y / sine, z / sine
    return sine


@kernel
def _element(air, each, node, element):
    """Element of the mixture's matrix over its phase function."""
    i = min(int(node), air.phase.shape[1] - 2)
    f = node - i
    whole = part = 0.0
    for c in range(len(each)):
        whole += each[c] * ((1.0 - f) * air.phase[c, i] + f * air.phase[c, i + 1])
        low, high = air.matrix[c, element, i], air.matrix[c, element, i + 1]
        part += each[c] * ((1.0 - f) * low + f * high)
    return part / whole if whole > 0.0 else 0.0


@kernel
def _face(track, turned):
    """Count angles from any vector across a direction, where there is no polarisation."""
    x, y, z = turned
    if abs(z) < 0.9:
        norm = math.sqrt(x * x + y * y)
        track.frame[0], track.frame[1], track.frame[2] = -y / norm, x / norm, 0.0
    else:
        norm = math.sqrt(y * y + z * z)
        track.frame[0], track.frame[1], track.frame[2] = 0.0, -z / norm, y / norm


@kernel
def turn_track(air, each, track, direction, turned, at_ground):
    """Scatter, or reflect: what arrives from `turned` goes back along `direction`."""
    if track.stokes.size == 0:
        return
    if at_ground:
        _face(track, turned)
        return
    sine = _turn_to_plane(track, direction, turned)
    node = angle_node(air.phase.shape[1] - 1, direction, turned)
    p12, p22, p33 = (
        _element(air, each, node, 0),
        _element(air, each, node, 1),
        _element(air, each, node, 2),
    )
    for i in range(3):
        whole, even = track.matrix[i, 0], track.matrix[i, 1]
        track.matrix[i, 0] = whole + p12 * even
        track.matrix[i, 1] = p12 * whole + p22 * even
        track.matrix[i, 2] *= p33
    if sine > 0.0:
        nu = dot(direction, turned)
        for j in range(3):
            track.frame[j] = (nu * turned[j] - direction[j]) / sine


@kernel
def add_sunlight(air, each, track, direction, sun, light, is_ground):
    """Add sunlight that the path's end sends back along `direction`, of the given intensity."""
    if track.stokes.size == 0:
        return
    if is_ground or light <= 0.0:
        for i in range(3):
            track.stokes[i] += light * track.matrix[i, 0]
        return
    _turn_to_plane(track, direction, sun)
    node = angle_node(air.phase.shape[1] - 1, direction, sun)
    p12 = _element(air, each, node, 0)
    for i in range(3):
        track.stokes[i] += light * (track.matrix[i, 0] + p12 * track.matrix[i, 1])
