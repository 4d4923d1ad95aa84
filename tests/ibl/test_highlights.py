"""Small bright spots of a map light exactly as much as they are, and nothing flashes."""

import numpy as np
import pytest

from skybake.ibl.highlights import MOST, split_highlights
from skybake.ibl.specular import SpecularFilter
from skybake.ibl.surroundings import without_disc
from tests.ibl.maps import directions, gradient, lobe_mean, sizes


@pytest.fixture(scope="module")
def sunny():
    cube = gradient(256)
    cube[4, 60:63, 140:143] += np.array([40000.0, 30000.0, 20000.0], np.float32)
    return cube


def test_what_is_left_and_the_spots_are_the_map(sunny):
    smooth, points = split_highlights(sunny)
    assert len(points) == 9
    assert smooth.max() < 20.0
    weights = sizes(256)
    whole = weights @ sunny.reshape(-1, 3).astype(float)
    left = weights @ smooth.reshape(-1, 3).astype(float)
    assert left + points.flux.sum(axis=0) == pytest.approx(whole, rel=1e-6)


def test_rough_mirrors_show_a_sun_of_few_texels_as_the_integral_has_it(sunny):
    smooth, points = split_highlights(sunny)
    edge = 64
    shown = SpecularFilter(smooth, points).cube(edge, 1 / 3, 256).reshape(-1, 3)
    sun = directions(256).reshape(6, 256, 256, 3)[4, 61, 141]
    near = np.argsort(-(directions(edge) @ sun))[:400:40]
    for i in near:
        expected = lobe_mean(sunny, directions(edge)[i], 1 / 3)
        assert shown[i] == pytest.approx(expected, rel=0.01)


def test_a_lamp_that_texels_resolve_stays_in_the_map():
    _, points = split_highlights(gradient(256))
    assert len(points) == 0


def test_of_a_sky_full_of_stars_the_brightest_are_points():
    random = np.random.default_rng(2)
    cube = np.full((6, 128, 128, 3), 0.01, np.float32)
    face, row, column = random.integers(0, 6, 5000), *random.integers(0, 128, (2, 5000))
    cube[face, row, column] = random.random((5000, 1)).astype(np.float32) * 100.0
    smooth, points = split_highlights(cube)
    assert len(points) == MOST
    whole = sizes(128) @ cube.reshape(-1, 3).astype(float)
    left = sizes(128) @ smooth.reshape(-1, 3).astype(float)
    assert left + points.flux.sum(axis=0) == pytest.approx(whole, rel=1e-6)


def test_a_disc_is_replaced_by_what_is_around_it(sunny):
    plain = gradient(256)
    sun = directions(256).reshape(6, 256, 256, 3)[4, 61, 141]
    filled = without_disc(sunny, sun, 1.5 * np.pi / 2 / 256)
    assert np.abs(filled - plain).max() < 0.1
