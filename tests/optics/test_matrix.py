"""Scattering matrices and their coefficients."""

import numpy as np
import pytest

from skybake.optics.matrix import (
    matrix_moments,
    rayleigh_matrix,
    scattering_plane,
    unpolarised_constituents,
)
from skybake.optics.medium import build_medium
from skybake.optics.phase import phase_rayleigh, scattering_angles
from skybake.optics.wigner import wigner
from skybake.preset import load_preset

GREEN = np.array([550.0])


def test_generalised_spherical_functions_are_orthogonal():
    mu, weight = np.polynomial.legendre.leggauss(24)
    for m in range(4):
        for spin in (-2, 0, 2):
            functions = wigner(m, spin, 8, mu)
            least = max(m, abs(spin))
            expected = np.diag([2.0 / (2 * n + 1) if n >= least else 0.0 for n in range(9)])
            np.testing.assert_allclose((functions * weight) @ functions.T, expected, atol=1e-13)


def test_a_molecule_has_coefficients_of_degree_2_alone():
    depolarisation = np.array([0.0, 0.03])
    share = (1.0 - depolarisation) / (1.0 + depolarisation / 2.0)
    phase = phase_rayleigh(np.cos(scattering_angles())[:, None], depolarisation)
    beta, same, opposite = matrix_moments(rayleigh_matrix(depolarisation)[None], phase[None], 6)[0]
    np.testing.assert_allclose(beta[2], -np.sqrt(6.0) / 10.0 * share, rtol=1e-4)
    np.testing.assert_allclose(same[2], 0.6 * share, rtol=1e-4)
    np.testing.assert_allclose(opposite, 0.0, atol=1e-4)
    np.testing.assert_allclose(beta[3:], 0.0, atol=1e-4)
    np.testing.assert_allclose(same[3:], 0.0, atol=1e-4)


def test_light_across_from_the_sun_is_polarised_as_depolarisation_leaves_it():
    phase = phase_rayleigh(np.cos(scattering_angles())[:, None], np.array([0.03]))
    side = scattering_angles().size // 2
    degree = -rayleigh_matrix(np.array([0.03]))[0, side] / phase[side]
    np.testing.assert_allclose(degree, (1.0 - 0.03) / (1.0 + 0.03), rtol=1e-12)


def test_a_sun_to_the_upper_left_is_between_both_reference_directions():
    """Looking at the horizon, at a sun that is 45 degrees to the left of straight up."""
    mu_s = np.array([np.sin(0.1)])
    left = np.tan(0.1)
    nu = np.sqrt(1.0 - mu_s**2 - left**2 * np.cos(0.1) ** 2)
    even, odd = scattering_plane(np.zeros(1), mu_s, nu).T
    np.testing.assert_allclose([even, odd], [[0.0], [1.0]], atol=1e-12)


@pytest.mark.parametrize("preset", ["earth", "earth-desert-dust", "titan", "venus-cloudtop"])
def test_no_constituent_is_polarised_more_than_wholly(preset):
    medium = build_medium(load_preset(preset), np.array([440.0, 550.0, 680.0]))
    p12, p22, p33 = medium.matrix.transpose(1, 0, 2, 3)
    whole = medium.phase * (1.0 + 1e-9)
    assert (p12**2 + p33**2 <= whole**2 * (1.0 + 2e-3)).all()
    assert (np.abs(p22) <= whole).all()


def test_aerosol_of_small_droplets_polarises_across_the_plane_and_dust_is_not_known():
    assert unpolarised_constituents(load_preset("earth")) == []
    assert unpolarised_constituents(load_preset("mars")) == ["dust"]
    assert unpolarised_constituents(load_preset("earth-hillaire2020")) == ["aerosol"]
    medium = build_medium(load_preset("earth"), GREEN)
    side = scattering_angles().size // 2
    degree = -medium.matrix[:, 0, side, 0] / medium.phase[:, side, 0]
    assert degree[0] > 0.9
    assert 0.0 < degree[2] < 0.6
