"""Whether programs find in the files of their targets the directions that these encode."""

import math
from pathlib import Path

import numpy as np

from skybake.baking.orientation_chart import CHART_LUMINANCE, bake_orientation_chart
from skybake.image.settings import map_settings
from skybake.image.target import find_target

# Away from edges of cubes, poles and seams, in no plane of symmetry.
_SIDES = [
    (x, y, z)
    for x in (-0.9, -0.31, 0.45, 0.83)
    for y in (-0.77, 0.23, 0.66)
    for z in (-0.87, -0.18, 0.37, 0.95)
]
DIRECTIONS = np.array(_SIDES) / np.linalg.norm(_SIDES, axis=1, keepdims=True)
"""Unit vectors in the world's axes, shape (direction, 3)."""


def bake_directions(folder, target, projection=None, size=256, suffix=None, **values):
    """Write the map of directions for a target; return its files and what 1.0 is in them."""
    settings = map_settings(projection, size, target=target, pixel="float", **values)
    name = settings.view.projection.name
    path = Path(folder) / f"{target}_{name}{suffix or find_target(target).suffix(name)}"
    files = bake_orientation_chart(path, settings, is_lettered=False)
    return files, CHART_LUMINANCE / settings.encoding.white_luminance


def in_axes(target, directions=DIRECTIONS):
    """Directions in the axes of a target, as lists."""
    axes = find_target(target).axes
    return [axes.direction(tuple(one)) for one in directions.tolist()]


def worst_angle(colours, brightest, directions=DIRECTIONS):
    """Largest angle between directions and those that colours encode. [deg]"""
    found = 2.0 * np.asarray(colours, float) / brightest - 1.0
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    cosine = np.clip((found * directions).sum(axis=1), -1.0, 1.0)
    return math.degrees(float(np.arccos(cosine.min())))
