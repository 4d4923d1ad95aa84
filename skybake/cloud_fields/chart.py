"""How a flat tile of clouds lies on the sphere.

Places are in a frame whose origin is on the ground under the observer: x runs east, y north, z up.
"""

from __future__ import annotations

import math

from skybake.jit.kernel import kernel

_LOWEST = 0.05
"""Share of the radius above the planet's centre from where on down the tile is not narrowed any
further: far beyond what an observer sees."""


@kernel
def tile_place(field, radius, x, y, z):
    """Coordinates of the tile at a place; lines through the planet's centre keep theirs. [km]

    Parameters
    ----------
    field : CloudField
        The layer.
    radius : float
        Of the ground. [km]
    x, y, z : float
        The place. [km]

    Returns
    -------
    x, y : float
        For `skybake.cloud_fields.field.extinction_at`; only other kernels can take them.
    """
    scale = radius / max(radius + z, _LOWEST * radius)
    return field.origin[0] + x * scale, field.origin[1] + y * scale


@kernel
def tile_stretch(radius, x, y, z):
    """Kilometres of the tile that a kilometre may cross at a place, at most; at least 1."""
    height = max(radius + z, _LOWEST * radius)
    return max(1.0, radius / height * math.sqrt(1.0 + (x * x + y * y) / (height * height)))
