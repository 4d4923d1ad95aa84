"""Single scattering by quadrature and by tables, each the other's check."""

import functools
import math

import numpy as np
import pytest

from skybake.reference.single import trace_single
from skybake.scattering.ray import trace_rays
from skybake.sky import single
from skybake.sky.skylight import Skylight
from tests.media import cosine_to_sun
from tests.skies import first_order, truth_atmosphere, truth_skylight
from tests.truth import truth_medium

COARSE = {"steps": single.STEPS, "sun_steps": single.SUN_STEPS}
ELEVATIONS = [40.0, 3.0, -3.0, -5.0]


def rays(medium, h, elevation):
    """Starts and cosines of rays over the sphere, more of them near the horizon."""
    r = medium.r_bottom + h
    horizon = math.pi - math.asin(min(medium.r_bottom / r, 1.0))
    offset = np.radians([-80.0, -40.0, -10.0, -3.0, -0.5, 0.5, 3.0, 20.0, 70.0])
    zenith = np.clip(horizon + offset, 0.0, math.pi)
    zenith, azimuth = (x.ravel() for x in np.meshgrid(zenith, np.radians([0.0, 60.0, 180.0])))
    mu, mu_s = np.cos(zenith), np.full(zenith.shape, math.sin(math.radians(elevation)))
    return np.full(mu.shape, r), mu, mu_s, cosine_to_sun(mu, mu_s, azimuth)


@pytest.mark.parametrize("h", [0.001, 10.0, 400.0])
@pytest.mark.parametrize("elevation", ELEVATIONS)
@pytest.mark.parametrize("name", ["EARTH_A", "MARS_A"])
def test_quadrature_agrees_with_tables_at_the_first_order(name, elevation, h):
    arguments = rays(truth_medium(name), h, elevation)
    traced = trace_rays(truth_atmosphere(name, "hillaire"), *arguments).single[..., :3]
    light = trace_single(truth_medium(name), *arguments).single
    bright = traced > 1e-3 * traced.max(axis=0)
    assert np.abs(light[bright] / traced[bright] - 1.0).max() < 2e-3


@functools.cache
def finest(name, elevation, h):
    arguments = rays(truth_medium(name), h, elevation)
    return trace_single(truth_medium(name), *arguments, steps=1024, sun_steps=256).single


@pytest.mark.parametrize(
    ("elevation", "h"),
    [(40.0, 0.001), (-3.0, 0.001), (3.0, 10.0), (-5.0, 10.0), (3.0, 400.0), (-5.0, 400.0)],
)
@pytest.mark.parametrize("name", ["EARTH_A", "MARS_A"])
@pytest.mark.parametrize(
    ("steps", "tolerance"),
    [({}, 3e-4), (COARSE, 1e-3)],
)
def test_steps_are_as_fine_as_they_say(name, elevation, h, steps, tolerance):
    light = trace_single(truth_medium(name), *rays(truth_medium(name), h, elevation), **steps)
    finer = finest(name, elevation, h)
    bright = finer > 1e-3 * finer.max(axis=0)
    assert np.abs(light.single[bright] / finer[bright] - 1.0).max() < tolerance


@pytest.mark.parametrize("name", ["EARTH_A", "MARS_A"])
def test_sunlit_ground_is_the_traced_ground_without_skylight(name):
    arguments = rays(truth_medium(name), 10.0, 40.0)
    dark = first_order(truth_skylight(name, 40.0, 10.0, "hillaire"))
    traced = trace_rays(dark.atmosphere, *arguments).diffuse[:, :3]
    ground = trace_single(truth_medium(name), *arguments).ground
    assert (ground > 0.0).any()
    np.testing.assert_allclose(ground, traced, rtol=5e-4, atol=1e-9)


def test_a_skylight_by_quadrature_is_the_first_order_of_the_one_by_tables():
    quadrature = truth_skylight("MARS_A", 20.0, 0.0, "march")
    tables = first_order(truth_skylight("MARS_A", 20.0, 0.0, "hillaire"))
    assert type(tables) is Skylight
    _, mu, _, nu = rays(truth_medium("MARS_A"), 0.0, 20.0)
    light, expected = (
        each.radiance_per_irradiance(each.sources[0], mu, nu) for each in (quadrature, tables)
    )
    np.testing.assert_allclose(light, expected, rtol=2e-3)
