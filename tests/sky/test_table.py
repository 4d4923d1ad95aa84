"""The table of a sky against rays of their own."""

import functools
import math

import numpy as np
import pytest

from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.sky.spectral_table import fold_table
from skybake.sky.table import AZIMUTHS, horizon_angles
from tests.skies import view_cosines

ELEVATIONS = (
    60.0,
    pytest.param(30.0, marks=pytest.mark.slow),
    5.0,
    pytest.param(0.0, marks=pytest.mark.slow),
    -4.0,
    -8.0,
)
POINT = 1e-9


@functools.cache
def scene(preset, elevation, altitude=0.0):
    settings = map_settings(
        sun_elevation=math.radians(elevation), altitude=altitude, colorspace="xyz", units="nits"
    )
    made = Scene(load_preset(preset), settings)
    if (elevation, altitude) != (30.0, 0.0):
        made.sky.__dict__["atmosphere"] = scene(preset, 30.0).sky.atmosphere
    return made


def by_table(made, zenith, azimuth):
    """XYZ in cd/m2 of points, angles in degrees."""
    zenith, azimuth = np.radians(zenith)[:, None], np.radians(azimuth)[:, None]
    return made.evaluate(zenith, azimuth, POINT)[:, 0]


def by_rays(made, zenith, azimuth):
    cosines = view_cosines(zenith, azimuth, math.degrees(made.sky.sun_elevation))
    return made.sky.radiance_per_irradiance(*cosines) @ made.rgb_weights


def views(made, count=300):
    """Zenith angles and azimuths in degrees: everywhere, at the horizon, about the sun."""
    random = np.random.default_rng(7)
    horizon = 180.0 - math.degrees(math.asin(made.sky.medium.r_bottom / made.sky.skylight.radius))
    sun = 90.0 - math.degrees(made.sky.sun_elevation)
    third = count // 3
    zenith = np.concatenate(
        [
            np.degrees(np.arccos(random.uniform(-1.0, 1.0, third))),
            horizon + random.normal(0.0, 4.0, third),
            np.abs(sun + random.normal(0.0, 5.0, third)),
        ]
    )
    azimuth = np.concatenate(
        [random.uniform(0.0, 180.0, 2 * third), np.abs(random.normal(0.0, 5.0, third))]
    )
    return np.clip(zenith, 0.0, 180.0), azimuth, horizon


@pytest.mark.parametrize("altitude", [0.0, 10.0])
@pytest.mark.parametrize("elevation", ELEVATIONS)
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_table_is_within_half_a_percent_of_rays(preset, elevation, altitude):
    """Everywhere but within 0.3 deg of the horizon; in deep twilight within one percent."""
    made = scene(preset, elevation, altitude)
    zenith, azimuth, horizon = views(made)
    away = np.abs(zenith - horizon) > 0.3
    table = by_table(made, zenith[away], azimuth[away])
    rays = by_rays(made, zenith[away], azimuth[away])
    error = table / rays - 1.0
    assert np.abs(error).max() < (0.005 if elevation > -6.0 else 0.01)
    assert math.sqrt(np.mean(error**2)) < 0.001


@pytest.mark.parametrize(
    ("elevation", "altitude", "tolerance"),
    [(60.0, 0.0, 1e-4), (2.1, 0.0, 1e-4), (6.5, 10.0, 1e-4), (-4.0, 0.0, 1e-3), (-4.0, 10.0, 1e-3)],
)
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_rays_at_few_azimuths_tell_all_others(monkeypatch, preset, elevation, altitude, tolerance):
    made = scene(preset, elevation, altitude)
    zenith, azimuth, _ = views(made)
    few = by_table(made, zenith, azimuth)
    monkeypatch.setattr("skybake.sky.spectral_table.ray_azimuths", lambda *_, **__: AZIMUTHS)
    light = made.sky.skylight
    many = fold_table(light.spectral_table(made.sky.source), light.basis, made.rgb_weights)
    monkeypatch.setitem(made.__dict__, "table", many)
    np.testing.assert_allclose(few, by_table(made, zenith, azimuth), rtol=tolerance)


