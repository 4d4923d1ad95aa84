"""Light that is the same from everywhere stays so."""

import math

import numpy as np
import pytest

from skybake.ibl.lighting import light
from skybake.ibl.settings import LightingMaps
from skybake.jit.workers import Workers
from tests.ibl.maps import gradient, without_points

HALF_ROUNDING = 2.0**-11
MAPS = LightingMaps(specular_size=32, mips=6, diffuse_size=16, samples=64, dfg_size=16)


@pytest.fixture(scope="module")
def furnace():
    return light(without_points(np.ones((6, 64, 64, 3), np.float32)), MAPS)


def test_every_level_of_the_specular_cube_is_constant(furnace):
    assert [level.shape[1] for level in furnace.specular] == [32, 16, 8, 4, 2, 1]
    for level in furnace.specular:
        assert np.abs(level - 1.0).max() < HALF_ROUNDING


def test_a_white_surface_is_as_bright_as_its_surroundings(furnace):
    assert np.abs(furnace.diffuse - 1.0).max() < HALF_ROUNDING


def test_the_first_harmonic_holds_all_of_constant_light(furnace):
    assert furnace.harmonics[0] == pytest.approx(2.0 * math.sqrt(math.pi), rel=1e-6)
    assert np.abs(furnace.harmonics[1:]).max() < 1e-6


def test_a_smooth_mirror_of_the_table_reflects_all_light_of_a_white_one(furnace):
    scale, bias = furnace.dfg[0].T
    assert scale + bias == pytest.approx(1.0, abs=2e-3)
    assert np.all(furnace.dfg.sum(axis=-1) <= 1.0 + 1e-6)


def test_maps_have_the_same_bits_for_any_number_of_threads():
    around = without_points(gradient(32))
    one, three = (light(around, MAPS, Workers(count)) for count in (1, 3))
    for first, second in zip(one.specular, three.specular, strict=True):
        assert np.array_equal(first, second)
    assert np.array_equal(one.diffuse, three.diffuse)
    assert np.array_equal(one.dfg, three.dfg)
