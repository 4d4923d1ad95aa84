"""The uncovered share of a limb-darkened disc, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipe, ellipk, elliprf, elliprj

from skybake.eclipse.share import (
    build_share_table,
    fill_share,
    powers_from_limb_darkening,
    uncovered_powers,
)

RATIOS = (0.3, 0.6, 0.93, 0.999, 1.001, 1.03, 1.08, 2.5)
SUN = np.array([[0.75, 0.35, 0.2], [0.1, 0.2, 0.15]])


def _separations(ratio):
    """Separations across all phases, away from where formulas have 0/0."""
    return np.linspace(0.0, 1.0 + ratio, 211)[1:-1] + 1.7e-5


def _covered_by_a_lens(z, k):
    """Area of the intersection of two circles over that of the sun's (Archimedes)."""
    if z >= 1.0 + k:
        return 0.0
    if z <= abs(1.0 - k):
        return min(1.0, k) ** 2
    first = math.acos((z * z + 1.0 - k * k) / (2.0 * z))
    second = math.acos((z * z + k * k - 1.0) / (2.0 * z * k))
    root = math.sqrt((1.0 + k - z) * (z + k - 1.0) * (z - k + 1.0) * (z + k + 1.0))
    return (first + k * k * second - 0.5 * root) / math.pi


def _third_kind(n, m):
    return elliprf(0.0, 1.0 - m, 1.0) + n / 3.0 * elliprj(0.0, 1.0 - m, 1.0, 1.0 - n)


def _covered_linear(z, k):
    """Light of a disc of radiance mu that is covered, over that of the whole.

    Mandel and Agol (2002, ApJ 580, L171), their lambda of table 1 for linear darkening.
    """
    if z >= 1.0 + k:
        return 0.0
    if k >= 1.0 and z <= k - 1.0:
        return 1.0
    a, b = (z - k) ** 2, (z + k) ** 2
    q = k * k - z * z
    if z < 1.0 - k:
        m = (b - a) / (1.0 - a)
        value = (1.0 - 5.0 * z * z + k * k + q * q) * ellipk(m)
        value += (1.0 - a) * (z * z + 7.0 * k * k - 4.0) * ellipe(m)
        value -= 3.0 * (k + z) / (k - z) * _third_kind(1.0 - b / a, m)
        covered = 2.0 / (9.0 * math.pi * math.sqrt(1.0 - a)) * value
    else:
        m = (1.0 - a) / (b - a)
        value = ((1.0 - b) * (2.0 * b + a - 3.0) - 3.0 * q * (b - 2.0)) * ellipk(m)
        value += (b - a) * (z * z + 7.0 * k * k - 4.0) * ellipe(m)
        value -= 3.0 * q / a * _third_kind((a - 1.0) / a, m)
        covered = 2.0 / (9.0 * math.pi * math.sqrt(b - a)) * value
    return 1.5 * covered + (1.0 if k > z else 0.0)


@pytest.mark.parametrize("ratio", RATIOS)
def test_a_uniform_disc_is_covered_as_two_circles_overlap(ratio):
    separation = _separations(ratio)
    uncovered = uncovered_powers(separation, ratio)[:, 0]
    exact = [1.0 - _covered_by_a_lens(z, ratio) for z in separation]
    np.testing.assert_allclose(uncovered, exact, atol=1e-7)


@pytest.mark.parametrize("ratio", RATIOS)
def test_a_linearly_darkened_disc_is_covered_as_elliptic_integrals_say(ratio):
    separation = _separations(ratio)
    uncovered = 1.5 * uncovered_powers(separation, ratio)[:, 1]
    exact = [1.0 - _covered_linear(z, ratio) for z in separation]
    np.testing.assert_allclose(uncovered, exact, atol=1e-6)


@pytest.mark.parametrize("ratio", [0.3, 0.93])
def test_a_quadratically_darkened_disc_around_a_whole_moon_keeps_its_polynomial(ratio):
    separation = np.linspace(0.0, 1.0 - ratio, 20)
    # The mean of r² over a disc of radius k at the distance z is z² + k²/2.
    exact = 0.5 - ratio**2 * (1.0 - separation**2 - 0.5 * ratio**2)
    np.testing.assert_allclose(uncovered_powers(separation, ratio)[:, 2], exact, atol=1e-8)


@pytest.mark.parametrize("between", [(0.9, 0.95), (0.99, 1.01), (1.02, 1.06), (0.2, 0.7)])
def test_the_table_is_within_a_thousandth_of_the_sun_light_of_the_closed_forms(between):
    table, powers = build_share_table(*between), powers_from_limb_darkening(SUN)
    out = np.empty(3)
    for ratio in np.linspace(*between, 7):
        for separation in np.linspace(0.0, 1.05 + ratio, 150):
            fill_share(table, powers, separation, ratio, out)
            exact = uncovered_powers(separation, ratio) @ powers
            np.testing.assert_allclose(out, exact, atol=2e-4)
