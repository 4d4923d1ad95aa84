"""Homogeneous decks against discrete ordinates with many streams."""

import math

import numpy as np
import pytest

from skybake.clouds.build import build_cloudscape
from skybake.clouds.directions import unit_vectors
from skybake.inspect.probe import probe, read_directions
from skybake.jit.workers import Workers
from skybake.preset import load_preset
from skybake.sky.sky import Sky
from tests.clouds.tile_worlds import tile_world
from tests.reference.cloud_scenes import cloud_table

AIRLESS = '[constituents]\nair = "none"\nozone = "none"\naerosol = "none"\n'
VACUUM = f"[ground]\nalbedo = 0.0\n{AIRLESS}"


def deck_world(folder, optical_depth, ground=0.0):
    """A deck of one voxel from 1 to 2 km above a ground without air."""
    deck = np.full((1, 1, 1), optical_depth)
    settings = f"[ground]\nalbedo = {ground}\n{AIRLESS}"
    return load_preset(tile_world(folder, deck, (1.0, 1.0, 1.0), settings=settings))


def errors(folder, optical_depth, sun, side, ground=0.0):
    """Relative errors of radiances beyond 8 deg from the sun, seen from below or above."""
    rows = cloud_table("deck_DISORT")
    rows = rows[(rows["tau"] == optical_depth) & (rows["sun_elevation_deg"] == sun)]
    rows = rows[(rows["ground_albedo"] == ground) & (rows["side"] == side)]
    rows = rows[(rows["abs_mu_view"] > 0.1) & (rows["scattering_angle_deg"] > 8.0)]
    assert len(rows) >= 6
    slope = rows["abs_mu_view"] * (1.0 if side == "below" else -1.0)
    views = [
        f"{zenith:.9f},{azimuth:g}"
        for zenith, azimuth in zip(
            np.degrees(np.arccos(slope)), rows["view_azimuth_from_sun_deg"], strict=True
        )
    ]
    text = probe(
        deck_world(folder, optical_depth, ground),
        read_directions("views", ["view_zenith_deg,relative_azimuth_deg", *views]),
        sun_elevation=math.radians(sun),
        altitude=0.5 if side == "below" else 3.0,
        wavelengths=np.array([550.0]),
        per_irradiance=True,
    )
    got = np.array([float(row.split(",")[2]) for row in text.splitlines()[1:]])
    return got / rows["radiance_per_irradiance"] - 1.0


def check(error, mean, rms):
    assert abs(error.mean()) < mean, error
    assert math.sqrt((error**2).mean()) < rms, error


HIGH = [(1.0, 60.0), (4.0, 60.0), (16.0, 20.0)]
MORE = [(16.0, 60.0), (64.0, 60.0), (1.0, 20.0), (4.0, 20.0), (64.0, 20.0)]


@pytest.mark.parametrize(("optical_depth", "sun"), HIGH)
def test_radiances_from_above_are_those_of_many_streams(tmp_path, optical_depth, sun):
    check(errors(tmp_path, optical_depth, sun, "above"), 0.03, 0.05)


@pytest.mark.parametrize(("optical_depth", "sun"), HIGH)
def test_radiances_from_below_are_those_of_many_streams(tmp_path, optical_depth, sun):
    check(errors(tmp_path, optical_depth, sun, "below"), 0.05, 0.06)


@pytest.mark.parametrize("side", ["above", "below"])
def test_radiances_under_a_low_sun_are_those_of_many_streams(tmp_path, side):
    check(errors(tmp_path, 8.0, 10.0, side), 0.06, 0.08)


@pytest.mark.parametrize("optical_depth", [1.0, 4.0, 16.0])
def test_ground_and_deck_exchange_light_also_without_air(tmp_path, optical_depth):
    check(errors(tmp_path, optical_depth, 60.0, "above", ground=0.3), 0.03, 0.05)
    check(errors(tmp_path, optical_depth, 60.0, "below", ground=0.3), 0.05, 0.06)


@pytest.mark.slow
@pytest.mark.parametrize(("optical_depth", "sun"), MORE)
def test_radiances_of_more_decks_are_those_of_many_streams(tmp_path, optical_depth, sun):
    check(errors(tmp_path, optical_depth, sun, "above"), 0.03, 0.05)
    check(errors(tmp_path, optical_depth, sun, "below"), 0.05, 0.06)


@pytest.mark.slow
@pytest.mark.parametrize("side", ["above", "below"])
@pytest.mark.parametrize("optical_depth", [2.0, 32.0])
def test_more_decks_under_a_low_sun_have_radiances_of_many_streams(tmp_path, optical_depth, side):
    check(errors(tmp_path, optical_depth, 10.0, side), 0.06, 0.08)


def test_the_voxels_of_a_decks_tile_do_not_matter(tmp_path):
    """Wide ones must not hide the way of the sun's light through its upper part."""
    directions = unit_vectors(np.radians([100.0, 110.0, 120.0, 150.0]), np.zeros(4))
    seen = []
    for levels, across in ((1, 20.0), (4, 0.3)):
        deck = np.full((levels, 2, 2), 16.0)
        folder = tmp_path / str(levels)
        folder.mkdir()
        spacing = (1.0 / levels, across, across)
        planet = load_preset(tile_world(folder, deck, spacing, settings=VACUUM))
        sky = Sky(planet, math.radians(15.0), 3.0, sun_azimuth=0.0, wavelengths=np.array([550.0]))
        cloudscape = build_cloudscape(
            planet.clouds, sky, np.eye(1), quality="draft", workers=Workers(1)
        )
        seen.append(cloudscape.radiance(directions)[:, 0])
    np.testing.assert_allclose(seen[0], seen[1], rtol=5e-3)


def check_fluxes(folder, rows):
    for row in rows:
        sun = math.radians(row["sun_elevation_deg"])
        planet = deck_world(folder, row["tau"])
        sky = Sky(planet, sun, 0.5, wavelengths=np.array([550.0]))
        scape = build_cloudscape(planet.clouds, sky, np.eye(1), quality="high", workers=Workers(1))
        (solved,) = scape.solved
        at = int(np.argmin(np.abs(solved.light.sun_mu - math.sin(sun))))
        slope = solved.light.sun_mu[at]
        assert slope == pytest.approx(math.sin(sun), abs=0.02)
        through = solved.down[at, 0] / slope + float(solved.leaving[at, 0].mean())
        expected = row["diffuse_transmittance"] + row["direct_transmittance"]
        assert through == pytest.approx(expected, rel=0.015)
        # Of the first of all suns.
        assert len(solved.light.sun_mu) == 1
        assert through + solved.reflectance.flux[0] == pytest.approx(1.0, abs=1e-3)


def fluxes():
    rows = cloud_table("deck_fluxes_DISORT")
    return rows[rows["sun_elevation_deg"] >= 20.0]


def test_transmittances_are_those_of_many_streams_and_light_is_kept(tmp_path):
    rows = fluxes()
    check_fluxes(tmp_path, rows[(rows["tau"] <= 16.0)][::2])


@pytest.mark.slow
def test_all_transmittances_are_those_of_many_streams(tmp_path):
    check_fluxes(tmp_path, fluxes())
