"""Light scattered once, by tables: where the planet's shadow lies, and that fans change nothing."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.scattering.atmosphere import dark_atmosphere
from skybake.scattering.ray import trace_rays
from skybake.transport.shells import altitude_shells
from tests.kernels import ray_limits
from tests.media import RADIUS, cosine_to_sun, plain_medium
from tests.truth import truth_medium


class Air:
    def __init__(self, medium, *shells):
        self.medium = medium
        dark = dark_atmosphere(medium, "hillaire")
        self.dark = dark._replace(shells=altitude_shells(medium, *shells))

    def single(self, r, mu, mu_s, nu):
        rays = (np.atleast_1d(x).astype(float) for x in np.broadcast_arrays(r, mu, mu_s, nu))
        return trace_rays(self.dark, *rays).single[..., : self.medium.ground_albedo.size]


THIN = Air(plain_medium(extinction=1e-9))
EARTH = Air(truth_medium("EARTH_A"))


@given(
    st.one_of(st.floats(0.0, 100.0), st.floats(100.0, 1e5)),
    st.floats(-1.0, 1.0),
    st.floats(-0.6, 0.3),
    st.floats(0.0, math.pi),
)
def test_thin_air_scatters_along_all_of_a_ray_but_its_shadow(h, mu, mu_s, azimuth):
    r = RADIUS + h
    nu = cosine_to_sun(mu, mu_s, azimuth)
    first, last, _ = ray_limits(THIN.medium, r, mu)
    t = first + (last - first) * (np.arange(20_000) + 0.5) / 20_000
    along = r * mu_s + t * nu
    off_axis_squared = r * r + t * (t + 2.0 * r * mu) - along**2
    is_dark = (along < 0.0) & (off_axis_squared < RADIUS**2)
    lit_length = THIN.single(r, mu, mu_s, nu)[0, 0, 0] / 1e-9
    expected = (last - first) * (1.0 - is_dark.mean())
    assert lit_length == pytest.approx(expected, rel=1e-5, abs=2e-4 * (last - first) + 1e-6)


def test_rays_of_one_fan_are_as_they_are_alone():
    mu_s = math.sin(math.radians(-3.0))
    azimuth = np.linspace(0.0, math.pi, 9)
    nu = cosine_to_sun(0.1, mu_s, azimuth)
    together = EARTH.single(RADIUS + 1.0, 0.1, mu_s, nu)
    alone = [EARTH.single(RADIUS + 1.0, 0.1, mu_s, one)[0] for one in nu]
    np.testing.assert_array_equal(together, alone)


@pytest.mark.parametrize("h", [1e-8, 1e-3, 10.0, 1e4])
@pytest.mark.parametrize("mu_s", [-1.0, 1.0])
def test_a_sun_in_the_nadir_or_zenith_gives_numbers(h, mu_s):
    mu = np.linspace(-1.0, 1.0, 2001)
    light = EARTH.single(RADIUS + h, mu, mu_s, mu * mu_s)
    assert np.isfinite(light).all()
    if mu_s < 0.0 and h < 100.0:
        assert (light == 0.0).all()


def test_long_steps_are_cut_at_the_shadow_nearly_as_well_as_short_ones():
    """Density falls to a third within a step of the coarser air."""
    coarse, fine = Air(truth_medium("EARTH_A"), 17), Air(truth_medium("EARTH_A"), 193)
    mu, azimuth = (x.ravel() for x in np.meshgrid([0.05, 0.2, 0.6, 1.0], np.linspace(0, 3, 7)))
    mu_s = math.sin(math.radians(-9.0))
    rays = RADIUS, mu, mu_s, cosine_to_sun(mu, mu_s, azimuth)
    light, expected = (air.single(*rays).sum(axis=1) for air in (coarse, fine))
    error = (light - expected) / np.maximum(expected, 0.01 * expected.max(axis=0))
    assert math.sqrt((error**2).mean()) < 0.04
