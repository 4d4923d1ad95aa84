"""Environments to lay out anew, and what they hold."""

import numpy as np

from skybake.environment.environment import Environment, charts_of
from skybake.projection import Equirect

SUN = (0.6, 0.8)
"""Zenith angle and bearing. [rad]"""


def pictures(projection):
    return tuple(np.zeros((one.height, one.width, 3), np.float32) for one in projection.canvases())


def lit(projection, sun=SUN, radius=0.0046, radiance=7e4, rotation=0.0):
    """A smooth sky that differs in all directions, with a sun that holds most of its light."""
    pixels = pictures(projection)
    for chart, here in charts_of(projection, pixels):
        x, y, z = vectors(chart)
        here[..., 0] = 0.3 + 0.2 * y + 0.05 * x
        here[..., 1] = 0.4 + 0.1 * x
        here[..., 2] = 0.6 + 0.3 * y * y - 0.2 * z
        if sun is not None:
            cells = chart.disc_cells(*sun, radius)
            flux = np.zeros(here.shape[0] * here.shape[1])
            light = cells.weight * (cells.solid_angle * radiance)[:, None]
            np.add.at(flux, cells.texel.ravel(), light.ravel())
            here[...] += flux.reshape(here.shape[:2])[..., None].astype(np.float32)
    return Environment(pixels, projection, rotation)


def noisy(width, seed=0):
    """Lamps of every brightness at random places."""
    rng = np.random.default_rng(seed)
    pixels = np.exp(2.0 * rng.standard_normal((width // 2, width, 3))).astype(np.float32)
    return Environment((pixels,), Equirect(width))


def vectors(chart):
    zenith, bearing = np.broadcast_arrays(*chart.angles(0, chart.height))
    return (
        np.sin(zenith) * np.sin(bearing),
        np.cos(zenith),
        -np.sin(zenith) * np.cos(bearing),
    )


def energy(environment):
    """Sum of pixels times solid angles, (3,)."""
    total = np.zeros(3)
    for chart, here in charts_of(environment.projection, environment.pixels):
        size = np.broadcast_to(chart.solid_angles(0, chart.height), here.shape[:2])
        total += np.einsum("rcx,rc->x", here.astype(np.float64), size)
    return total


def brightest(environment):
    """Direction of the brightest pixel."""
    found = []
    for chart, here in charts_of(environment.projection, environment.pixels):
        row, column = np.unravel_index(here[..., 1].argmax(), here.shape[:2])
        found.append((here[row, column, 1], [part[row, column] for part in vectors(chart)]))
    return np.array(max(found, key=lambda one: one[0])[1])
