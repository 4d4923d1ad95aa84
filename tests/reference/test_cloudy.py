"""Paths through clouds against paths without, other programs' tables, and symmetry."""

import math

import numba
import numpy as np
import pytest

from skybake.cloud_fields.chart import cloud_place
from skybake.cloud_fields.field import extinction_at
from skybake.errors import InputError
from skybake.jit import workers
from skybake.reference import estimate
from skybake.reference.air import air_at
from skybake.reference.cloudy import radiance
from skybake.reference.majorants import air_bound, air_peaks, bound_clouds, cloud_bound
from skybake.reference.rays import node_value, shell_of
from tests.reference.cloud_scenes import (
    DROPLETS,
    air_at_550nm,
    cloud_table,
    cumulus,
    deck,
    linear_cumulus,
    preset_cumulus,
    vacuum,
    voxels,
)

RADIANCE = "radiance_per_unit_irradiance_sr-1"
EAST = math.radians(90.0)
SUN = math.radians(40.0)


def check_agrees(mean, stderr, truth, truth_stderr, worst):
    """Errors of many views are noise, which is at most `worst` of the median view's light."""
    off = (mean[:, 0] - truth) / np.hypot(stderr[:, 0], truth_stderr)
    assert np.median(stderr[:, 0] / truth) < worst
    assert np.all(np.abs(off) < 4.0), off
    assert np.sqrt(np.mean(off**2)) < 1.0 + 2.0 / math.sqrt(2.0 * len(off)), off


def check_clear(altitude, sun, samples):
    medium = air_at_550nm("EARTH_A", 0.3)
    zenith, azimuth = np.radians([10.0, 60.0, 85.0, 95.0, 130.0]), np.radians([0, 30, 90, 150, 180])
    expected, noise = estimate.radiance(
        medium, altitude, np.radians(sun), zenith, azimuth, samples=samples
    )
    mean, stderr = radiance(
        medium,
        [deck(0.0)],
        [DROPLETS],
        altitude,
        np.radians(sun),
        2.0,
        zenith,
        2.0 + azimuth,
        samples=samples,
    )
    check_agrees(mean, stderr, expected[:, 0], noise[:, 0], 0.03)


@pytest.mark.parametrize(("altitude", "sun"), [(0.001, -4.0), (11.0, 5.0)])
def test_clouds_of_no_extinction_leave_the_clear_sky(altitude, sun):
    check_clear(altitude, sun, 3200)


@pytest.mark.slow
@pytest.mark.parametrize("altitude", [0.001, 1.5, 11.0])
@pytest.mark.parametrize("sun", [60.0, 5.0, -4.0])
def test_clouds_of_no_extinction_leave_the_clear_sky_at_many_samples(altitude, sun):
    check_clear(altitude, sun, 64_000)


def check_deck(optical_depth, ground, sun, every, samples, worst):
    rows = cloud_table("deck_DISORT")
    rows = rows[(rows["tau"] == optical_depth) & (rows["sun_elevation_deg"] == sun)]
    rows = rows[rows["ground_albedo"] == ground][::every]
    assert len(rows) >= 5
    is_below = rows["side"] == "below"
    zenith = np.where(is_below, 1.0, -1.0) * rows["abs_mu_view"]
    mean, stderr = np.empty((2, len(rows), 1))
    for side, altitude in ((is_below, 0.5), (~is_below, 3.0)):
        mean[side], stderr[side] = radiance(
            vacuum(ground),
            [deck(optical_depth)],
            [DROPLETS],
            altitude,
            np.radians(sun),
            1.0,
            np.arccos(zenith[side]),
            1.0 + np.radians(rows["view_azimuth_from_sun_deg"][side]),
            samples=samples,
        )
    truth = rows["radiance_per_irradiance"]
    check_agrees(mean, stderr, truth, 0.005 * truth, worst)


