"""What is looked up between the voxels of a layer's light."""

import math

import numpy as np
import pytest

from skybake.clouds.light import LayerLight, fill_corners, sun_depth, sun_share
from skybake.clouds.particles import TERMS


def light_with(beam):
    """Two columns side by side, whose voxels the sun reaches with these shares of its beam."""
    return LayerLight(
        beam=np.array(beam, np.float32).reshape(1, 1, 1, 2),
        moments=np.zeros((1, 1, 1, 2, 1), np.uint16),
        spacing=np.array([1.0, 1.0, 1.0]),
        base=0.0,
        sun_mu=np.array([0.5]),
        irradiance=np.ones((1, 1, 1)),
        order=0,
        fraction=0.0,
        scatter=np.ones(1),
        truncated=np.ones((9, 1)),
        peak=np.zeros((9, 1, TERMS)),
    )


def beam_at(light, x):
    corner, weight = np.empty((8, 3), np.int64), np.empty(8)
    fill_corners(light, x, 0.5, 0.5, corner, weight)
    return math.exp(-sun_depth(light, sun_share(light, 0.5), corner, weight))


def test_the_edge_of_a_shadow_lets_through_the_mean_of_both_sides():
    light = light_with([0.8, 1e-9])
    places = np.linspace(0.5, 1.5, 101)
    beams = np.array([beam_at(light, x) for x in places])
    assert np.trapezoid(beams, places) == pytest.approx(0.4, rel=1e-3)


def test_full_shadow_has_a_finite_depth():
    assert 0.0 <= beam_at(light_with([0.0, 0.0]), 1.0) < 1e-20
