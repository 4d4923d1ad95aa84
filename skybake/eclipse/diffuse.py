"""The share that an eclipse leaves of light that was scattered before, from place to place."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.eclipse.shadow import fill_share_at
from skybake.jit.kernel import kernel

Array = npt.NDArray[np.float64]

RINGS = np.array(
    [0.0, 6.0, 12.0, 20.0, 30.0, 45.0, 65.0, 90.0, 120.0, 160.0, 210.0, 280.0, 370.0, 500.0]
)
"""Distances along the ground, from its centre, at which the share is tabulated. [km]"""

AZIMUTHS = 16
SLOPES = np.linspace(-1.0, 1.0, 9) * np.abs(np.linspace(-1.0, 1.0, 9))
"""Cosines of the zenith angles at which a place is looked at, by the square of their root: in
totality light comes from the horizon, and particles scatter most of it on near there."""

FADE = 0.7
"""Share of the last ring from which the local share of sunlight takes over."""


class DiffuseShare(NamedTuple):
    """Share of the light that was scattered before, as kernels read it.

    Attributes
    ----------
    planet : float
        Distance of the observer from the planet's centre. [km]
    bottom : float
        Radius of the ground. [km]
    axes : ndarray of float64, shape (3, 3)
        In the axes of `Shadow`: toward the sun's bearing at the table's centre, to the right of
        it, and up there.
    altitude : ndarray of float64, shape (altitude,)
        Ascending from 0. [km]
    share : ndarray of float64, shape (altitude, ring, azimuth, slope, wavelength)
        Of what is scattered toward an observer, by the slope of the ray that looks there, of
        `SLOPES`. Azimuths are clockwise from the sun's; there is no ring where the share of
        sunlight serves instead.
    ground : ndarray of float64, shape (ring, azimuth, wavelength)
        Of the sky's irradiance of the ground.
    """

    planet: float
    bottom: float
    axes: Array
    altitude: Array
    share: Array
    ground: Array


class Corner(NamedTuple):
    """Work space of `fill_corner`: where a place is between the nodes of the table.

    Attributes
    ----------
    node : ndarray of int64, shape (4,)
        Ring, azimuth, the azimuth after it, altitude.
    part : ndarray of float64, shape (4,)
        Shares of the ring, the azimuth and the altitude above, and of the table itself.
    """

    node: npt.NDArray[np.int64]
    part: Array


def new_corner() -> Corner:
    """Make the work space; each thread needs its own."""
    return Corner(np.zeros(4, np.int64), np.zeros(4))


@kernel
def fill_diffuse_share(shadow, diffuse, rings, corner, x, y, z, mu, out):
    """Write the share of diffuse light that a place of the air scatters to an observer.

    Parameters
    ----------
    shadow : Shadow
        Of the moon, whose share of sunlight serves beyond the table.
    diffuse : DiffuseShare
        The table.
    rings : ndarray of float64
        `RINGS`.
    corner : Corner
        Work space.
    x, y, z : float
        The place, in the axes of `Shadow`. [km]
    mu : float
        Cosine of the zenith angle there of the ray that looks at it.
    out : ndarray of float64, shape (wavelength,)
        Receives the share.
    """
    fill_corner(diffuse, rings, corner, x, y, z)
    i, j, after, a = corner.node[0], corner.node[1], corner.node[2], corner.node[3]
    u, v, w, inside = corner.part[0], corner.part[1], corner.part[2], corner.part[3]
    if inside < 1.0:
        fill_share_at(shadow, x, y, z, out)
    if inside == 0.0:
        return
    steps = 0.5 * (diffuse.share.shape[3] - 1)
    slope = steps * (1.0 + math.copysign(math.sqrt(min(abs(mu), 1.0)), mu))
    s = min(int(slope), diffuse.share.shape[3] - 2)
    slope -= s
    for k in range(out.size):
        value = 0.0
        for corner_of in range(4):
            upper, steeper = corner_of // 2, corner_of % 2
            weight = (w if upper == 1 else 1.0 - w) * (slope if steeper == 1 else 1.0 - slope)
            if weight == 0.0:
                continue
            table, m = diffuse.share[a + upper], s + steeper
            near = table[i, j, m, k] + v * (table[i, after, m, k] - table[i, j, m, k])
            far = table[i + 1, j, m, k] + v * (table[i + 1, after, m, k] - table[i + 1, j, m, k])
            value += weight * (near + u * (far - near))
        out[k] = value if inside == 1.0 else out[k] + inside * (value - out[k])


@kernel
def fill_ground_share(shadow, diffuse, rings, corner, x, y, z, out):
    """Write the share of the sky's irradiance of the ground, as of `fill_diffuse_share`."""
    fill_corner(diffuse, rings, corner, x, y, z)
    i, j, after = corner.node[0], corner.node[1], corner.node[2]
    u, v, inside = corner.part[0], corner.part[1], corner.part[3]
    table = diffuse.ground
    if inside < 1.0:
        fill_share_at(shadow, x, y, z, out)
    if inside == 0.0:
        return
    for k in range(out.size):
        near = table[i, j, k] + v * (table[i, after, k] - table[i, j, k])
        far = table[i + 1, j, k] + v * (table[i + 1, after, k] - table[i + 1, j, k])
        value = near + u * (far - near)
        out[k] = value if inside == 1.0 else out[k] + inside * (value - out[k])