@pytest.mark.parametrize(
    "altitude",
    [
        pytest.param(101.0, marks=pytest.mark.slow),
        400.0,
        pytest.param(36_000.0, marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize(
    "elevation",
    [60.0, *(pytest.param(each, marks=pytest.mark.slow) for each in (30.0, 5.0, 0.0, -4.0)), -8.0],
)
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_table_seen_from_space_is_within_half_a_percent(preset, elevation, altitude):
    """At the terminator too; within one percent for one in a hundred.

    Left out are a tenth of the limb's height at the horizon and at the top of the air, and
    what is darker than a thousandth of the brightest.
    """
    made = scene(preset, elevation, altitude)
    first, horizon = np.degrees([made.table.zenith_first, made.table.zenith_horizon])
    random = np.random.default_rng(11)
    limb = first + (horizon - first) * random.uniform(0.1, 0.9, 300)
    disc = 180.0 - (180.0 - horizon) * random.uniform(0.0, 0.99, 300)
    zenith, azimuth = np.concatenate([limb, disc]), random.uniform(0.0, 180.0, 600)
    table, rays = by_table(made, zenith, azimuth), by_rays(made, zenith, azimuth)
    error = np.abs(table - rays) / np.maximum(rays, 1e-3 * rays.max(axis=0))
    assert np.quantile(error, 0.99) < 0.005
    assert error.max() < 0.01


@pytest.mark.parametrize("elevation", ELEVATIONS)
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_table_is_within_three_percent_of_rays_up_to_the_horizon(preset, elevation):
    made = scene(preset, elevation)
    offset = np.array([-0.3, -0.1, -0.03, -0.01, -0.003, 0.003, 0.01, 0.03, 0.1, 0.3])
    horizon = math.degrees(made.table.zenith_horizon)
    zenith, azimuth = (x.ravel() for x in np.meshgrid(horizon + offset, [0.0, 20.0, 90.0, 180.0]))
    table, rays = by_table(made, zenith, azimuth), by_rays(made, zenith, azimuth)
    assert np.abs(table[:, 1] / rays[:, 1] - 1.0).max() < 0.03


@pytest.mark.parametrize("distance", [0.3, 0.5, 1.0, 2.0, 5.0])
@pytest.mark.parametrize("elevation", [60.0, 5.0])
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_aureole_is_within_half_a_percent_of_rays(preset, elevation, distance):
    made = scene(preset, elevation)
    side = np.array([-1.0, 1.0])
    zenith = np.clip(90.0 - elevation + side * distance, 0.0, 89.9)
    azimuth = np.zeros(2)
    np.testing.assert_allclose(
        by_table(made, zenith, azimuth), by_rays(made, zenith, azimuth), rtol=0.005
    )


@pytest.mark.parametrize("elevation", [60.0, 0.0, -8.0])
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_a_pixels_colour_is_continuous_through_the_zenith(preset, elevation):
    made = scene(preset, elevation)
    azimuth = np.linspace(0.0, 180.0, 13)
    around = by_table(made, np.full(13, 0.01), azimuth)
    assert np.ptp(around[:, 1]) < 2e-3 * around[:, 1].mean()


@pytest.mark.parametrize("elevation", [30.0, -4.0])
def test_both_sides_of_the_suns_meridian_are_the_same(elevation):
    made = scene("earth", elevation)
    zenith, azimuth, _ = views(made, 300)
    here = by_table(made, zenith, azimuth)
    np.testing.assert_array_equal(here, by_table(made, zenith, -azimuth))
    np.testing.assert_allclose(here, by_table(made, zenith, azimuth + 360.0), rtol=1e-5)


def test_a_pixel_across_the_horizon_is_the_mean_of_both_sides():
    made = scene("earth", 30.0)
    height = math.radians(1.0)
    zenith = np.array([[made.table.zenith_horizon + 0.2 * height]])
    pixel = made.evaluate(zenith, np.array([[1.0]]), height)[0, 0]
    fine = (np.arange(1000) + 0.5) / 1000 - 0.5
    parts = made.evaluate(zenith + fine[:, None] * height, np.full((1000, 1), 1.0), POINT)[:, 0]
    np.testing.assert_allclose(pixel, parts.mean(axis=0), rtol=0.01)


def test_horizon_dips_by_the_cosine_of_radii():
    first, horizon = horizon_angles(6371.0 + 10.0, 6371.0, 6471.0)
    assert first == 0.0
    assert horizon - math.pi / 2.0 == pytest.approx(math.acos(6371.0 / 6381.0), rel=1e-12)


def test_air_begins_at_its_top_seen_from_space():
    first, horizon = horizon_angles(6371.0 + 400.0, 6371.0, 6471.0)
    assert math.sin(first) == pytest.approx(6471.0 / 6771.0, rel=1e-12)
    assert math.pi / 2.0 < first < horizon


def test_space_above_the_air_is_black():
    made = scene("earth", 30.0, 400.0)
    zenith = np.linspace(0.0, math.degrees(made.table.zenith_first) - 0.01, 50)
    assert (by_table(made, zenith, np.full(50, 40.0)) == 0.0).all()


@pytest.mark.parametrize(
    ("preset", "elevation"),
    [
        ("earth", 60.0),
        pytest.param("earth", -4.0, marks=pytest.mark.slow),
        pytest.param("mars", 60.0, marks=pytest.mark.slow),
        ("mars", -4.0),
    ],
)
def test_leaving_the_air_changes_nothing_but_at_its_tangent(preset, elevation):
    """Ten metres below the top and above it, where the layout of the table differs."""
    medium = scene(preset, elevation).sky.medium
    top = medium.r_top - medium.r_bottom
    zenith, azimuth = np.meshgrid(
        np.concatenate([np.linspace(93.0, 97.0, 40), np.linspace(100.0, 175.0, 40)]),
        np.linspace(0.0, 180.0, 13),
    )
    below, above = (
        by_table(scene(preset, elevation, top + step), zenith.ravel(), azimuth.ravel())
        for step in (-0.01, 0.01)
    )
    difference = np.abs(above - below) / np.maximum(below, 1e-3 * below.max(axis=0))
    assert difference.max() < 0.01
