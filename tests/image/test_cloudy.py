"""Pixels with clouds do not depend on which others they are made with."""

import math

import numpy as np

from skybake.colour.space import COLOUR_SPACES
from skybake.image.cloudy import CloudsOver
from skybake.jit.workers import Workers


class BlurredClouds:
    """Clouds that hide as much as what they leave out is large."""

    horizon, layers, alike, workers = math.radians(90.0), [None], 0.0, Workers(1)

    def see(self, directions, pixel):
        seen = np.zeros((1, len(directions), 3), np.float32)
        return seen, np.full_like(seen, 1.0 - pixel)

    def put_into(self, total, zenith, bearing, seen, passing):
        return total, 1.0 - passing[0, :, 0]


def test_details_that_are_left_out_are_those_of_each_pixel():
    clouds = CloudsOver(BlurredClouds(), None, 0.0, COLOUR_SPACES["lin_rec709"], 1.0)
    footprint = np.geomspace(1e-3, 4e-3, 12).reshape(4, 3)
    zenith, azimuth = np.full((4, 3), 0.5), np.zeros((4, 3))
    pixels = np.ones((4, 3, 3), np.float32)
    whole = clouds.apart(pixels, zenith, azimuth, footprint)[1]
    for row in range(4):
        band = slice(row, row + 1)
        part = clouds.apart(pixels[band], zenith[band], azimuth[band], footprint[band])[1]
        assert (part == whole[band]).all()
    np.testing.assert_allclose(whole, 0.5 * footprint, rtol=0.03)
