"""Radiances against tables by an unbiased path tracer (see data/reference/README.md)."""

import math

import numpy as np
import pytest

from tests.comparison import radiance_at
from tests.skies import first_order, truth_skylight
from tests.truth import load_truth

TABLES = {name: load_truth(name) for name in ("EARTH_A", "EARTH_HAZE", "MARS_A")}


def cases(first, last, names=tuple(TABLES)):
    """Names, altitudes and sun elevations of the tables within a range of elevations."""
    return sorted(
        {
            (name, row["altitude_km"], row["sun_elevation_deg"])
            for name in names
            for row in TABLES[name]
            if first <= row["sun_elevation_deg"] <= last
        }
    )


def rows_of(name, altitude, elevation):
    table = TABLES[name]
    return table[(table["altitude_km"] == altitude) & (table["sun_elevation_deg"] == elevation)]


def relative_rms(sky, rows):
    """Root mean square error, less what the tables' own noise adds to it."""
    rows = rows[
        (rows["radiance"] > 1e-3 * rows["radiance"].max())
        & (rows["stderr"] < 0.05 * rows["radiance"])
    ]
    assert len(rows) > 30
    error = radiance_at(sky, rows) / rows["radiance"] - 1.0
    noise = rows["stderr"] / rows["radiance"]
    return math.sqrt(max(0.0, np.mean(error**2 - noise**2)))


@pytest.mark.parametrize(("name", "altitude", "elevation"), cases(5, 90))
def test_daylight_of_all_orders_is_right_within_half_a_percent(name, altitude, elevation):
    rows = rows_of(name, altitude, elevation)
    assert relative_rms(truth_skylight(name, elevation, altitude), rows) < 0.005


@pytest.mark.parametrize(("name", "altitude", "elevation"), cases(-6, 4))
def test_twilight_of_all_orders_is_right_within_two_percent(name, altitude, elevation):
    rows = rows_of(name, altitude, elevation)
    assert relative_rms(truth_skylight(name, elevation, altitude), rows) < 0.02


@pytest.mark.parametrize(("name", "altitude", "elevation"), cases(-12, -9))
def test_deep_twilight_is_right_within_the_reach_of_its_noise(name, altitude, elevation):
    """Standard errors of 2 to 5 % per row, shared between rows, leave no sharper figure."""
    rows = rows_of(name, altitude, elevation)
    assert relative_rms(truth_skylight(name, elevation, altitude), rows) < 0.08


@pytest.mark.parametrize(("name", "altitude", "elevation"), cases(-6, 90))
def test_single_rows_lie_within_their_errors_and_a_percent(name, altitude, elevation):
    """Three standard errors, a quarter more in twilight as the tables' note says."""
    rows = rows_of(name, altitude, elevation)
    rows = rows[rows["radiance"] > 1e-3 * rows["radiance"].max()]
    error = radiance_at(truth_skylight(name, elevation, altitude), rows) - rows["radiance"]
    allowed = 3.75 * rows["stderr"] + 0.01 * rows["radiance"]
    assert np.mean(np.abs(error) < allowed) > 0.97


@pytest.mark.parametrize(("name", "altitude", "elevation"), cases(-6, 90))
def test_single_scattering_is_right_within_two_per_mille(name, altitude, elevation):
    """Deterministic in the tables, where quadrature leaves 1e-4; single rows within 3."""
    rows = rows_of(name, altitude, elevation)
    rows = rows[rows["order1"] > 1e-3 * rows["order1"].max()]
    sky = first_order(truth_skylight(name, elevation, altitude, "hillaire"))
    error = radiance_at(sky, rows) / rows["order1"] - 1.0
    assert math.sqrt(np.mean(error**2)) < 0.002
    assert np.abs(error).max() < 0.003


@pytest.mark.parametrize(
    ("name", "altitude", "elevation"),
    [case for case in cases(5, 90, ["EARTH_A"]) if case[1] < 1.0],
)
def test_hillaires_closure_is_within_8_percent_by_day_on_the_ground(name, altitude, elevation):
    rows = rows_of(name, altitude, elevation)
    assert relative_rms(truth_skylight(name, elevation, altitude, "hillaire"), rows) < 0.08
