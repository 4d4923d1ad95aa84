import numpy as np
import pytest

from skybake.optics.phase import scattering_angles
from skybake.reference.air import air_at
from skybake.reference.directions import (
    angle_node,
    draw_lobe,
    phase_and_lobe,
    scattering_at,
    uniform,
)
from skybake.reference.guide import draw_guided, guided_density, make_guide
from skybake.reference.rays import shell_of
from tests.truth import truth_medium

SUN = (np.cos(0.1), 0.0, -np.sin(0.1))
UP = (0.0, 0.6, 0.8)
DRAWS = 40_000


def test_random_numbers_are_those_of_splitmix64():
    state = np.array([1234567], dtype=np.uint64)
    draws = [uniform(state) for _ in range(3)]
    # The generator's published outputs for this seed.
    published = [6457827717110365317, 3203168211198807973, 9817491932198370423]
    assert draws == [(value >> 11) * 2.0**-53 for value in published]


@pytest.mark.parametrize("index", [0, 1, 17, 511, 512, 513, 1000, 1024])
def test_every_tabulated_angle_is_found_at_its_own_node(index):
    theta = scattering_angles()[index]
    direction = (np.cos(theta), np.sin(theta), 0.0)
    assert angle_node(1024, (1.0, 0.0, 0.0), direction) == pytest.approx(index, abs=1e-3)


def test_drawn_directions_have_the_density_that_is_stated_for_them():
    # If so, the mean of f / density is the integral of f for any f.
    air = air_at(truth_medium("MARS_A"), 2)
    each = np.empty(2)
    total = scattering_at(air, shell_of(air.altitude, 3.0), 3.0, each)
    state = np.array([7], dtype=np.uint64)
    drawn = np.array([draw_lobe(air, each, total, UP, state) for _ in range(DRAWS)])
    density = np.array([phase_and_lobe(air, each, total, UP, tuple(d))[1] for d in drawn])
    ratio = (drawn @ np.array(UP)) ** 2 / density
    error = ratio.std() / np.sqrt(DRAWS)
    assert error < 0.03 * 4 * np.pi / 3
    assert abs(ratio.mean() - 4 * np.pi / 3) < 3 * error


def test_guided_directions_have_the_density_that_is_stated_for_them():
    guide = make_guide(air_at(truth_medium("EARTH_A"), 1))
    mu_s = float(np.dot(UP, SUN))
    state = np.array([11], dtype=np.uint64)
    drawn = [draw_guided(guide, 8.0, mu_s, UP, SUN, state) for _ in range(DRAWS)]
    density = np.array([guided_density(guide, 8.0, mu_s, UP, SUN, d) for d in drawn])
    for weight, integral in ((1.0, 4 * np.pi), (np.array(drawn)[:, 0] ** 2, 4 * np.pi / 3)):
        ratio = weight / density
        error = ratio.std() / np.sqrt(DRAWS)
        assert error < 0.02 * integral
        assert abs(ratio.mean() - integral) < 3 * error
