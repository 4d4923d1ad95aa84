"""The sun's beam while the sun passes the horizontal of a layer."""

import math

import numpy as np
import pytest

from skybake.clouds.beam import fill_beam
from skybake.clouds.curved_beam import fill_curved_beam

RADIUS = 6371.0
SPACING = np.array([0.1, 0.2, 0.2])


def broken_clouds():
    """Columns of several heights, from one base, with gaps between. [km^-1]"""
    random = np.random.default_rng(4)
    heights = random.integers(0, 9, (4, 4)).repeat(4, 0).repeat(4, 1)
    return np.where(np.arange(8)[:, None, None] < heights, np.float32(5.0), np.float32(0.0))


def haze(extinction):
    return np.full((8, 1, 1), extinction, np.float32)


def beam(extinction, elevation, azimuth=0.6):
    """Mean beam in voxels, and what reaches the air beneath and above."""
    flat = math.cos(elevation)
    sun = flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)
    mean = np.empty_like(extinction)
    beneath, above, ray, met = planes = np.empty((4, *extinction.shape[1:]), np.float32)
    fill_curved_beam(extinction, SPACING, RADIUS, *sun, ray, met, mean, planes[:2])
    return mean, beneath, above


def caught(extinction, elevation):
    """Sunlight that a layer scatters, by area of the ground."""
    mean, _, _ = beam(extinction, elevation)
    return float((extinction * mean).mean(axis=(1, 2)).sum()) * SPACING[0]


@pytest.mark.parametrize("elevation", [-12.0, -8.0, 8.0, 12.0, 40.0])
def test_curvature_does_not_matter_to_a_high_sun(elevation):
    extinction, sun = broken_clouds(), math.radians(elevation)
    mean, beneath, above = beam(extinction, sun)
    flat = np.empty_like(mean)
    out, ray, met = np.empty((3, *extinction.shape[1:]), np.float32)
    toward = math.cos(sun) * math.cos(0.6), math.cos(sun) * math.sin(0.6), math.sin(sun)
    fill_beam(extinction, SPACING, *toward, ray, met, flat, out)
    np.testing.assert_allclose(mean.mean(axis=(1, 2)), flat.mean(axis=(1, 2)), atol=0.01)
    assert beneath.mean() == pytest.approx(out.mean(), abs=0.005)
    assert above.mean() == (1.0 if sun > 0.0 else pytest.approx(out.mean(), abs=0.005))


@pytest.mark.parametrize("elevation", [0.0, 0.2, 1.0])
def test_a_beam_that_grazes_haze_has_come_a_finite_way(elevation):
    """Its length is that through a shell, and depths are means over voxels."""
    mu = math.sin(math.radians(elevation))
    mean, beneath, above = beam(haze(0.02), math.radians(elevation))
    depth = np.linspace(0.8, 0.0, 8001)[:-1] - 5e-5
    way = np.sqrt((RADIUS * mu) ** 2 + 2.0 * RADIUS * depth) - RADIUS * mu
    expected = np.exp(-0.02 * way).reshape(8, 1000).mean(axis=1)
    np.testing.assert_allclose(mean[:, 0, 0], expected, rtol=0.03)
    whole = math.sqrt((RADIUS * mu) ** 2 + 2.0 * RADIUS * 0.8) - RADIUS * mu
    assert beneath[0, 0] == pytest.approx(math.exp(-0.02 * whole), rel=1e-3)
    assert above[0, 0] == 1.0


def test_a_beam_from_below_has_come_from_the_base():
    mu = math.sin(math.radians(-1.5))
    mean, _, above = beam(haze(0.02), math.radians(-1.5))
    height = (np.arange(8000) + 0.5) * 1e-4
    way = -RADIUS * mu - np.sqrt((RADIUS * mu) ** 2 - 2.0 * RADIUS * height)
    expected = np.exp(-0.02 * way).reshape(8, 1000).mean(axis=1)
    np.testing.assert_allclose(mean[:, 0, 0], expected, rtol=0.01)
    assert above[0, 0] == pytest.approx(math.exp(-0.02 * way[-1]), rel=0.01)


def test_what_clouds_catch_does_not_step_as_the_sun_passes_the_horizontal():
    """A flat layer would be lit from its tops at once before, and from its bases at once after."""
    extinction = broken_clouds()
    elevations = np.radians(np.arange(-30, 31) * 0.05)
    light = np.array([caught(extinction, each) for each in elevations])
    steps = np.abs(np.diff(light))
    assert steps.max() < 0.1 * np.ptp(light)
    beneath = np.array([beam(extinction, each)[1].mean() for each in elevations])
    assert np.abs(np.diff(beneath)).max() < 0.01
