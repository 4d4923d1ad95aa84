"""The sky and the ground all round one observer, without the sun's disc."""

from __future__ import annotations

from collections.abc import Mapping as Values

import numpy as np

from skybake.image.scene import Scene
from skybake.luts.mapping import Mapping
from skybake.luts.table import Table, texels
from skybake.sky.table import EDGE

POINT = 1e-9
"""Extent of what a texel averages in zenith angle: none, so that the horizon stays sharp. [rad]"""


def sky_view_table(
    scene: Scene, mapping: Mapping, size: tuple[int, ...], constants: Values[str, float]
) -> Table:
    """Tabulate the light of the sky, with phase functions applied.

    Parameters
    ----------
    scene : Scene
        The observer, the sun and the scale.
    mapping, size, constants
        Where the texels are, see `Mapping.texels`.
    """
    places = mapping.texels(size, constants)
    zenith, horizon = places["zenith"], constants["HORIZON"]
    above = np.arange(size[1])[:, None] < size[1] // 2
    zenith = np.where(above, np.minimum(zenith, horizon - EDGE), np.maximum(zenith, horizon + EDGE))
    azimuth = np.arccos(np.clip(places["cos_azimuth"], -1.0, 1.0))
    return Table(
        name=mapping.table,
        values=texels(scene.evaluate_clear(zenith, azimuth, POINT)),
        quantity="radiance of sky and ground without the sun's disc",
        unit="white luminance",
        is_radiance=True,
        mapping=mapping,
    )
