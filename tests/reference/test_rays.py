import math

import numpy as np
import pytest

from skybake.optics.medium import ALTITUDE_NODES, Medium
from skybake.optics.phase import SCATTERING_ANGLES
from skybake.reference.air import Air, air_at
from skybake.reference.rays import new_cuts, place_at_depth, trace, transmittance_to_space
from tests.truth import truth_medium

R, TOP, EXTINCTION = 6360.0, 100.0, 2e-3


@pytest.fixture(scope="module")
def uniform_air() -> Air:
    return air_at(
        Medium(
            r_bottom=R,
            r_top=R + TOP,
            density=np.ones((ALTITUDE_NODES, 1)),
            scattering=np.array([[EXTINCTION]]),
            extinction=np.array([[EXTINCTION]]),
            phase=np.full((1, SCATTERING_ANGLES, 1), 0.25 / np.pi),
            ground_albedo=np.array([0.0]),
        ),
        0,
    )


def distance_to_top(h: float, mu: float) -> float:
    r = R + h
    return -r * mu + math.sqrt((R + TOP) ** 2 - r * r * (1.0 - mu * mu))


@pytest.mark.parametrize("h", [0.0, 0.001, 10.0, 99.9])
@pytest.mark.parametrize("zenith_deg", [0.0, 60.0, 89.0, 90.0])
def test_a_ray_through_uniform_air_is_dimmed_by_its_length(uniform_air, h, zenith_deg):
    mu = math.cos(math.radians(zenith_deg))
    expected = math.exp(-EXTINCTION * distance_to_top(h, mu))
    assert transmittance_to_space(uniform_air, h, mu) == pytest.approx(expected, rel=1e-8)


def test_a_ray_past_the_limb_is_dimmed_on_both_sides_of_its_lowest_point(uniform_air):
    h, mu = 50.0, -0.05
    assert (R + h) * math.sqrt(1 - mu * mu) > R
    expected = math.exp(-EXTINCTION * distance_to_top(h, mu))
    assert transmittance_to_space(uniform_air, h, mu) == pytest.approx(expected, rel=1e-8)


def test_no_light_passes_through_the_ground(uniform_air):
    assert transmittance_to_space(uniform_air, 1.0, -0.5) == 0.0


def test_a_ray_from_outside_enters_where_the_air_begins(uniform_air):
    cuts = new_cuts(uniform_air)
    ray = trace.py_func(uniform_air, 36_000.0, -1.0, cuts)
    assert ray.reaches_ground
    assert cuts.s[0] - ray.start == pytest.approx(35_900.0, rel=1e-12)
    assert cuts.depth[ray.segments] == pytest.approx(EXTINCTION * TOP, rel=1e-9)


@pytest.mark.parametrize("mu", [1.0, 0.0, -0.001, 0.3])
def test_the_place_at_an_optical_depth_lies_at_that_depth(mu):
    air = air_at(truth_medium("EARTH_A"), 2)
    cuts = new_cuts(air)
    ray = trace.py_func(air, 5.0, mu, cuts)
    for i in range(0, ray.segments, 50):
        step = cuts.depth[i + 1] - cuts.depth[i]
        ends = cuts.s[i], cuts.h[i], cuts.s[i + 1], cuts.h[i + 1]
        s = place_at_depth(air, ray.h_tangent, cuts.shell[i], *ends, 0.37 * step)
        h = math.hypot(R + ray.h_tangent, s) - R
        # A second, cruder integral up to that place.
        fine = np.linspace(cuts.s[i], s, 2001)
        altitude = np.hypot(R + ray.h_tangent, fine) - R
        extinction = np.interp(altitude, air.altitude, air.extinction)
        assert np.trapezoid(extinction, fine) == pytest.approx(0.37 * step, rel=1e-5)
        assert min(cuts.h[i], cuts.h[i + 1]) - 1e-9 <= h <= max(cuts.h[i], cuts.h[i + 1]) + 1e-9
