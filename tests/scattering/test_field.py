import math

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import sph_harm_y

from skybake.optics.delta_m import keep_unscaled
from skybake.scattering.grid import empty_field, sun_angles
from skybake.scattering.harmonics import build_harmonics, fill_harmonics
from tests.kernels import fast_acos, log_twilight, sun_weights
from tests.media import plain_medium

ANGLES = sun_angles(math.radians(118.0))
FIELD = empty_field(keep_unscaled(plain_medium()), np.array([0.0, 100.0]), ANGLES, 0)


@numba.njit
def arc_cosines(x):
    out = np.empty_like(x)
    for i in range(x.size):
        out[i] = fast_acos(x[i])
    return out


def test_arc_cosine_is_right_within_3e_8_rad():
    x = np.concatenate([np.linspace(-1.0, 1.0, 400_001), 1.0 - np.geomspace(1e-16, 1e-3, 999)])
    assert np.abs(arc_cosines(x) - np.arccos(x)).max() < 3e-8


def test_sun_angles_are_denser_than_a_degree_about_the_horizon():
    assert ANGLES[0] == 0.0
    assert ANGLES[-1] == pytest.approx(math.radians(118.0))
    step = np.degrees(np.diff(ANGLES))
    assert (step > 0.0).all()
    middle = np.degrees(0.5 * (ANGLES[1:] + ANGLES[:-1]))
    assert step[(middle > 89.0) & (middle < 104.0)].max() < 1.0
    assert step.max() < 10.5


@given(st.floats(-1.0, 1.0))
def test_sun_weights_restore_every_cubic_times_the_decline_of_twilight(mu_s):
    weights = np.empty(4)
    j = sun_weights(FIELD, mu_s, weights)
    angle = min(math.acos(mu_s), ANGLES[-1])
    decline = np.exp([log_twilight(node) - log_twilight(angle) for node in ANGLES[j : j + 4]])
    for power in range(4):
        got = weights @ (decline * ANGLES[j : j + 4] ** power)
        assert got == pytest.approx(angle**power, rel=2e-6, abs=2e-6)


def test_twilight_is_taken_to_fall_from_the_horizon_on_and_ever_steeper_then_straight():
    angles = np.radians(np.linspace(0.0, 120.0, 2401))
    log = np.array([log_twilight(angle) for angle in angles])
    assert (log[angles <= math.pi / 2.0] == 0.0).all()
    slope = np.diff(log)
    assert (slope <= 1e-12).all()
    assert (np.diff(slope) <= 1e-9).all()
    # A magnitude a degree, within a half, is what skies lose (Patat et al. 2006).
    per_degree = -slope[-1] / 0.05 * 2.5 / math.log(10.0)
    assert 0.7 < per_degree < 1.6


@pytest.mark.parametrize("last", [118.0, 150.0, 180.0])
def test_no_node_is_magnified_where_the_nodes_of_night_are_far_apart(last):
    """Else light doubles with every scattering on a planet whose night is not that dark."""
    angles = sun_angles(math.radians(last))
    field = empty_field(keep_unscaled(plain_medium()), np.array([0.0, 100.0]), angles, 0)
    weights = np.empty(4)
    for angle in np.linspace(0.0, math.radians(last), 2001):
        sun_weights(field, math.cos(angle), weights)
        assert np.abs(weights).sum() < 2.0


@given(st.floats(-0.45, 1.0))
def test_sun_lies_between_the_middle_two_of_its_four_nodes(mu_s):
    weights = np.empty(4)
    j = sun_weights(FIELD, mu_s, weights)
    first = ANGLES[0] if j == 0 else ANGLES[j + 1]
    last = ANGLES[-1] if j + 4 == ANGLES.size else ANGLES[j + 2]
    assert first - 1e-7 <= math.acos(mu_s) <= last + 1e-7


@pytest.mark.parametrize("mu", [-1.0, -0.3, 0.0, 0.5, 0.999, 1.0])
def test_harmonics_are_those_of_scipy(mu):
    """The even real ones: sqrt(2) times the complex ones' for m > 0, with the phase taken out."""
    order = 10
    harmonics = build_harmonics(order)
    out = np.empty(harmonics.degree.size)
    fill_harmonics(harmonics, mu, out)
    expected = [
        (-1) ** m * math.sqrt(2.0 if m else 1.0) * sph_harm_y(degree, m, math.acos(mu), 0.0).real
        for degree in range(order + 1)
        for m in range(degree + 1)
    ]
    np.testing.assert_allclose(out, expected, atol=1e-12)
