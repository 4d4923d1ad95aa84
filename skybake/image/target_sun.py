"""Where the sun is in the axes of the program that a map is for."""

from __future__ import annotations

import numpy as np

from skybake.angles import direction_from_angles
from skybake.image.settings import MapSettings
from skybake.image.target import find_target


def target_sun_direction(settings: MapSettings, name: str) -> tuple[float, float, float]:
    """Return the unit vector toward the sun in the axes of the target of a map.

    Parameters
    ----------
    settings : MapSettings
        Of the map.
    name : str
        A name of `skybake.image.target.TARGETS`.
    """
    view, lighting, target = settings.view, settings.lighting, find_target(name)
    north = view.rotation - target.turn(view.projection.name)
    vector = direction_from_angles(
        np.float64(lighting.sun_azimuth - north), np.float64(lighting.sun_elevation)
    )
    east, up, south = vector.tolist()
    return target.axes.direction((east, up, south))
