"""Light of single rays under a world's clouds."""

from __future__ import annotations

import numpy as np

from skybake.image.settings import Clouds
from skybake.jit.workers import ALL_CPUS
from skybake.optics.medium import Array
from skybake.preset import Planet
from skybake.sky.sky import Sky

CHANNELS_AT_ONCE = 4
RAYS_AT_ONCE = 8192


def clouded_light(
    planet: Planet, sky: Sky, zenith: Array, azimuth: Array, weights: Array, clouds: Clouds
) -> Array | None:
    """Light of rays that clouds cross, throw shadows on, or shine at.

    Parameters
    ----------
    planet : Planet
        The world.
    sky : Sky
        Its air, and where the sun and the observer are.
    zenith, azimuth : ndarray of float64, shape (ray,)
        Zenith angle of the view, and its bearing less that of the sun, clockwise. [rad]
    weights : ndarray of float64, shape (wavelength, channel)
        By which radiance per unit irradiance becomes the light of a channel, at least 0.
    clouds : Clouds
        When clouds are seen, and how finely their light is solved for.

    Returns
    -------
    ndarray of float64, shape (ray, channel), or None
        None where there is no cloud.

    Raises
    ------
    InputError
        As of `build_cloudscape`.
    """
    if not planet.clouds:
        return None
    # Clear skies do not wait for kernels of clouds.
    from skybake.clouds.build import build_cloudscape
    from skybake.clouds.directions import unit_vectors

    directions = unit_vectors(zenith, azimuth + sky.sun_azimuth)
    parts = []
    # The light of a layer's voxels takes memory for each channel.
    for first in range(0, weights.shape[1], CHANNELS_AT_ONCE):
        part = np.ascontiguousarray(weights[:, first : first + CHANNELS_AT_ONCE])
        cloudscape = build_cloudscape(
            planet.clouds,
            sky,
            part,
            time=clouds.time,
            quality=clouds.quality,
            workers=ALL_CPUS,
        )
        if cloudscape is None:
            return None
        rays = [
            cloudscape.radiance(directions[at : at + RAYS_AT_ONCE])
            for at in range(0, len(directions), RAYS_AT_ONCE)
        ]
        parts.append(np.concatenate(rays))
    return np.concatenate(parts, axis=1)
