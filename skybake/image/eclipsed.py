"""What an eclipse leaves of a sky's pixels."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.colour.space import ColourSpace, rgb_from_xyz
from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.jit.workers import Workers
from skybake.optics.medium import Array
from skybake.sky.eclipse import Eclipse

ABOVE, BELOW, AROUND = 44, 20, 61
"""Zenith angles above the horizon and below it, and azimuths, of the rays that are traced."""

BELOW_FROM_SPACE = 44
FINELY = 41
"""Nodes between those where the middle of the shadow is seen from space."""

UMBRA = 700.0
"""Distance from the shadow's axis within which it is seen finely. [km]"""

EDGE = 1e-6
"""Angle by which rays stay away from the horizon itself. [rad]"""

DARK = 1e-12
"""XYZ over that of the brightest ray below which light is left as it is."""


class LeftShare(NamedTuple):
    """Share of XYZ that an eclipse leaves, over directions, as kernels read it.

    Attributes
    ----------
    horizon : float
        Zenith angle of the horizon. [rad]
    above, below, azimuth : ndarray of float64
        Nodes, ascending: zenith angles on either side of the horizon, and azimuths clockwise from
        the sun's, from -pi to pi. [rad]
    share_above, share_below : ndarray of float64, shape (zenith, azimuth, 3)
        The shares.
    to_xyz, to_rgb : ndarray of float64, shape (3, 3)
        Matrices between pixel values and XYZ.
    """

    horizon: float
    above: Array
    below: Array
    azimuth: Array
    share_above: Array
    share_below: Array
    to_xyz: Array
    to_rgb: Array

    def dim(self, zenith: Array, azimuth: Array, pixels: np.ndarray, workers: Workers) -> None:
        """Take from pixels what the eclipse takes.

        Parameters
        ----------
        zenith, azimuth : ndarray of float64, broadcast to shape (row, column)
            Of the pixels, azimuths clockwise from the sun's. [rad]
        pixels : ndarray of float32, shape (row, column, 3)
            Are changed.
        workers : Workers
            Threads that do the work.
        """
        shape = pixels.shape[:2]
        where = (
            np.ascontiguousarray(np.broadcast_to(each, shape), dtype=float)
            for each in (zenith, azimuth)
        )
        flat = [flatten(each) for each in (self, *where, pixels)]
        workers.run_rows(shape[0], lambda first, last: _dim(*flat, first, last), chunk=16)


def left_share(eclipse: Eclipse, xyz_weights: Array, space: ColourSpace) -> LeftShare:
    """Trace the rays that say what an eclipse leaves of the light in each direction.

    Light is far from even around an eclipsed sun, but its share of the light without an eclipse
    is smooth. So pixels are those of the ordinary sky times this share, in XYZ, where no light is
    negative.

    Parameters
    ----------
    eclipse : Eclipse
        The eclipse.
    xyz_weights : ndarray of float64, shape (wavelength, 3)
        XYZ is the radiance per unit irradiance times these.
    space : ColourSpace
        Of the pixels.
    """
    above, below, azimuth = _nodes(eclipse)
    zenith = np.concatenate([above, below])
    mu = np.repeat(np.cos(zenith), azimuth.size - 1)
    around = np.tile(azimuth[:-1], zenith.size)
    eclipsed, whole = (light @ xyz_weights for light in eclipse.radiance_per_irradiance(mu, around))
    is_dark = whole <= DARK * whole.max(axis=0)
    share = np.where(is_dark, 1.0, eclipsed / np.where(is_dark, 1.0, whole))
    share = np.clip(share, 0.0, 1.0).reshape(zenith.size, azimuth.size - 1, 3)
    share = np.concatenate([share, share[:, :1]], axis=1)
    to_rgb = rgb_from_xyz(space)
    return LeftShare(
        horizon=eclipse.horizon,
        above=above,
        below=below,
        azimuth=azimuth,
        share_above=np.ascontiguousarray(share[: above.size]),
        share_below=np.ascontiguousarray(share[above.size :]),
        to_xyz=np.asarray(np.linalg.inv(to_rgb), dtype=float),
        to_rgb=np.ascontiguousarray(to_rgb),
    )


