"""The clear sky apart from its clouds, and what its air lets through."""

from __future__ import annotations

import numpy as np

from skybake.image.discs import CELLS_AT_ONCE
from skybake.image.scene import Scene
from skybake.optics.medium import Array
from skybake.sky.disc import Disc

HORIZON_SAMPLES = 8


def evaluate_apart(
    scene: Scene, zenith: Array, azimuth: Array, footprint: Array | float
) -> np.ndarray:
    """Pixel values of the sky without and with clouds.

    Parameters
    ----------
    scene : Scene
        What is seen.
    zenith, azimuth, footprint
        As of `Scene.evaluate`.

    Returns
    -------
    ndarray of float32, shape (row, column, 7)
        RGB of the clear sky, RGB of the sky with clouds, and the share of the clear sky that
        clouds hide, 0 to 1.
    """
    clear = scene.evaluate_clear(zenith, azimuth, footprint)
    if scene.cloudscape is None:
        return np.concatenate([clear, clear, np.zeros_like(clear[..., :1])], axis=2)
    clouded, hidden = scene.evaluate_clouded(zenith, azimuth, footprint)
    return np.concatenate([clear, clouded, hidden[..., None]], axis=2)


def evaluate_transmittance(
    scene: Scene, zenith: Array, azimuth: Array, footprint: Array | float
) -> np.ndarray:
    """Share of light from space that the air lets through to the observer.

    Parameters
    ----------
    scene : Scene
        What is looked through; its clouds do not count.
    zenith, azimuth, footprint
        As of `Scene.evaluate`.

    Returns
    -------
    ndarray of float32, shape (row, column, 3)
        By which RGB of light with the sun's spectrum is multiplied; 0 where the planet is seen.
    """
    shape = np.broadcast_shapes(zenith.shape, azimuth.shape)
    extent = np.broadcast_to(np.asarray(footprint, float), zenith.shape)
    disc = Disc(scene.sky.skylight, scene.sky.source)
    white = scene.rgb_weights.sum(axis=0)
    across = (np.arange(HORIZON_SAMPLES) + 0.5) / HORIZON_SAMPLES - 0.5
    flat, size = zenith.ravel(), extent.ravel()
    out = np.zeros((flat.size, 3), np.float32)
    for first in range(0, flat.size, CELLS_AT_ONCE // HORIZON_SAMPLES):
        part = slice(first, first + CELLS_AT_ONCE // HORIZON_SAMPLES)
        fine = np.clip(flat[part, None] + size[part, None] * across, 0.0, np.pi)
        light = disc.transmittance(fine.ravel()) @ scene.rgb_weights / white
        out[part] = light.reshape(*fine.shape, 3).mean(axis=1)
    return np.broadcast_to(out.reshape(*zenith.shape, 3), (*shape, 3)).copy()