@kernel
def fill_corner(diffuse, rings, corner, x, y, z):
    """Find where a place is between the nodes of the table."""
    node, part = corner.node, corner.part
    node[:] = 0
    part[:] = 0.0
    if diffuse.share.shape[1] == 0:
        return
    cx, cy, cz = x, y, z + diffuse.planet
    axes = diffuse.axes
    ahead = axes[0, 0] * cx + axes[0, 1] * cy + axes[0, 2] * cz
    right = axes[1, 0] * cx + axes[1, 1] * cy + axes[1, 2] * cz
    up = axes[2, 0] * cx + axes[2, 1] * cy + axes[2, 2] * cz
    flat = math.sqrt(ahead * ahead + right * right)
    along = diffuse.bottom * math.atan2(flat, up)
    last = rings.size - 1
    if along >= rings[last]:
        return
    i = np.int64(0)
    while along >= rings[i + 1]:
        i += 1
    azimuths = diffuse.share.shape[2]
    turn = (math.atan2(right, ahead) / (2.0 * math.pi) % 1.0) * azimuths
    j = int(turn) % azimuths
    height = math.sqrt(flat * flat + up * up) - diffuse.bottom
    top = diffuse.altitude.size - 1
    a = np.int64(0)
    while a < top - 1 and height >= diffuse.altitude[a + 1]:
        a += 1
    low, high = diffuse.altitude[a], diffuse.altitude[a + 1]
    node[0], node[1], node[2], node[3] = i, j, (j + 1) % azimuths, a
    part[0] = (along - rings[i]) / (rings[i + 1] - rings[i])
    part[1] = turn - math.floor(turn)
    part[2] = min(max((height - low) / (high - low), 0.0), 1.0)
    fade = (rings[last] - along) / (rings[last] * (1.0 - FADE))
    part[3] = min(fade, 1.0)


@kernel
def sum_sunlight(shadow, places, bundle, light, turn, share, out):
    """Sum what emitters send to a receiver of the sunlight that is uncovered at each.

    Parameters
    ----------
    shadow : Shadow
        Of the moon.
    places : ndarray of float64, shape (emitter, 4)
        In axes of the receiver, from the observer's planet's centre [km], and the cosine of the
        zenith angle there of the ray from the receiver.
    bundle : ndarray of int64, shape (emitter,)
        To which of the sums each adds.
    light : ndarray of float64, shape (emitter, wavelength)
        What they send with nothing covered.
    turn : ndarray of float64, shape (4, 3)
        Rows that turn the receiver's axes into those of `Shadow`, and the planet's centre.
    share : ndarray of float64, shape (wavelength,)
        Work space.
    out : ndarray of float64, shape (bundle, wavelength)
        Receives the sums.
    """
    out[:] = 0.0
    for i in range(places.shape[0]):
        x, y, z = _turned(turn, places[i])
        fill_share_at(shadow, x, y, z, share)
        for k in range(share.size):
            out[bundle[i], k] += light[i, k] * share[k]


@kernel
def sum_diffuse(
    shadow, diffuse, rings, corner, places, bundle, on_ground, light, turn, share, out
):  # fmt: skip
    """Sum what emitters send to a receiver of light that was scattered before.

    Parameters are those of `sum_sunlight`; `on_ground` says which emitters are on the ground.
    """
    out[:] = 0.0
    for i in range(places.shape[0]):
        x, y, z = _turned(turn, places[i])
        if on_ground[i]:
            fill_ground_share(shadow, diffuse, rings, corner, x, y, z, share)
        else:
            fill_diffuse_share(shadow, diffuse, rings, corner, x, y, z, places[i, 3], share)
        for k in range(share.size):
            out[bundle[i], k] += light[i, k] * share[k]


@kernel
def _turned(turn, place):
    x = turn[0, 0] * place[0] + turn[0, 1] * place[1] + turn[0, 2] * place[2] + turn[3, 0]
    y = turn[1, 0] * place[0] + turn[1, 1] * place[1] + turn[1, 2] * place[2] + turn[3, 1]
    z = turn[2, 0] * place[0] + turn[2, 1] * place[1] + turn[2, 2] * place[2] + turn[3, 2]
    return x, y, z
