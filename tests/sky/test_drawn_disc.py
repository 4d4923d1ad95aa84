"""Discs that are drawn in another size: the light of the true one, whatever the planet hides."""

import math

import numpy as np
import pytest

from skybake.preset import load_preset
from skybake.sky.disc import Disc
from skybake.sky.drawn_disc import SOFT_PEAK, DrawnDisc
from skybake.sky.sky import Sky


def discs(elevation, diameter, **options):
    sky = Sky(load_preset("earth"), math.radians(elevation), method="hillaire")
    radius = math.radians(0.5 * diameter)
    drawn = DrawnDisc(sky.skylight, sky.source, angular_radius=radius, **options)
    return Disc(sky.skylight, sky.source), drawn


def integral(disc, rings=400, spokes=720):
    """Irradiances by a disc's radiance, on a plane that faces it and on the horizontal."""
    ring = (np.arange(rings) + 0.5) / rings * disc.angular_radius
    spoke = 2.0 * math.pi * (np.arange(spokes) + 0.5) / spokes
    distance, around = (each.ravel() for each in np.meshgrid(ring, spoke, indexing="ij"))
    polar = disc.source.zenith
    cosine = np.cos(distance) * math.cos(polar) - np.sin(distance) * math.sin(polar) * np.cos(
        around
    )
    radiance = disc.radiance_per_irradiance(np.arccos(np.clip(cosine, -1.0, 1.0)), distance)
    size = disc.angular_radius / rings * 2.0 * math.pi / spokes * np.sin(distance)
    return size @ radiance, (size * np.maximum(cosine, 0.0)) @ radiance


@pytest.mark.parametrize("is_soft", [False, True])
@pytest.mark.parametrize("diameter", [0.2, 2.0, 15.0])
@pytest.mark.parametrize("elevation", [90.0, 60.0, 5.0, 0.3, 0.0])
def test_a_disc_of_any_size_shines_as_the_true_one(elevation, diameter, is_soft):
    true, drawn = discs(elevation, diameter, is_soft=is_soft)
    normal, horizontal = integral(drawn)
    np.testing.assert_allclose(normal, true.irradiance_per_irradiance()[0], rtol=5e-3)
    stated = drawn.irradiance_per_irradiance()
    np.testing.assert_allclose(stated[0], true.irradiance_per_irradiance()[0], rtol=1e-12)
    np.testing.assert_allclose(horizontal, stated[1], rtol=1e-2)


def test_a_soft_disc_fades_from_three_times_its_mean_to_nothing():
    _, drawn = discs(40.0, 2.0, is_soft=True)
    distance = drawn.angular_radius * np.array([0.0, 0.5, 0.999, 1.0, 1.5])
    radiance = drawn.bare_radiance(distance)[:, 0]
    mean = 1.0 / (math.pi * math.sin(drawn.angular_radius) ** 2)
    expected = SOFT_PEAK * mean * np.array([1.0, 0.5625, 3.996e-6, 0.0, 0.0])
    np.testing.assert_allclose(radiance, expected, rtol=1e-3, atol=1e-9 * mean)


def test_a_large_disc_whose_sun_has_set_is_dark():
    _, drawn = discs(-1.0, 15.0)
    zenith, distance = np.array([math.radians(88.0)]), np.array([math.radians(3.0)])
    assert (drawn.radiance_per_irradiance(zenith, distance) == 0.0).all()
    assert (drawn.irradiance_per_irradiance()[1] == 0.0).all()
