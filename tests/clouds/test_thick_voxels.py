"""Voxels of a file that are too thick for their light, and are divided for it."""

import math

import numpy as np
import pytest

from skybake.cloud_fields.build import build_field
from skybake.clouds.build import build_cloudscape, voxel_parts
from skybake.clouds.directions import unit_vectors
from skybake.jit.workers import Workers
from skybake.preset import load_preset
from skybake.sky.sky import Sky
from tests.clouds.tile_worlds import tile_world

VACUUM = "[ground]\nalbedo = 0.0\n" + (
    '[constituents]\nair = "none"\nozone = "none"\naerosol = "none"\n'
)
COARSE = (0.5, 0.5, 0.5)


def dense_cloud(parts):
    """A cloud that is dense in its middle, of voxels of half a kilometre in so many parts."""
    values = np.zeros((2, 4, 4), np.float32)
    values[:, 1:3, 1:3] = 10.0
    values[0, 1, 1] = 30.0
    for axis in range(3):
        values = np.repeat(values, parts, axis)
    return values, tuple(each / parts for each in COARSE)


def world(folder, values, spacing):
    return load_preset(tile_world(folder, values, spacing, settings=VACUUM))


def test_thick_voxels_are_divided_and_thin_ones_are_not(tmp_path):
    values, spacing = dense_cloud(1)
    field = build_field(world(tmp_path, values, spacing).clouds[0])
    assert (voxel_parts(field, 100_000) >= 4.0).all()
    assert voxel_parts(field, 100_000).prod() * values.size <= 100_000
    thin = field._replace(values=field.values * np.float32(0.1))
    assert (voxel_parts(thin, 100_000) == 1.0).all()
    assert (voxel_parts(field, values.size) == 1.0).all()


@pytest.mark.slow
def test_the_light_of_a_cloud_does_not_depend_on_how_coarse_its_voxels_are(tmp_path):
    directions = unit_vectors(np.radians([95.0, 100.0, 105.0, 110.0]), np.full(4, 0.3))
    seen = []
    for parts in (1, 4):
        folder = tmp_path / str(parts)
        folder.mkdir()
        planet = world(folder, *dense_cloud(parts))
        sky = Sky(planet, math.radians(40.0), 3.0, sun_azimuth=0.7, wavelengths=np.array([550.0]))
        clouds = build_cloudscape(
            planet.clouds, sky, np.eye(1), quality="draft", workers=Workers(1)
        )
        seen.append(clouds.radiance(directions)[:, 0])
    assert seen[1].min() > 0.0
    assert np.mean(seen[0] / seen[1]) == pytest.approx(1.0, abs=0.01)
