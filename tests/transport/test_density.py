import math

import numba
import numpy as np
import pytest
from scipy.integrate import quad

from tests.kernels import distance_to_exit, fill_column, fill_density
from tests.media import RADIUS, TOP, plain_medium

SCALE_HEIGHTS = (1.2, 8.0, 11.1)


def exponential(scale_height):
    return plain_medium(lambda h: np.exp(-h / scale_height))


@numba.njit
def densities(density, r_bottom, r_top, altitudes):
    out = np.empty((altitudes.size, density.shape[1]))
    for i in range(altitudes.size):
        fill_density(density, r_bottom, r_top, altitudes[i], out[i])
    return out


def column(medium, h, mu, steps=64):
    scratch, out = np.empty(1), np.empty(1)
    r = medium.r_bottom + h
    fill_column(medium, r, mu, distance_to_exit(r, mu, medium.r_top), steps, scratch, out)
    return out[0]


@pytest.mark.parametrize("scale_height", SCALE_HEIGHTS)
def test_density_of_an_exponential_is_right_within_3e_5_of_the_ground_value(scale_height):
    altitudes = np.linspace(0.0, 100.0, 20011)
    got = densities(exponential(scale_height).density, RADIUS, TOP, altitudes)[:, 0]
    np.testing.assert_allclose(got, np.exp(-altitudes / scale_height), rtol=0.0, atol=3e-5)


def test_density_is_held_beyond_both_ends():
    medium = plain_medium(lambda h: 2.0 - h / 100.0)
    got = densities(medium.density, RADIUS, TOP, np.array([-1e-9, -5.0, 100.0 + 1e-9, 1e6]))[:, 0]
    np.testing.assert_allclose(got, [2.0, 2.0, 1.0, 1.0], rtol=1e-12)


@pytest.mark.parametrize("scale_height", SCALE_HEIGHTS)
@pytest.mark.parametrize("h", [0.0, 5.0, 40.0])
def test_vertical_column_is_scale_height_times_one_less_exponential(scale_height, h):
    expected = scale_height * (math.exp(-h / scale_height) - math.exp(-100.0 / scale_height))
    tolerance = {"rel": 2e-4, "abs": 1e-12}
    assert column(exponential(scale_height), h, 1.0) == pytest.approx(expected, **tolerance)


@pytest.mark.parametrize("scale_height", SCALE_HEIGHTS)
@pytest.mark.parametrize("mu", [0.0, 0.01, 0.1, 0.5])
@pytest.mark.parametrize("h", [0.0, 10.0])
def test_slant_column_matches_adaptive_quadrature(scale_height, mu, h):
    r = RADIUS + h

    def density(t):
        # r(t) - RADIUS without cancellation.
        rise = t * (t + 2.0 * r * mu)
        return math.exp(-(h + rise / (r + math.sqrt(r * r + rise))) / scale_height)

    length = distance_to_exit(r, mu, TOP)
    breaks = [length * x for x in (0.02, 0.1, 0.3, 0.6)]
    expected, _ = quad(density, 0.0, length, points=breaks, epsabs=0.0, epsrel=1e-10, limit=400)
    assert column(exponential(scale_height), h, mu) == pytest.approx(expected, rel=3e-4)


def test_horizontal_column_is_chapmans_within_one_per_mille():
    """Chapman (1931) for large x = r / H: column = H * sqrt(pi x / 2) * (1 + 3 / (8 x))."""
    x = RADIUS / 8.0
    chapman = 8.0 * math.sqrt(0.5 * math.pi * x) * (1.0 + 3.0 / (8.0 * x))
    assert column(exponential(8.0), 0.0, 0.0) == pytest.approx(chapman, rel=1e-3)


def test_error_of_a_column_falls_with_the_fourth_power_of_the_step():
    medium = exponential(8.0)
    fine = column(medium, 0.0, 0.05, steps=512)
    errors = [abs(column(medium, 0.0, 0.05, steps=n) - fine) for n in (8, 16)]
    assert errors[0] / errors[1] > 10.0
