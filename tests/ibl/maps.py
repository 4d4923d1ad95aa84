"""Cubes of light that tests filter."""

import numpy as np

from skybake.ibl.cube import texel_directions, texel_sizes
from skybake.ibl.points import no_points
from skybake.ibl.surroundings import Surroundings


def directions(edge):
    """Unit vectors of all texels, shape (texel, 3)."""
    return texel_directions(edge).reshape(-1, 3).astype(float)


def sizes(edge):
    """Solid angles of all texels. [sr]"""
    return np.tile(texel_sizes(edge).ravel(), 6)


def gradient(edge):
    """A sky that differs in every direction and colour, with a soft lamp and dark ground."""
    x, y, z = directions(edge).T
    lamp = 6.0 * np.exp(-40.0 * (1.0 - (0.48 * x + 0.6 * y + 0.64 * z)))
    ground = np.where(y > 0.0, 1.0, 0.3)
    light = np.stack(
        [ground * (1.0 + 0.5 * x) + lamp, ground * (1.0 + 0.4 * z) + lamp, 1.0 + 0.6 * y], axis=-1
    )
    return light.reshape(6, edge, edge, 3).astype(np.float32)


def without_points(cube):
    """Surroundings that are all texels."""
    return Surroundings(cube, cube, no_points())


def lobe_mean(cube, normal, roughness):
    """What a rough mirror shows, by a sum over all texels of Karis's integral for N = V = R."""
    edge = cube.shape[1]
    cosine = directions(edge) @ normal
    half = np.sqrt(0.5 * (1.0 + cosine))
    a = roughness**4
    weight = a / (half**2 * (a - 1.0) + 1.0) ** 2 * np.maximum(cosine, 0.0) * sizes(edge)
    return weight @ cube.reshape(-1, 3) / weight.sum()
