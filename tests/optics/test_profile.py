import numpy as np
import pytest

from skybake.optics.profile import eval_profile
from skybake.preset import ExponentialProfile, Gas, TabulatedProfile, TentProfile, load_preset


def test_an_exponential_is_one_at_the_ground_and_falls_by_e_over_its_scale_height():
    density = eval_profile(ExponentialProfile(8.0), np.array([0.0, 8.0, 100.0]))
    np.testing.assert_allclose(density, [1.0, np.exp(-1.0), np.exp(-12.5)], rtol=1e-15)


def test_a_tent_peaks_at_its_centre_and_ends_at_its_half_width():
    density = eval_profile(TentProfile(25.0, 15.0), np.array([0.0, 10.0, 17.5, 25.0, 40.0, 50.0]))
    np.testing.assert_allclose(density, [0.0, 0.0, 0.5, 1.0, 0.0, 0.0], atol=1e-15)


def test_a_table_is_exact_at_its_nodes_and_geometric_between_positive_ones():
    profile = TabulatedProfile((0.0, 2.0, 4.0, 6.0), (4.0, 1.0, 0.5, 0.0))
    nodes = eval_profile(profile, np.array([0.0, 2.0, 4.0, 6.0]))
    np.testing.assert_allclose(nodes, profile.density, rtol=1e-14)
    between = eval_profile(profile, np.array([1.0, 3.0]))
    np.testing.assert_allclose(between, [2.0, np.sqrt(0.5)], rtol=1e-14)


def test_a_table_falls_linearly_to_zero_and_stays_there():
    profile = TabulatedProfile((1.0, 2.0, 4.0), (0.0, 1.0, 0.0))
    density = eval_profile(profile, np.array([0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0]))
    np.testing.assert_allclose(density, [0.0, 0.0, 0.5, 1.0, 0.5, 0.0, 0.0], rtol=1e-15)


def test_air_of_the_us_standard_atmosphere_has_a_column_of_8_46_km_of_surface_air():
    # 2.155e29 molecules over a square metre at 101325 Pa against 2.547e25 in a cubic metre.
    air = load_preset("earth").constituents[0]
    assert isinstance(air, Gas)
    altitude = np.linspace(0.0, 100.0, 20001)
    column = np.trapezoid(eval_profile(air.profile, altitude), altitude)
    assert column == pytest.approx(8.46, rel=2e-3)
