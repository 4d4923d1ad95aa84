"""Marching without tables and tracing with tables, each the other's oracle at order 1."""

import math

import numpy as np
import pytest

from skybake.scattering.ray import trace_rays
from skybake.transport.march import march_rays
from tests.media import cosine_to_sun
from tests.skies import truth_sky, without_diffuse_light
from tests.truth import truth_medium


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
@pytest.mark.parametrize(("elevation", "tolerance"), [(40.0, 2e-3), (3.0, 2e-3), (-3.0, 5e-3)])
@pytest.mark.parametrize("name", ["EARTH_A", "MARS_A"])
def test_marching_agrees_with_tables_at_the_first_order(name, elevation, tolerance, h):
    medium = truth_medium(name)
    sky = truth_sky(name, elevation, h, "hillaire")
    arguments = rays(medium, h, elevation)
    traced = trace_rays(*sky.atmosphere[:4], *arguments).single[..., :3]
    # Where the shadow begins is known to a step: grazing rays in twilight need short ones.
    view_steps = 1024 if elevation > 0.0 else 16384
    single, _ = march_rays(medium, *arguments, view_steps=view_steps, light_steps=256)
    bright = traced > 1e-3 * traced.max(axis=0)
    error = single[bright] / traced[bright] - 1.0
    assert np.abs(error).max() < tolerance


def test_marching_converges_with_the_square_of_the_step():
    """The planet's shadow leaves a kink that falls where it may, so by day."""
    arguments = rays(truth_medium("MARS_A"), 0.001, 40.0)
    fine, coarse, coarser = (
        march_rays(truth_medium("MARS_A"), *arguments, view_steps=n, light_steps=n)[0].sum()
        for n in (1024, 64, 32)
    )
    assert abs(coarser / fine - 1.0) > 3.0 * abs(coarse / fine - 1.0)


@pytest.mark.parametrize("name", ["EARTH_A", "MARS_A"])
def test_sunlit_ground_by_marching_is_the_traced_ground_without_skylight(name):
    medium = truth_medium(name)
    sky = without_diffuse_light(truth_sky(name, 40.0, 10.0, "hillaire"))
    arguments = rays(medium, 10.0, 40.0)
    traced = trace_rays(*sky.atmosphere[:4], *arguments).diffuse[:, :3]
    _, ground = march_rays(medium, *arguments, view_steps=1024)
    assert (ground > 0.0).any()
    np.testing.assert_allclose(ground, traced, rtol=2e-3, atol=1e-9)
