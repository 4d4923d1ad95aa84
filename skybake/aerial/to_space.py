"""What the air lets through of light from where nothing is, as a table over angles."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.aerial.air import Air
from skybake.aerial.depth import Depths
from skybake.aerial.sight import Lens, eye_of, look_through
from skybake.image.scene import Scene
from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.sky.disc import Disc

Floats = npt.NDArray[np.float32]

NODES = 1 << 14
"""Between which shares are linear. From 36,000 km the limb is 140 of them."""

SAMPLES = 16
"""In height, of a pixel near the horizon; others have one."""

NEAR = 16.0
"""Heights of a pixel up to which it is near the horizon."""

ROWS = 32
"""Rows that a thread takes at a time."""


class ToSpace(NamedTuple):
    """Share of light from space that reaches an observer, without clouds.

    Attributes
    ----------
    step : float
        Between nodes of the root of the angle from the horizon upward, of which the first
        is 0. [rad^½]
    shares : ndarray of float32, shape (node, 3)
        For R, G and B of light of the sun's colour.
    """

    step: float
    shares: Floats


def tabulate_to_space(scene: Scene) -> ToSpace:
    """Return what passes in a scene."""
    eye = eye_of(scene.sky.skylight, scene.sky.source)
    root = np.linspace(0.0, math.sqrt(eye.zenith_horizon), NODES)
    zenith = eye.zenith_horizon - root**2
    # The first is on the edge, where rounding decides whether the ground is in the way.
    zenith[0] = zenith[1]
    disc = Disc(scene.sky.skylight, scene.sky.source)
    weights = scene.rgb_weights
    shares = disc.transmittance(zenith) @ weights / weights.sum(axis=0)
    return ToSpace(float(root[1]), shares.astype(np.float32))


def dim_beyond(scene: Scene, lens: Lens, depths: Depths, air: Air) -> None:
    """Write what passes all of the air into `air`, where depths are infinite."""
    eye = eye_of(scene.sky.skylight, scene.sky.source)
    given = [
        flatten(each) for each in (eye, lens, tabulate_to_space(scene), depths.values, air.passing)
    ]

    def work(first: int, last: int) -> None:
        fill_to_space(*given, first, last, np.empty(3))

    scene.workers.run_rows(len(depths.values), work, chunk=ROWS)


@kernel
def fill_to_space(eye, lens, table, depth, passing, first, last, direction):
    """Write the mean share that passes over the height of each pixel.

    Parameters
    ----------
    eye, lens : Eye, Lens
        The camera.
    table : ToSpace
        The shares.
    depth : ndarray of float32, shape (row, column)
        Infinite where pixels are to be written.
    passing : ndarray of float32, shape (row, column, 3)
        Receives shares; 0 where the planet is seen.
    first, last : int
        Rows to fill.
    direction : ndarray of float64, shape (3,)
        Work space.
    """
    for i in range(first, last):
        for j in range(depth.shape[1]):
            if depth[i, j] != math.inf:
                continue
            length = look_through(lens, i, j, direction)
            height = _height(lens, direction, length)
            angle = eye.zenith_horizon - math.acos(min(max(direction[1], -1.0), 1.0))
            samples = SAMPLES if abs(angle) < NEAR * height else 1
            for c in range(3):
                passing[i, j, c] = 0.0
            for s in range(samples):
                above = angle + height * ((s + 0.5) / samples - 0.5)
                if above <= 0.0:
                    continue
                x = math.sqrt(above) / table.step
                node = min(int(x), table.shares.shape[0] - 2)
                u = min(x - node, 1.0)
                for c in range(3):
                    low, high = table.shares[node, c], table.shares[node + 1, c]
                    passing[i, j, c] += (low + u * (high - low)) / samples


@kernel
def _height(lens, direction, length):
    """Extent of a pixel in zenith angle, of the ray that is `length` times as long as a depth."""
    sine = math.sqrt(direction[0] * direction[0] + direction[2] * direction[2])
    down_x, down_z = 1.0, 0.0
    if sine > 0.0:
        down_x, down_z = direction[0] / sine, direction[2] / sine
    down_x, down_y, down_z = direction[1] * down_x, -sine, direction[1] * down_z
    right = down_x * lens.frame[0, 0] + down_y * lens.frame[0, 1] + down_z * lens.frame[0, 2]
    up = down_x * lens.frame[1, 0] + down_y * lens.frame[1, 1] + down_z * lens.frame[1, 2]
    return math.hypot(lens.width * right, lens.height * up) / length
