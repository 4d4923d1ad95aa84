"""Diffuse light that forward peaks scatter across the horizon."""

import numpy as np
import pytest

from skybake.scattering.horizon_peaks import LAST_SINE, no_horizon_peaks
from skybake.sky.observer import Observer
from skybake.sky.skylight import Skylight
from tests.comparison import radiance_at, rows_at
from tests.skies import truth_atmosphere, view_cosines, white_source
from tests.truth import load_truth

GROUND = 0.001
SUN = 30.0


def skylight(atmosphere, altitude, elevation=SUN):
    return Skylight(atmosphere, Observer(altitude), (white_source(elevation),))


def errors(atmosphere, altitude, zenith=0.0):
    """Relative errors of light from that zenith angle down, and their noise."""
    rows = rows_at(load_truth("horizon_MARS_MIE"), altitude, SUN)
    rows = rows[rows["view_zenith_deg"] >= zenith]
    assert len(rows) >= 18
    error = radiance_at(skylight(atmosphere, altitude), rows) / rows["radiance"] - 1.0
    return error, rows["stderr"] / rows["radiance"]


def without(atmosphere):
    return atmosphere._replace(horizon_peaks=no_horizon_peaks(atmosphere.scaled))


def test_the_dusty_horizon_is_right_within_half_a_percent():
    error, noise = errors(truth_atmosphere("MARS_MIE"), GROUND)
    assert np.sqrt(np.mean(error**2 - noise**2)) < 0.005
    assert (np.abs(error) - 3.0 * noise).max() < 0.005


def test_the_dusty_limb_is_right_within_half_a_percent():
    error, noise = errors(truth_atmosphere("MARS_MIE"), 400.0)
    assert np.sqrt(np.mean(error**2 - noise**2)) < 0.005
    assert (np.abs(error) - 3.0 * noise).max() < 0.006
    assert abs(error.mean()) < 0.005


def test_peaks_that_do_not_see_the_ground_leave_the_horizon_too_bright():
    error, _ = errors(without(truth_atmosphere("MARS_MIE")), GROUND, zenith=89.0)
    assert error.mean() > 0.015


def test_peaks_too_weak_to_matter_are_left_alone():
    assert truth_atmosphere("EARTH_HAZE").horizon_peaks.source.shape[2] == 0
    assert truth_atmosphere("MARS_MIE").horizon_peaks.source.shape[2] > 0


@pytest.mark.parametrize("elevation", [30.0, 0.0, -6.0])
def test_the_difference_ends_without_an_edge(elevation):
    """Where lines of sight leave the last elevation, and on the way there from 10 deg."""
    dust = truth_atmosphere("MARS_MIE")
    height = np.linspace(0.0, 60.0, 241)[1:]
    cosines = view_cosines(90.0 - height, np.full(height.size, 20.0), elevation)
    source = white_source(elevation)
    light, straight = (
        skylight(each, GROUND, elevation).radiance_per_irradiance(source, *cosines)
        for each in (dust, without(dust))
    )
    change = light / straight - 1.0
    assert (change[np.sin(np.radians(height)) > LAST_SINE] == 0.0).all()
    kinks = np.diff(change[height > 10.0], n=2, axis=0)
    assert np.abs(kinks).max() < 1e-4
