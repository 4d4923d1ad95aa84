import math

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import sph_harm_y

from skybake.optics.delta_m import keep_unscaled
from skybake.scattering.field import twilight_scale
from skybake.scattering.grid import build_grid, empty_field, sun_angles
from skybake.scattering.harmonics import build_harmonics, fill_harmonics
from tests.kernels import fast_acos, log_twilight, sun_weights
from tests.media import RADIUS, plain_medium

ANGLES = sun_angles(math.radians(118.0))
FIELD = empty_field(keep_unscaled(plain_medium()), np.array([0.0, 100.0]), ANGLES, 0)


def air_of_dip(dip):
    """Medium at the top of which the horizon dips by so many degrees."""
    return plain_medium(thickness=RADIUS / math.cos(math.radians(dip)) - RADIUS)


def field_of_dip(dip):
    scaled = keep_unscaled(air_of_dip(dip))
    return empty_field(scaled, np.array([0.0, 100.0]), build_grid(scaled).sun_angle, 0)


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


@pytest.mark.parametrize("field", [FIELD, field_of_dip(0.3)], ids=["ordinary", "shallow"])
@given(mu_s=st.floats(-1.0, 1.0))
def test_sun_weights_restore_every_cubic_times_the_decline_of_twilight(field, mu_s):
    """Every line in the steep twilight of shallow air."""
    weights, angles = np.empty(4), field.sun_angle
    j = sun_weights(field, mu_s, weights)
    angle = min(fast_acos(mu_s), angles[-1])
    log = [log_twilight(each, field.twilight) for each in (*angles[j : j + 4], angle)]
    decline = np.exp(np.array(log[:4]) - log[4])
    for power in range(4 if angle <= field.steep_from else 2):
        got = weights @ (decline * angles[j : j + 4] ** power)
        assert got == pytest.approx(angle**power, rel=2e-6, abs=2e-6)


def test_twilight_is_taken_to_fall_from_the_horizon_on_and_ever_steeper_then_straight():
    angles = np.radians(np.linspace(0.0, 120.0, 2401))
    log = np.array([log_twilight(angle, 1.0) for angle in angles])
    assert (log[angles <= math.pi / 2.0] == 0.0).all()
    slope = np.diff(log)
    assert (slope <= 1e-12).all()
    assert (np.diff(slope) <= 1e-9).all()
    # A magnitude a degree, within a half, is what skies lose (Patat et al. 2006).
    per_degree = -slope[-1] / 0.05 * 2.5 / math.log(10.0)
    assert 0.7 < per_degree < 1.6


@pytest.mark.parametrize("dip", [6.0, 2.0, 0.1])
def test_twilight_and_its_nodes_are_shorter_in_shallow_air(dip):
    medium = air_of_dip(dip)
    angles = build_grid(keep_unscaled(medium)).sun_angle
    assert twilight_scale(medium) == pytest.approx(min(1.0, dip / 5.0))
    step, middle = np.degrees(np.diff(angles)), np.degrees(0.5 * (angles[1:] + angles[:-1]))
    dusk = (middle > 90.0 - 0.1 * dip) & (middle < 90.0 + 2.5 * dip)
    assert step[dusk].max() < 0.2 * dip
    assert (step[1:] < 2.0 * step[:-1]).all()
    assert (step[:-1] < 2.0 * step[1:]).all()
    assert angles[-1] == pytest.approx(math.radians(118.0))


@pytest.mark.parametrize("last", [118.0, 150.0, 180.0])
def test_no_node_is_magnified_where_the_nodes_of_night_are_far_apart(last):
    """Else light doubles with every scattering on a planet whose night is not that dark."""
    angles = sun_angles(math.radians(last))
    field = empty_field(keep_unscaled(plain_medium()), np.array([0.0, 100.0]), angles, 0)
    assert greatest_weights(field) < 2.0


def test_no_node_is_magnified_in_shallow_air_either():
    assert greatest_weights(field_of_dip(0.3)) < 2.0


def test_no_weight_is_negative_where_the_twilight_of_shallow_air_can_end_within_a_node():
    field, weights = field_of_dip(0.3), np.empty(4)
    begin = math.pi / 2.0 + math.radians(0.16)
    for angle in np.linspace(begin, field.sun_angle[-1], 2001):
        sun_weights(field, math.cos(angle), weights)
        assert weights.min() >= 0.0


def greatest_weights(field):
    """Largest sum of the sizes of the weights of four nodes."""
    weights, sums = np.empty(4), []
    for angle in np.linspace(0.0, field.sun_angle[-1], 2001):
        sun_weights(field, math.cos(angle), weights)
        sums.append(np.abs(weights).sum())
    return max(sums)


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
