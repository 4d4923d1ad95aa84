"""The sun's beam and diffuse light among voxels: sums that hold exactly."""

import math

import numpy as np
import pytest

from skybake.clouds.beam import fill_beam
from skybake.clouds.diffuse import LARGE, solve_diffuse
from skybake.clouds.harmonics import degrees, harmonics_of
from skybake.clouds.particles import divide_phase
from skybake.clouds.quadrature import double_gauss
from skybake.clouds.transfer import Entering, Scattering, Voxels
from skybake.jit.workers import Workers
from tests.reference.cloud_scenes import DROPLETS

SPACING = np.array([0.05, 0.1, 0.1])


def toward(elevation, azimuth=0.7):
    flat = math.cos(elevation)
    return np.array([flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)])


def broken_clouds(seed=0, shape=(12, 16, 16)):
    """Voxels of which some are empty and some are dense. [km^-1]"""
    random = np.random.default_rng(seed)
    values = 40.0 * random.random(shape) ** 3
    values[random.random(shape) < 0.5] = 0.0
    return values.astype(np.float32)


def beam_through(extinction, sun, spacing=SPACING):
    mean = np.empty_like(extinction)
    leaving, ray, met = np.empty((3, *extinction.shape[1:]), np.float32)
    fill_beam(extinction, spacing, *sun, ray, met, mean, leaving)
    return mean, leaving


def solve(extinction, sun, order, entering, spacing=SPACING):
    """Diffuse light of voxels, whose particles' phase function is that of droplets."""
    particles = divide_phase(DROPLETS, DROPLETS[:, 0], order)
    kept = extinction * np.float32(1.0 - particles.fraction)
    mean, leaving = beam_through(kept, sun, spacing)
    quadrature = double_gauss(order, 0.0)
    voxels = Voxels(kept, spacing, mean, float(leaving.mean()))
    scattering = Scattering(order, quadrature, particles.moments, sun)
    return solve_diffuse(voxels, scattering, entering(quadrature), Workers(1)), voxels


def flux_up(diffuse):
    """Irradiance by the first channel's light at the top."""
    for order in (2, 3, 4, 5, 7):
        quadrature = double_gauss(order, 0.0)
        if len(diffuse.up) == len(quadrature.weight) // 2:
            return quadrature.flux(diffuse.up)[0]
    raise AssertionError(diffuse.up.shape)


def no_air(none):
    nothing = np.zeros((1, 2, 2, none.shape[1]))
    return nothing, nothing


