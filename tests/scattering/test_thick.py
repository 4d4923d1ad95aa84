"""Air so thick that light is scattered tens of times, with nothing lost on the way."""

import math

import numpy as np
import pytest

from skybake.optics.phase import scattering_angles
from skybake.reference.estimate import irradiance
from skybake.scattering.atmosphere import dark_atmosphere
from skybake.scattering.solver import solve_light
from tests.kernels import fill_ground_irradiance
from tests.media import plain_medium
from tests.truth import henyey_greenstein

ELEVATION = math.asin(0.9)


def thick_medium(optical_depth):
    """Forward-scattering air over black ground."""
    medium = plain_medium(lambda h: np.exp(-h / 8.0), optical_depth / 8.0)
    phase = henyey_greenstein(scattering_angles(), 0.75)
    return medium._replace(phase=phase[None, :, None].copy())


@pytest.mark.parametrize(
    ("optical_depth", "tolerance"),
    [(3.0, 0.01), pytest.param(10.0, 0.02, marks=pytest.mark.slow)],
)
def test_light_that_reaches_the_ground_is_that_of_paths(optical_depth, tolerance):
    medium = thick_medium(optical_depth)
    dark = dark_atmosphere(medium, "full")
    sky = np.empty(dark.scaled.medium.ground_albedo.size)
    field = solve_light(dark).field
    fill_ground_irradiance(field, 0.9, np.empty(4), sky)
    # What is truncated counts as sunlight there: only both together can be compared.
    direct = 0.9 * math.exp(-(1.0 - dark.scaled.fraction[0, 0]) * optical_depth / 0.9)
    paths = irradiance(medium, 0.0, ELEVATION, samples=40_000)
    expected = paths.down[0] + paths.direct[0]
    noise = paths.down_stderr[0]
    assert noise < 0.02 * expected
    assert abs(sky[0] + direct - expected) < tolerance * expected + 3.0 * noise


@pytest.mark.slow
def test_depth_30_lets_as_much_light_through_as_diffusion():
    """Eddington's approximation with delta scaling (Joseph et al. 1976), good to some percent."""
    dark = dark_atmosphere(thick_medium(30.0), "full")
    sky = np.empty(dark.scaled.medium.ground_albedo.size)
    field = solve_light(dark).field
    fill_ground_irradiance(field, 0.9, np.empty(4), sky)
    transmitted = (2.0 / 3.0 + 0.9) / (4.0 / 3.0 + (1.0 - 0.75) * 30.0)
    assert sky[0] == pytest.approx(0.9 * transmitted, rel=0.05)
