"""Compiles the kernels of air in pictures in advance."""

from __future__ import annotations

import math

import numpy as np

from skybake.aerial.air import air_before
from skybake.aerial.depth import Depths
from skybake.aerial.froxels import air_by_froxels
from skybake.aerial.sight import lens_of
from skybake.aerial.to_space import dim_beyond
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings
from skybake.preset import load_preset
from skybake.projection.camera import camera_from_angles


def compile_air() -> None:
    """Put air before a few pixels, by each method."""
    scene = Scene(load_preset("earth"), MapSettings())
    lens = lens_of(camera_from_angles(0.0, 0.0, 0.0, math.pi / 3.0, 1.0), (4, 4))
    depths = Depths(np.full((4, 4), 5.0, np.float32), 1.0, True)
    for method in (air_before, air_by_froxels):
        air = method(scene, lens, depths)
    dim_beyond(scene, lens, depths, air)