def _nodes(eclipse: Eclipse) -> tuple[Array, Array, Array]:
    """Zenith angles above and below the horizon, and azimuths."""
    horizon, radius = eclipse.horizon, eclipse.radius
    first = math.pi - math.asin(eclipse.top / radius) if radius > eclipse.top else 0.0
    x = np.linspace(0.0, 1.0, ABOVE)
    above = np.minimum(horizon - (horizon - first) * (1.0 - x) ** 2, horizon - EDGE)
    x = np.linspace(0.0, 1.0, BELOW if first == 0.0 else BELOW_FROM_SPACE)
    below = np.maximum(horizon + (math.pi - horizon) * x**2, horizon + EDGE)
    azimuth = np.linspace(-math.pi, math.pi, AROUND)
    axis = eclipse.axis
    if first == 0.0 or axis is None:
        return above, below, azimuth
    flat, distance = math.hypot(axis[0], axis[1]), float(np.linalg.norm(axis))
    wide = min(UMBRA / distance, 1.0)
    fine = _around(math.acos(axis[2] / distance), wide, horizon + EDGE, math.pi)
    below = np.unique(np.concatenate([below, fine]))
    middle = math.atan2(axis[1], axis[0])
    fine = middle + _around(0.0, min(UMBRA / max(flat, 1e-9), math.pi), -math.pi, math.pi)
    fine = (fine + math.pi) % (2.0 * math.pi) - math.pi
    return above, below, np.unique(np.concatenate([azimuth, fine]))


def _around(middle: float, extent: float, least: float, most: float) -> Array:
    """Nodes on both sides of a middle, where they are twice as close as at the ends."""
    x = np.linspace(-1.0, 1.0, FINELY)
    nodes: Array = middle + extent * (0.5 * x + 0.5 * x**3)
    return nodes[(nodes > least) & (nodes < most)]


@kernel
def _dim(left, zenith, azimuth, pixels, first, last):
    for row in range(first, last):
        for column in range(pixels.shape[1]):
            theta, phi = zenith[row, column], azimuth[row, column]
            is_above = theta < left.horizon
            nodes = left.above if is_above else left.below
            table = left.share_above if is_above else left.share_below
            i = _find(nodes, theta)
            u = min(max((theta - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0), 1.0)
            phi -= 2.0 * math.pi * math.floor(phi / (2.0 * math.pi) + 0.5)
            j = _find(left.azimuth, phi)
            v = (phi - left.azimuth[j]) / (left.azimuth[j + 1] - left.azimuth[j])
            red, green, blue = (
                pixels[row, column, 0],
                pixels[row, column, 1],
                pixels[row, column, 2],
            )
            new_red = new_green = new_blue = 0.0
            for c in range(3):
                low = table[i, j, c] + v * (table[i, j + 1, c] - table[i, j, c])
                high = table[i + 1, j, c] + v * (table[i + 1, j + 1, c] - table[i + 1, j, c])
                to_xyz = left.to_xyz[c]
                value = to_xyz[0] * red + to_xyz[1] * green + to_xyz[2] * blue
                value *= low + u * (high - low)
                new_red += left.to_rgb[0, c] * value
                new_green += left.to_rgb[1, c] * value
                new_blue += left.to_rgb[2, c] * value
            pixels[row, column, 0] = new_red
            pixels[row, column, 1] = new_green
            pixels[row, column, 2] = new_blue


@kernel
def _find(nodes, value):
    """Interval of ascending nodes that holds a value, or the nearest one."""
    low, high = np.int64(0), np.int64(nodes.size - 1)
    while high - low > 1:
        middle = (low + high) // 2
        if value >= nodes[middle]:
            low = middle
        else:
            high = middle
    return low