@pytest.mark.parametrize(
    ("optical_depth", "ground", "sun"),
    [(1.0, 0.3, 60.0), (4.0, 0.0, 20.0), pytest.param(16.0, 0.3, 60.0, marks=pytest.mark.slow)],
)
def test_a_deck_agrees_with_discrete_ordinates(optical_depth, ground, sun):
    check_deck(optical_depth, ground, sun, every=2, samples=9600, worst=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(("ground", "sun"), [(0.3, 60.0), (0.0, 60.0), (0.0, 20.0)])
@pytest.mark.parametrize("optical_depth", [1.0, 4.0, 16.0, 64.0])
def test_a_deck_agrees_with_discrete_ordinates_at_many_samples(optical_depth, ground, sun):
    check_deck(optical_depth, ground, sun, every=1, samples=100_000, worst=0.05)


def check_stratus(altitude, every, samples, worst):
    rows = cloud_table(f"cloud_STRATUS_TAU8_{altitude}km")
    for sun in (60.0, 10.0):
        views = rows[rows["sun_elevation_deg"] == sun][::every]
        mean, stderr = radiance(
            air_at_550nm("EARTH_A", 0.2),
            [deck(8.0)],
            [DROPLETS],
            float(altitude),
            np.radians(sun),
            -1.0,
            np.radians(views["view_zenith_deg"]),
            np.radians(views["relative_azimuth_deg"]) - 1.0,
            samples=samples,
        )
        check_agrees(mean, stderr, views[RADIANCE], views["stderr"], worst)


@pytest.mark.parametrize("altitude", ["0.001", "11"])
def test_a_deck_in_the_air_agrees_with_another_program(altitude):
    check_stratus(altitude, 3, 3200, 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("altitude", ["0.001", "11"])
def test_a_deck_in_the_air_agrees_with_another_program_at_many_samples(altitude):
    check_stratus(altitude, 1, 64_000, 0.03)


def check_cumulus(every, samples, worst):
    rows = cloud_table("cloud_CUMULUS_0.001km")[::every]
    mean, stderr = radiance(
        air_at_550nm("EARTH_A", 0.2),
        [cumulus()],
        [DROPLETS],
        0.001,
        np.radians(60.0),
        EAST - np.radians(rows["sun_azimuth_deg"][0]),
        np.radians(rows["view_zenith_deg"]),
        EAST - np.radians(rows["view_azimuth_deg"]),
        samples=samples,
    )
    check_agrees(mean, stderr, rows[RADIANCE], rows["stderr"], worst)


def check_linear_cumulus(sun, every, samples, worst):
    rows = cloud_table("cloud_CUMULUS_LINEAR")
    rows = rows[rows["sun_elevation_deg"] == sun][::every]
    mean, stderr = np.empty((2, len(rows), 1))
    for altitude in np.unique(rows["eye_km"]):
        at = rows["eye_km"] == altitude
        mean[at], stderr[at] = radiance(
            air_at_550nm("HILLAIRE", 0.3),
            [linear_cumulus()],
            [DROPLETS],
            float(altitude),
            np.radians(sun),
            EAST,
            np.radians(90.0 - rows["view_elevation_deg"][at]),
            EAST - np.radians(rows["view_azimuth_from_sun_deg"][at]),
            samples=samples,
        )
    check_agrees(mean, stderr, rows["radiance_per_irradiance"], rows["stderr"], worst)


def test_cumuli_agree_with_another_program():
    check_cumulus(3, 3200, 0.1)


def test_cumuli_linear_between_voxels_agree_with_another_program():
    check_linear_cumulus(60.0, 1, 1600, 0.1)


@pytest.mark.slow
def test_cumuli_agree_with_another_program_at_many_samples():
    check_cumulus(1, 64_000, 0.03)


@pytest.mark.slow
@pytest.mark.parametrize("sun", [60.0, 3.0])
def test_cumuli_linear_between_voxels_agree_with_another_program_at_many_samples(sun):
    check_linear_cumulus(sun, 1, 32_000, 0.03)


def test_bearings_are_those_of_the_compass_and_tiles_run_east_and_north():
    # One cloud in the first octant of bearings, and nothing else that scatters.
    values = np.zeros((1, 40, 40))
    values[0, 22:25, 21:23] = 5.0
    cloud = voxels(values, (0.5, 1.0, 1.0), 1.0, origin=(20.0, 20.0))
    bearings = np.radians(np.arange(-180.0, 180.0, 30.0)) + math.atan2(2.0, 3.5)
    zenith = math.atan(math.hypot(2.0, 3.5) / 1.25)
    mean, _ = radiance(vacuum(), [cloud], [DROPLETS], 0.0, SUN, 1.0, zenith, bearings, samples=320)
    assert list(np.flatnonzero(mean[:, 0])) == [6]


@pytest.mark.slow
def test_a_layer_is_the_same_in_two_halves():
    medium, views = vacuum(0.3), np.radians([20.0, 50.0, 150.0])
    arguments = (1.0, SUN, 0.0, views, 0.5)
    halves = [deck(1.5, 1.5, 0.5), deck(1.5, 2.0, 0.5)]
    whole, noise = radiance(medium, [deck(3.0, 1.5)], [DROPLETS], *arguments, samples=9600)
    mean, stderr = radiance(medium, halves, [DROPLETS] * 2, *arguments, samples=9600, seed=1)
    check_agrees(mean, stderr, whole[:, 0], noise[:, 0], 0.06)


def test_results_do_not_depend_on_the_number_of_threads(monkeypatch):
    def run(count):
        monkeypatch.setattr(workers, "cpu_count", lambda: count)
        air = air_at_550nm("EARTH_A", 0.2)
        views = np.radians([10.0, 70.0])
        return radiance(air, [cumulus()], [DROPLETS], 0.0, SUN, 0.3, views, 1.0, samples=64, seed=3)

    np.testing.assert_array_equal(run(1), run(3))


@numba.njit
def bound_and_extinctions(field, bounds, radius, place, offsets, out):
    """The bound at a place, and extinctions within the distance that it holds for."""
    x, y, z = place
    most, reach = cloud_bound(field, bounds, radius, x, y, z, z)
    for i in range(len(offsets)):
        dx, dy, dz = offsets[i]
        near = x + reach * dx, y + reach * dy, z + reach * dz
        tile_x, tile_y, erosion, _ = cloud_place(field, radius, *near, near[2], 0.0)
        out[i] = extinction_at(field, tile_x, tile_y, near[2], 0.0, erosion)
    return most


@pytest.mark.parametrize("clouds", [cumulus, linear_cumulus, preset_cumulus])
def test_extinction_is_nowhere_above_its_bound(clouds):
    field = clouds()
    random = np.random.default_rng(1)
    bounds = bound_clouds(field)
    offsets = random.normal(size=(200, 3))
    offsets *= random.random((200, 1)) ** 0.3 / np.linalg.norm(offsets, axis=1, keepdims=True)
    out, tight = np.empty(200), []
    for _ in range(600):
        place = tuple(random.uniform([-40.0, -40.0, 0.5], [40.0, 40.0, 3.0]))
        most = bound_and_extinctions(field, bounds, 1e9, place, offsets, out)
        assert out.max() <= most
        tight.append(most == 0.0)
    assert 0.1 < np.mean(tight) < 0.95


@numba.njit
def air_bound_and_extinction(air, peaks, low, high, h):
    """The bound between two altitudes, and extinction at one."""
    extinction = node_value(air.altitude, air.extinction, shell_of(air.altitude, h), h)
    return air_bound(air, peaks, low, high), extinction


def test_extinction_of_the_air_is_nowhere_above_its_bound():
    air = air_at(air_at_550nm("EARTH_A", 0.0), 0)
    # Of any shape, such as a layer.
    layers = np.random.default_rng(0).random(len(air.altitude))
    air = air._replace(extinction=layers)
    peaks = air_peaks(air)
    random = np.random.default_rng(2)
    for low, size, share in random.random((5000, 3)):
        bottom = 100.0 * low**3
        top = min(100.0, bottom + 20.0 * size**4)
        most, here = air_bound_and_extinction(
            air, peaks, bottom, top, bottom + share * (top - bottom)
        )
        assert here <= most
    assert air_bound_and_extinction(air, peaks, 0.0, 100.0, 0.0)[0] == layers.max()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"altitude": -1.0}, "altitude: must be >= 0 km, got -1.0"),
        ({"sun_bearing": math.nan}, "sun_bearing: must be finite, got nan"),
        ({"samples": 0}, "samples: must be >= 1, got 0"),
        ({"phases": []}, "phases: must be one for each of the fields, got 0"),
        ({"phases": [DROPLETS[1:]]}, "phases: must have the shape (1025, 1), got (1024, 1)"),
        ({"fields": [deck(1.0, 99.5)]}, "fields: must be within the atmosphere, got a top at"),
    ],
)
def test_arguments_out_of_range_are_named(change, message):
    arguments = {
        "fields": [deck(1.0)],
        "phases": [DROPLETS],
        "altitude": 1.0,
        "sun_elevation": 0.5,
        "sun_bearing": 0.0,
        "zenith": 0.1,
        "bearing": 0.0,
        "samples": 32,
    } | change
    with pytest.raises(InputError) as caught:
        radiance(air_at_550nm("EARTH_A", 0.0), **arguments)
    assert str(caught.value).startswith(message)