def in_the_sun(levels):
    def entering(quadrature):
        none = np.zeros((1, len(quadrature.weight) // 2))
        sun = np.ones((1, levels))
        return Entering(sun, none, none, none, np.zeros(1), np.zeros(1), np.ones(1), *no_air(none))

    return entering


def over_white_ground(levels):
    """Sky of radiance 1 over a ground that returns all light."""

    def entering(quadrature):
        ones = np.ones((1, len(quadrature.weight) // 2))
        dark = np.zeros((1, levels))
        none = 0.0 * ones
        full = np.array([math.pi])
        return Entering(dark, ones, ones, none, full, np.zeros(1), np.ones(1), *no_air(none))

    return entering


@pytest.mark.parametrize("order", [2, 3, 4, 5, 7])
def test_sums_of_products_of_harmonics_are_legendre_polynomials(order):
    random = np.random.default_rng(1)
    a, b = random.normal(size=(2, 50, 3))
    a, b = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in (a, b))
    products = harmonics_of(a, order) * harmonics_of(b, order)
    cosine = (a * b).sum(axis=1)
    for degree in range(order + 1):
        expected = np.polynomial.Legendre.basis(degree)(cosine)
        got = products[:, degrees(order) == degree].sum(axis=1)
        np.testing.assert_allclose(got, expected, atol=1e-12)


@pytest.mark.parametrize("order", [2, 3, 4, 5, 7])
def test_directions_integrate_harmonics_and_fluxes_exactly(order):
    quadrature = double_gauss(order, 0.4)
    harmonics = harmonics_of(quadrature.direction, order)
    whole = quadrature.weight @ harmonics
    np.testing.assert_allclose(whole, 4.0 * math.pi * (np.arange(whole.size) == 0), atol=1e-12)
    # The flux of radiance z**n is 2 pi / (n + 2), in each hemisphere.
    for hemisphere in (quadrature.downward, quadrature.upward):
        slope = np.abs(quadrature.direction[hemisphere, 2])
        for power in range(order // 2 * 2 + 1):
            flux = float(quadrature.flux(slope**power))
            assert flux == pytest.approx(2.0 * math.pi / (power + 2.0), rel=1e-12)


@pytest.mark.parametrize("elevation", [90.0, 37.0, 3.0, -3.0, -40.0])
def test_the_beam_loses_what_voxels_scatter(elevation):
    sun = toward(math.radians(elevation))
    extinction = broken_clouds()
    mean, leaving = beam_through(extinction, sun)
    scattered = (extinction * mean).sum(dtype=float) * SPACING[0]
    lost = abs(sun[2]) * (1.0 - leaving.astype(float)).sum()
    assert scattered == pytest.approx(lost, rel=1e-5)
    assert 0.05 < lost / (abs(sun[2]) * leaving.size) <= 1.0


def test_a_low_beam_keeps_the_edge_of_a_shadow():
    """Less than two voxels wide after forty voxels, at 3 deg."""
    levels = 42
    spacing = np.array([0.1 * math.tan(math.radians(3.0)), 0.1, 0.1])
    extinction = np.zeros((levels, 8, 160), np.float32)
    extinction[-1, :, 60:80] = 1e4
    sun = toward(math.radians(3.0), 0.0)
    mean, _ = beam_through(extinction, sun, spacing)
    row = mean[levels - 1 - 40, 4].astype(float)
    assert row.min() < 0.01
    assert row.max() > 0.99
    width = np.sum((row > 0.05) & (row < 0.95)) / 2.0
    assert width < 2.0


@pytest.mark.parametrize("order", [2, 3, 7])
@pytest.mark.parametrize("elevation", [60.0, 10.0])
def test_what_enters_broken_clouds_leaves_them(order, elevation):
    sun = toward(math.radians(elevation))
    extinction = broken_clouds()
    diffuse, voxels = solve(extinction, sun, order, in_the_sun(len(extinction)))
    out = flux_up(diffuse) + diffuse.down[0] + sun[2] * voxels.leaving
    assert out == pytest.approx(sun[2], rel=1e-3)


def test_many_voxels_keep_as_much_light_as_few():
    """They begin with merged voxels, and are iterated until late scatterings have left as well."""
    sun = toward(math.radians(40.0))
    extinction = np.zeros((16, 80, 80), np.float32)
    extinction[2:14, 10:60, 10:60] = 80.0
    diffuse, voxels = solve(extinction, sun, 2, in_the_sun(len(extinction)))
    assert extinction.size >= LARGE
    out = flux_up(diffuse) + diffuse.down[0] + sun[2] * voxels.leaving
    assert out == pytest.approx(sun[2], rel=1e-3)


@pytest.mark.parametrize("order", [2, 3, 4, 5, 7])
def test_clouds_in_a_white_furnace_are_invisible(order):
    extinction = broken_clouds(3)
    sun = toward(0.5)
    diffuse, _ = solve(extinction, sun, order, over_white_ground(len(extinction)))
    # Radiance is 1 wherever there are particles and where there are none.
    moments = diffuse.moments[0]
    np.testing.assert_allclose(moments[:, :, 0], 4.0 * math.pi, rtol=2e-3)
    np.testing.assert_allclose(moments[:, :, 1:], 0.0, atol=2e-2)
    assert flux_up(diffuse) == pytest.approx(math.pi, rel=1e-3)
    assert diffuse.down[0] == pytest.approx(math.pi, rel=1e-3)


def test_a_tile_repeated_is_the_tile():
    extinction, sun = broken_clouds(1), toward(0.4)
    once, _ = solve(extinction, sun, 2, in_the_sun(len(extinction)))
    twice, _ = solve(np.tile(extinction, (1, 1, 2)), sun, 2, in_the_sun(len(extinction)))
    repeated = np.tile(once.moments, (1, 1, 1, 1, 2))
    np.testing.assert_allclose(twice.moments, repeated, atol=3e-5 * once.moments.max())


@pytest.mark.parametrize("bearing", [0.0, 90.0, 215.0])
def test_light_turns_with_the_sun(bearing):
    """Decks have no sides."""
    deck = np.full((40, 1, 1), 4.0, np.float32)
    spacing = np.array([0.025, 1.0, 1.0])
    fluxes = [
        flux_up(solve(deck, toward(0.6, math.radians(each)), 3, in_the_sun(40), spacing)[0])
        for each in (10.0, 10.0 + bearing)
    ]
    assert fluxes[1] == pytest.approx(fluxes[0], rel=5e-3)
