"""Clouds between a camera and what it sees, and their shadows in the air before that."""

from __future__ import annotations

import numpy as np

from skybake.aerial.air import Air
from skybake.aerial.depth import Depths
from skybake.aerial.sight import Lens
from skybake.angles import zenith_azimuth
from skybake.clouds.before import CloudsBefore
from skybake.clouds.cloudscape import Cloudscape
from skybake.colour.space import rgb_from_xyz
from skybake.image.cloudy import RESOLVED
from skybake.image.scene import Scene
from skybake.optics.medium import Array

BAND = 64
"""Rows at a time: the marches of a whole picture would fill the memory."""


def with_clouds(scene: Scene, cloudscape: Cloudscape, lens: Lens, depths: Depths, air: Air) -> Air:
    """Return the air before a picture with the clouds of a scene in it.

    Parameters
    ----------
    scene : Scene
        The observer, the sun, and the scale and space of values.
    cloudscape : Cloudscape
        Its clouds.
    lens : Lens
        Where pixels look.
    depths : Depths
        How far they see.
    air : Air
        Clear air up to there; at infinity and at 0 it stays as it is.
    """
    before, azimuth = CloudsBefore(cloudscape), scene.settings.lighting.sun_azimuth
    encoding = scene.settings.encoding
    to_rgb = rgb_from_xyz(encoding.space).T / encoding.white_luminance
    to_xyz = np.linalg.inv(to_rgb)
    light, passing = air.light.copy(), air.passing.copy()
    for first in range(0, len(light), BAND):
        values = depths.values[first : first + BAND]
        row, column = np.nonzero(np.isfinite(values) & (values > 0.0))
        if row.size == 0:
            continue
        vectors, stretch = _rays(lens, first + row, column)
        distance = values[row, column].astype(float) * depths.unit
        distance *= stretch if depths.is_planar else 1.0
        zenith, bearing = zenith_azimuth(vectors)
        at = first + row, column
        footprint = np.array([[lens.width]])
        clear = scene.evaluate_clear(zenith[:, None], bearing[:, None] - azimuth, footprint)[:, 0]
        # In XYZ no light is negative, as ratios need.
        xyz, total = ((each @ to_xyz).astype(np.float32) for each in (light[at], clear))
        given = zenith, bearing, distance, RESOLVED * lens.width
        clouded, passes = before.put_before(xyz, total, *given)
        light[at] = clouded @ to_rgb
        passing[at] *= passes[:, None]
    return Air(light, passing)


def _rays(lens: Lens, row: np.ndarray, column: np.ndarray) -> tuple[Array, Array]:
    """Return unit vectors of pixels, and how much longer their rays are than planar depths."""
    u = lens.left + (column + 0.5) * lens.width
    v = lens.top - (row + 0.5) * lens.height
    vectors = np.stack([u, v, np.ones_like(u)], axis=1) @ lens.frame
    length = np.linalg.norm(vectors, axis=1)
    return vectors / length[:, None], length
