"""Nothing flickers: luminance and sunlight are smooth functions of the sun's elevation."""

import math

import numpy as np
import pytest

from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.sky.table import TWILIGHT_ELEVATION

ZENITH = np.radians([0.0, 30.0, 60.0, 75.0, 80.0, 85.0, 88.0, 89.0, 89.5, 89.8, 89.95, 91.0])
AZIMUTH = np.radians([0.0, 1.0, 5.0, 20.0, 60.0, 90.0, 135.0, 180.0])

VISIBLE = 0.002
"""Relative step that would be half a code value of an eight-bit display, at middle grey."""


def scenes(preset, elevations):
    planet = load_preset(preset)
    for elevation in elevations:
        yield Scene(planet, map_settings(sun_elevation=math.radians(elevation), units="nits"))


def sky_luminance(scene):
    """Luminance as maps have it, without the disc, shape (zenith, azimuth)."""
    return scene.evaluate(ZENITH[:, None], AZIMUTH[None], 1e-9) @ scene.luminance


def ray_luminance(scene):
    """The same, each direction integrated by itself."""
    mu = np.repeat(np.cos(ZENITH)[:, None], AZIMUTH.size, axis=1)
    sine = np.sqrt(1.0 - mu**2)
    nu = mu * math.cos(scene.sun_zenith) + sine * math.sin(scene.sun_zenith) * np.cos(AZIMUTH)
    radiance = scene.sky.radiance_per_irradiance(mu, np.clip(nu, -1.0, 1.0))
    return radiance @ scene.xyz_weights[:, 1]


def roughness(values):
    """By how much each second difference of the logarithm leaves the mean of its neighbours."""
    curvature = np.diff(np.log(values), 2, axis=0)
    return np.abs(curvature[1:-1] - 0.5 * (curvature[:-2] + curvature[2:]))


@pytest.mark.parametrize(
    ("preset", "middle"),
    [
        ("earth", math.degrees(TWILIGHT_ELEVATION)),  # where the sky gets another table
        ("earth", 0.0),
        ("earth", -4.0),
        ("earth", -9.0),
        ("mars", 0.0),
    ],
)
def test_no_direction_has_a_step(preset, middle):
    """A step of s between two suns would leave a roughness of 1.5 s; a smooth sky hardly any.

    The aureole that passes the horizon leaves 0.003 of suns 0.05 deg apart, and a quarter of that
    of these.
    """
    elevations = middle + 0.025 * np.arange(-6, 7)
    skies = np.array([sky_luminance(scene) for scene in scenes(preset, elevations)])
    assert (skies > 0.0).all()
    found = roughness(skies)
    assert found.max() < VISIBLE


@pytest.mark.parametrize(
    "preset",
    [
        pytest.param("earth", marks=pytest.mark.slow),
        pytest.param("mars", marks=pytest.mark.nightly),
    ],
)
def test_maps_follow_their_rays_through_a_whole_sunset(preset):
    """Second differences from frame to frame are those of the light itself."""
    elevations = np.arange(4.0, -10.01, -0.25)
    pairs = [(sky_luminance(one), ray_luminance(one)) for one in scenes(preset, elevations)]
    maps, rays = (np.log(np.array(skies)) for skies in zip(*pairs, strict=True))
    difference = np.diff(maps, 2, axis=0) - np.diff(rays, 2, axis=0)
    assert np.abs(difference).max() < VISIBLE
    assert np.sqrt((difference**2).mean()) < 0.1 * VISIBLE


@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_the_setting_sun_fades_without_a_step(preset):
    elevations = np.arange(0.4, -0.401, -0.02)
    xyz = np.array([scene.sun_xyz()[0] for scene in scenes(preset, elevations)])
    sun = xyz[:, 1]
    assert (np.diff(sun) <= 0.0).all()
    assert (sun[0] > 0.0, sun[-1]) == (True, 0.0)
    # A disc of half a degree that set at once would be a step of 1.
    assert np.abs(np.diff(sun, 2)).max() < 0.02 * sun[0]
    lit = xyz[sun > 1e-3 * sun[0]]
    chromaticity = lit[:, :2] / lit.sum(axis=1, keepdims=True)
    assert len(lit) > 25
    assert np.abs(np.diff(chromaticity, axis=0)).max() < 0.01
