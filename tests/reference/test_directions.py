import numpy as np
import pytest

from skybake.jit.kernel import kernel
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


@kernel
def draw_lobes(air, each, total, axis, state, directions, densities):
    """Draw many directions, with the density of each."""
    for i in range(len(densities)):
        direction = draw_lobe(air, each, total, axis, state)
        _, densities[i] = phase_and_lobe(air, each, total, axis, direction)
        for j in range(3):
            directions[i, j] = direction[j]


@kernel
def draw_guided_ones(guide, h, mu_s, up, sun, state, directions, densities):
    """Draw many directions by the guide, with the density of each."""
    for i in range(len(densities)):
        direction = draw_guided(guide, h, mu_s, up, sun, state)
        densities[i] = guided_density(guide, h, mu_s, up, sun, direction)
        for j in range(3):
            directions[i, j] = direction[j]


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
    drawn, density = np.empty((DRAWS, 3)), np.empty(DRAWS)
    draw_lobes(air, each, total, UP, state, drawn, density)
    ratio = (drawn @ np.array(UP)) ** 2 / density
    error = ratio.std() / np.sqrt(DRAWS)
    assert error < 0.03 * 4 * np.pi / 3
    assert abs(ratio.mean() - 4 * np.pi / 3) < 3 * error


def test_guided_directions_have_the_density_that_is_stated_for_them():
    guide = make_guide(air_at(truth_medium("EARTH_A"), 1))
    mu_s = float(np.dot(UP, SUN))
    state = np.array([11], dtype=np.uint64)
    drawn, density = np.empty((DRAWS, 3)), np.empty(DRAWS)
    draw_guided_ones(guide, 8.0, mu_s, UP, SUN, state, drawn, density)
    for weight, integral in ((1.0, 4 * np.pi), (drawn[:, 0] ** 2, 4 * np.pi / 3)):
        ratio = weight / density
        error = ratio.std() / np.sqrt(DRAWS)
        assert error < 0.02 * integral
        assert abs(ratio.mean() - integral) < 3 * error
