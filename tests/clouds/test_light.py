"""What is looked up between the voxels of a layer's light."""

import math

import numpy as np
import pytest

from skybake.clouds.light import LayerLight, fill_blend, fill_corners, sun_depth, sun_share
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
        brightness=np.ones((1, 1)),
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


@pytest.mark.parametrize("share", [0.0, 0.25, 0.9])
def test_brightness_between_two_suns_is_their_geometric_mean(share):
    low, high = np.array([1e-3, 2.0]), np.array([0.4, 1.0])
    light = light_with([1.0, 1.0])._replace(
        brightness=np.array([low, high]), irradiance=np.array([low, high])[:, None]
    )
    blend = np.empty((4, 2))
    fill_blend(light, share, blend)
    expected = low ** (1.0 - share) * high**share
    np.testing.assert_allclose(blend[0] * low + blend[1] * high, expected, rtol=1e-12)
    np.testing.assert_allclose(blend[2] * low + blend[3] * high, expected, rtol=1e-12)


def test_light_between_a_dark_and_a_bright_sun_is_finite():
    light = light_with([1.0, 1.0])._replace(
        brightness=np.array([[0.0], [1.0]]), irradiance=np.array([[[0.0]], [[1.0]]])
    )
    blend = np.empty((4, 1))
    for share in (0.0, 1e-9, 0.5, 1.0 - 1e-9):
        fill_blend(light, share, blend)
        assert np.all((blend >= 0.0) & (blend <= 1e5))
        assert 0.0 <= blend[1, 0] <= 1.0
