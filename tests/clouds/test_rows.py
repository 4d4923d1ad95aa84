"""Pixels between two that look alike."""

import numpy as np
import pytest

from skybake.clouds.directions import unit_vectors
from skybake.clouds.rows import see_rows
from skybake.jit.workers import Workers

TOLERANCE, SIZE = 0.03, 0.002


class Picture:
    """Two layers, of which pixels know what is seen; counts those that are asked for."""

    def __init__(self, light, passes, *, size=SIZE, spacing=SIZE):
        self.light, self.passes = np.asarray(light, np.float32), np.asarray(passes, np.float32)
        self.shape, self.size, self.spacing = self.light.shape, size, spacing
        self.asked = 0

    def see(self, pixels):
        self.asked += len(pixels)
        seen = np.stack([np.repeat(self.light.reshape(-1, 1)[pixels], 3, 1)] * 2)
        through = self.passes.reshape(-1)[pixels]
        passing = np.stack([through, through, np.where(through < 1.0, 5.0, 0.0)], axis=1)
        return seen, np.stack([passing, passing]).astype(np.float32)

    def rows(self, tolerance=TOLERANCE, only=slice(None)):
        rows, columns = self.shape
        azimuth = np.broadcast_to(self.spacing * np.arange(columns), self.shape)
        directions = unit_vectors(np.full(self.shape, 1.5), azimuth)
        numbers = np.arange(rows * columns).reshape(self.shape)[only].ravel()
        given = directions[only], np.full(self.shape, self.size)[only]
        clear = np.ones((*self.shape, 3), np.float32)[only]
        return see_rows(lambda at: self.see(numbers[at]), *given, clear, tolerance, Workers(1))


def smooth():
    across = np.linspace(0.0, 1.0, 64)
    return np.tile(1.0 + across, (4, 1)), np.tile(0.5 - 0.4 * across, (4, 1))


def test_every_other_pixel_of_what_is_smooth_is_the_mean_of_its_neighbours():
    picture = Picture(*smooth())
    seen, passing = picture.rows()
    assert picture.asked < 0.6 * picture.light.size
    whole, through = picture.see(np.arange(picture.light.size))
    np.testing.assert_allclose(seen, whole, rtol=2e-3)
    np.testing.assert_allclose(passing, through, rtol=2e-3)


def test_pixels_beside_an_edge_are_seen():
    light, passes = smooth()
    light[:, 31:] = 9.0
    picture = Picture(light, passes)
    seen, _ = picture.rows()
    found = seen[0, :, 0].reshape(light.shape)
    np.testing.assert_array_equal(found[:, 28:35], picture.light[:, 28:35])


def test_pixels_whose_neighbours_are_far_apart_are_seen():
    picture = Picture(*smooth(), spacing=2.0 * SIZE)
    picture.rows()
    assert picture.asked == picture.light.size


def test_coarse_pixels_are_all_seen():
    picture = Picture(*smooth(), size=0.01)
    picture.rows()
    assert picture.asked == picture.light.size


def test_no_tolerance_means_that_all_are_seen():
    picture = Picture(*smooth())
    picture.rows(tolerance=0.0)
    assert picture.asked == picture.light.size


def test_distances_are_those_of_the_clouds_alone():
    light, passes = smooth()
    passes[:] = np.where(np.arange(64) < 32, 1.0, 0.98)
    _, passing = Picture(light, passes).rows()
    assert set(np.unique(passing[..., 2])) == {0.0, 5.0}


@pytest.mark.parametrize("columns", [1, 2, 3, 8])
def test_narrow_pictures_are_complete(columns):
    light = np.random.default_rng(1).random((3, columns))
    picture = Picture(light, 0.5 * light)
    seen, _ = picture.rows(tolerance=1e-6)
    np.testing.assert_array_equal(seen[0, :, 0].reshape(light.shape), light.astype(np.float32))


def test_rows_do_not_depend_on_others():
    light, passes = smooth()
    light[1] += np.random.default_rng(2).random(64)
    picture = Picture(light, passes)
    whole, _ = picture.rows()
    part, _ = picture.rows(only=slice(2, 3))
    np.testing.assert_array_equal(whole.reshape(2, 4, 64, 3)[:, 2], part.reshape(2, 64, 3))
