"""A white planet under an even sky sends back all that it gets."""

import functools
import math

import numpy as np
import pytest

from skybake.optics.phase import eval_phase, scattering_angles
from skybake.scattering.atmosphere import build_atmosphere
from skybake.scattering.ray import trace_rays
from tests.kernels import distance_to_entry, fill_sun_column, fill_transmittance
from tests.media import RADIUS, cosine_to_sun, plain_medium
from tests.truth import henyey_greenstein

DEPTHS = np.array([0.1, 1.0])
SCALE_HEIGHT = 8.0


def furnace(phase):
    medium = plain_medium(lambda h: np.exp(-h / SCALE_HEIGHT), DEPTHS / SCALE_HEIGHT, ground=1.0)
    table = phase(scattering_angles())
    return medium._replace(phase=np.repeat(table[None, :, None], DEPTHS.size, axis=2).copy())


PHASES = {
    "isotropic": lambda theta: np.full_like(theta, 0.25 / math.pi),
    "forward": lambda theta: henyey_greenstein(theta, 0.75),
}


@functools.cache
def air_of(phase, method):
    return build_atmosphere(furnace(PHASES[phase]), method)


def suns():
    """Zenith cosines, azimuths and solid angles of suns all over the sphere."""
    x, weight = np.polynomial.legendre.leggauss(12)
    edges = np.radians([-90.0, -25.0, -8.0, -2.0, 0.0, 2.0, 8.0, 30.0, 90.0])
    low, span = edges[:-1, None], np.diff(edges)[:, None]
    elevation = (low + 0.5 * span * (x + 1.0)).ravel()
    share = (0.5 * span * weight).ravel() * np.cos(elevation)
    azimuths = 48
    azimuth = math.pi * (np.arange(azimuths) + 0.5) / azimuths
    elevation, azimuth = np.meshgrid(elevation, azimuth, indexing="ij")
    solid_angle = np.repeat(share[:, None] * 2.0 * math.pi / azimuths, azimuths, axis=1)
    return np.sin(elevation).ravel(), azimuth.ravel(), solid_angle.ravel()


def radiance_under_even_light(air, h, mu):
    """Radiance seen along a ray if 1 W m^-2 sr^-1 falls on the air from everywhere."""
    mu_s, azimuth, solid_angle = suns()
    r = RADIUS + h
    nu = cosine_to_sun(mu, mu_s, azimuth)
    same = np.full(mu_s.shape, r), np.full(mu_s.shape, mu)
    light = trace_rays(air, *same, mu_s, nu)
    scattered = (light.single * eval_phase(air.scaled.phase, nu)).sum(axis=1) + light.diffuse
    through = np.zeros(DEPTHS.size)
    if distance_to_entry(r, mu, RADIUS) == math.inf:
        column = np.empty(1)
        fill_sun_column(air.columns, RADIUS, air.medium.r_top, r, mu, column)
        fill_transmittance(air.medium.extinction, column, through)
    return (solid_angle @ scattered)[: DEPTHS.size] + through


def test_suns_fill_the_sphere():
    assert suns()[2].sum() == pytest.approx(4.0 * math.pi, rel=1e-12)


@pytest.mark.parametrize("h", [1e-6, 5.0, 60.0])
@pytest.mark.parametrize("mu", [1.0, 0.3, -0.1, -0.9])
@pytest.mark.parametrize("phase", [pytest.param("isotropic", marks=pytest.mark.slow), "forward"])
def test_white_furnace_is_even_within_one_percent(phase, mu, h):
    radiance = radiance_under_even_light(air_of(phase, "full"), h, mu)
    np.testing.assert_allclose(radiance, 1.0, atol=0.01)
