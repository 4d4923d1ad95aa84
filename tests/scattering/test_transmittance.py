import functools
import math

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.scattering.transmittance import build_columns
from tests.kernels import (
    altitude_mu_from_unit,
    distance_to_exit,
    fill_density,
    fill_sun_column,
    fill_transmittance,
    unit_from_altitude_mu,
)
from tests.truth import load_irradiance_truth, truth_medium

NAMES = ("EARTH_A", "EARTH_HAZE", "MARS_A")
units = st.floats(0.0, 1.0)

media = functools.cache(truth_medium)


@functools.cache
def table(name):
    return build_columns(media(name))


def transmittance(name, r, mu_s):
    medium = media(name)
    column, out = np.empty(medium.extinction.shape[0]), np.empty(3)
    if not fill_sun_column(table(name), medium.r_bottom, medium.r_top, r, mu_s, column):
        return np.zeros(3)
    fill_transmittance(medium.extinction, column, out)
    return out


@numba.njit
def densities(density, r_bottom, r_top, altitudes):
    out = np.empty((altitudes.size, density.shape[1]))
    for i in range(altitudes.size):
        fill_density(density, r_bottom, r_top, altitudes[i], out[i])
    return out


def transmittance_by_quadrature(medium, r, mu, points=20_000):
    """Midpoints, crowded where the ray is closest to the planet."""
    length = distance_to_exit(r, mu, medium.r_top)
    lowest = min(max(-r * mu, 0.0), length)
    edge = np.linspace(0.0, 1.0, points + 1) ** 2
    t = np.concatenate([lowest * (1.0 - edge[::-1]), lowest + (length - lowest) * edge[1:]])
    middle, step = 0.5 * (t[1:] + t[:-1]), np.diff(t)
    h = np.sqrt(r * r + middle * (middle + 2.0 * r * mu)) - medium.r_bottom
    column = step @ densities(medium.density, medium.r_bottom, medium.r_top, h)
    return np.exp(-column @ medium.extinction)


@given(units, units)
def test_unit_square_maps_to_the_air_and_back(x_altitude, x_mu):
    h, mu = altitude_mu_from_unit(6360.0, 6460.0, x_altitude, x_mu)
    assert 0.0 <= h <= 100.0
    assert 0.0 <= mu <= 1.0
    back = unit_from_altitude_mu(6360.0, 6460.0, h, mu)
    # A square below 1e-308 has no root.
    assert back == pytest.approx((x_altitude, x_mu), rel=1e-9, abs=1e-150)


@given(st.floats(-10.0, 200.0), st.floats(-1.0, 2.0))
def test_places_outside_the_air_map_to_its_edge(h, mu):
    unit = unit_from_altitude_mu(6360.0, 6460.0, h, mu)
    assert all(0.0 <= x <= 1.0 for x in unit)


@pytest.mark.parametrize("name", NAMES)
def test_transmittance_is_right_within_a_per_mille_of_full_sun(name):
    medium = media(name)
    random = np.random.default_rng(1)
    worst = 0.0
    for _ in range(300):
        r = medium.r_bottom + (medium.r_top - medium.r_bottom) * random.random() ** 2
        horizon = -math.sqrt(1.0 - (medium.r_bottom / r) ** 2)
        mu = horizon + (1.0 - horizon) * random.random() ** 3
        got = transmittance(name, r, mu)
        worst = max(worst, np.abs(got - transmittance_by_quadrature(medium, r, mu)).max())
    assert worst < 1e-3


@pytest.mark.parametrize("name", ["EARTH_A", "MARS_A"])
def test_transmittance_matches_the_reference_where_more_than_a_thousandth_arrives(name):
    rows = load_irradiance_truth(name)
    rows = rows[(rows["sun_direct_transmittance"] > 1e-3) & (rows["altitude_km"] <= 100.0)]
    assert len(rows) >= 12
    medium = media(name)
    for row in rows:
        mu_s = math.sin(math.radians(row["sun_elevation_deg"]))
        got = transmittance(name, medium.r_bottom + row["altitude_km"], mu_s)
        band = [680, 550, 440].index(row["wavelength_nm"])
        assert got[band] == pytest.approx(row["sun_direct_transmittance"], rel=3e-3, abs=1e-3)


@pytest.mark.parametrize("name", NAMES)
@given(units, st.floats(-1.0, 1.0))
def test_transmittance_lies_between_nothing_and_all(name, x, mu_s):
    medium = media(name)
    got = transmittance(name, medium.r_bottom + x * (medium.r_top - medium.r_bottom), mu_s)
    assert ((got >= 0.0) & (got <= 1.0)).all()


@given(units, st.floats(-1.0, 0.0))
def test_the_sun_is_hidden_exactly_below_the_horizon(x, mu_s):
    medium = media("EARTH_A")
    r = medium.r_bottom + 1e-8 + x * 99.0
    horizon = -math.sqrt((1.0 - medium.r_bottom / r) * (1.0 + medium.r_bottom / r))
    if abs(mu_s - horizon) < 1e-9:
        return
    column = np.empty(3)
    seen = fill_sun_column(table("EARTH_A"), medium.r_bottom, medium.r_top, r, mu_s, column)
    assert seen == (mu_s > horizon)
    assert seen or (column == 0.0).all()


@pytest.mark.parametrize("name", NAMES)
def test_light_is_continuous_where_the_sun_passes_the_horizontal(name):
    medium = media(name)
    for h in (0.001, 1.0, 10.0, 60.0):
        above, below = (transmittance(name, medium.r_bottom + h, mu) for mu in (1e-9, -1e-9))
        np.testing.assert_allclose(above, below, rtol=1e-3)


def test_a_higher_sun_and_a_higher_observer_see_more_light():
    medium = media("EARTH_A")
    elevations = np.sin(np.radians([0.0, 0.5, 1.0, 2.0, 5.0, 20.0, 90.0]))
    by_sun = np.array([transmittance("EARTH_A", medium.r_bottom, mu) for mu in elevations])
    assert (np.diff(by_sun, axis=0) > 0.0).all()
    altitudes = [0.0, 0.5, 2.0, 10.0, 40.0, 99.0]
    by_altitude = np.array([transmittance("EARTH_A", medium.r_bottom + h, 0.3) for h in altitudes])
    assert (np.diff(by_altitude, axis=0) > 0.0).all()
