"""Sources that fill the sky, against suns one by one and against what they must be."""

import math

import numpy as np
import pytest

from skybake.preset import load_preset
from skybake.sky.disc import Disc
from skybake.sky.extended import STEPS, ExtendedSky
from skybake.sky.sky import Sky

THETA = np.linspace(0.0, 0.5 * math.pi, STEPS)
VIEWS = np.radians([0.0, 30.0, 60.0, 75.0, 85.0, 89.5])

SHAPES = {
    "uniform": np.ones_like,
    "airglow": lambda z: 1.0 / np.sqrt(1.0 - (6371.0 / 6461.0 * np.sin(z)) ** 2),
    "overhead": lambda z: np.cos(z) ** 2,
}


def seen(sky, shape, zenith):
    """Light of a source, straight and scattered, at zenith angles."""
    extended, mu = ExtendedSky(sky.skylight.atmosphere, sky.skylight.radius), np.cos(zenith)
    light = extended.scattered(mu, shape(THETA))
    above = np.where(zenith <= 0.5 * math.pi, shape(np.minimum(zenith, 0.5 * math.pi)), 0.0)
    return light + extended.passing(mu) * above[:, None]


@pytest.fixture(scope="module")
def responses():
    """Mean light around the zenith by suns at Gauss nodes of the zenith angle."""
    node, weight = np.polynomial.legendre.leggauss(24)
    suns = 0.25 * math.pi * (node + 1.0)
    azimuth = math.pi * (np.arange(24) + 0.5) / 24
    light = []
    for zenith in suns:
        sky = Sky("earth", 0.5 * math.pi - zenith)
        mu = np.cos(VIEWS)[:, None] * np.ones(24)
        nu = mu * math.cos(zenith) + np.sin(VIEWS)[:, None] * math.sin(zenith) * np.cos(azimuth)
        light.append(sky.radiance_per_irradiance(mu, nu).mean(axis=1))
    return suns, 0.25 * math.pi * weight, np.array(light)


@pytest.mark.parametrize("name", SHAPES)
def test_a_source_is_the_sum_of_its_suns(responses, name):
    suns, weight, light = responses
    shape, sky = SHAPES[name], Sky("earth", 0.5)
    straight = Disc(sky.skylight, sky.source).transmittance(VIEWS) * shape(VIEWS)[:, None]
    ring = 2.0 * math.pi * np.sin(suns) * weight * shape(suns)
    expected = np.einsum("s,svk->vk", ring, light) + straight
    np.testing.assert_allclose(seen(sky, shape, VIEWS), expected, rtol=0.01)


def test_in_a_white_furnace_everything_is_white():
    # Air that absorbs nothing over a white ground.
    white = {"constituents.ozone": "none", "constituents.aerosol": "none", "ground.albedo": 1.0}
    world, few = load_preset("earth-clear", white), [450.0, 550.0, 650.0]
    sky = Sky(world, 0.5, altitude=2.0, wavelengths=few)
    everywhere = np.radians([0.0, 45.0, 80.0, 89.0, 92.0, 120.0, 180.0])
    np.testing.assert_allclose(seen(sky, np.ones_like, everywhere), 1.0, atol=0.012)


def test_without_a_source_there_is_no_light():
    sky = Sky("earth", 0.5)
    assert (seen(sky, np.zeros_like, VIEWS) == 0.0).all()
