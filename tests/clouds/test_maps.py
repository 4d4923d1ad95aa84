"""Maps of cloudy skies: what must not change them, and how much light they bring."""

import math

import numpy as np
import pytest

from skybake.clouds.build import build_cloudscape
from skybake.clouds.cloudscape import unit_vectors
from skybake.errors import InputError
from skybake.image.light import light_of_scene
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.jit.workers import Workers
from skybake.optics.changes import PresetChanges
from skybake.preset import load_preset
from skybake.sky.sky import Sky
from tests.cli.runs import render
from tests.clouds.tile_worlds import one_cloud, tile_world

SMALL = ("--size", "64x32", "--sun", "25deg", "--clouds-quality", "draft")


def test_a_layer_without_cover_leaves_the_clear_map_to_the_bit(tmp_path):
    options = ("--size", "64x32", "--sun", "25deg", "--method", "hillaire")
    clear = render(tmp_path / "clear.hdr", "--preset", "earth-hillaire2020", *options)
    covered = render(
        tmp_path / "covered.hdr",
        "--preset",
        "earth-hillaire2020",
        *options,
        "--clouds",
        "cumulus:0",
    )
    # Headers tell the worlds.
    assert covered.split(b"\n-Y ", 1)[1] == clear.split(b"\n-Y ", 1)[1]


def test_the_same_moment_has_the_same_bytes(tmp_path):
    world = tile_world(tmp_path, *one_cloud(1))
    options = ("--preset", world, *SMALL, "--method", "hillaire", "--cloud-time", "90s")
    first = render(tmp_path / "first.hdr", *options)
    assert render(tmp_path / "again.hdr", *options) == first


def test_single_scattering_alone_is_refused_before_anything_is_solved_for():
    settings = map_settings(size=64, method="march")
    with pytest.raises(InputError, match="clouds: method must be full or hillaire, got march"):
        Scene(load_preset("earth-fair"), settings)
    empty = PresetChanges(keep_clouds=False, clouds=({"kind": "cumulus", "cover": 0.0},))
    Scene(empty.load("earth"), settings)


def radiances(folder, values, spacing, sun=25.0, altitude=0.0):
    folder.mkdir()
    planet = load_preset(tile_world(folder, values, spacing))
    sky = Sky(planet, math.radians(sun), altitude, method="hillaire")
    weights = np.eye(sky.wavelengths.size)[:, :1]
    clouds = build_cloudscape(planet.clouds, sky, weights, quality="draft", workers=Workers(1))
    zenith, bearing = np.radians([10.0, 40.0, 60.0, 80.0, 95.0]), np.radians([0, 50, 110, 200, 300])
    return clouds.radiance(unit_vectors(zenith, bearing))[:, 0]


def test_a_tile_that_holds_itself_twice_gives_the_same_sky(tmp_path):
    values, spacing = one_cloud(2)
    once = radiances(tmp_path / "once", values, spacing)
    twice = radiances(tmp_path / "twice", np.tile(values, (1, 1, 2)), spacing)
    np.testing.assert_allclose(twice, once, rtol=2e-4)


def overcast_scene(folder, sun):
    world = tile_world(folder, np.full((1, 1, 1), 40.0), (0.4, 0.4, 0.4), 0.6, extends="earth")
    settings = map_settings(size=(64, 32), sun_elevation=math.radians(sun), clouds_quality="draft")
    return Scene(load_preset(world), settings)


def test_an_overcast_is_as_bright_as_measured_ones(tmp_path):
    """Of optical depth 16 and a sun at 40 deg: 10 to 50 klx, and brighter aloft than low.

    The zenith of CIE's overcast is three times as bright as its horizon, that of a deck without
    air in front about twice; the air adds light near the horizon.
    """
    scene = overcast_scene(tmp_path, 40.0)
    light = light_of_scene(scene)
    assert light.direct_illuminance < 1.0
    assert 10_000.0 < light.sky_illuminance < 50_000.0
    zenith = np.radians([0.5, 79.0])[:, None]
    azimuth = 2.0 * math.pi * np.arange(16)[None] / 16.0
    luminance = (scene.evaluate(zenith, azimuth, 1e-9) @ scene.luminance).mean(axis=1)
    assert 1.4 < luminance[0] / luminance[1] < 2.2


def test_from_orbit_a_deck_reflects_as_much_as_its_ordinates(tmp_path):
    """Without air, all light that goes up through a sphere's small part is seen from 400 km."""
    vacuum = (
        '[ground]\nalbedo = 0.0\n[constituents]\nair = "none"\nozone = "none"\naerosol = "none"\n'
    )
    deck = np.full((1, 1, 1), 12.0)
    planet = load_preset(tile_world(tmp_path, deck, (1.0, 1.0, 1.0), settings=vacuum))
    sun = math.radians(60.0)
    sky = Sky(planet, sun, 400.0, sun_azimuth=0.0, wavelengths=np.array([550.0]))
    low = Sky(planet, sun, 2.5, sun_azimuth=0.0, wavelengths=np.array([550.0]))
    nodes, weights = np.polynomial.legendre.leggauss(12)
    slope, weight = 0.5 * (nodes + 1.0), 0.5 * weights
    azimuth = 2.0 * math.pi * (np.arange(16) + 0.5) / 16.0
    zenith = np.arccos(-slope)
    directions = unit_vectors(np.repeat(zenith, 16), np.tile(azimuth, 12))
    near = build_cloudscape(planet.clouds, low, np.eye(1), workers=Workers(1))
    radiance = near.radiance(directions)[:, 0].reshape(12, 16).mean(axis=1)
    reflectance = 2.0 * math.pi * (weight * slope) @ radiance / math.sin(sun)
    assert reflectance == pytest.approx(near.solved[0].reflectance.flux[0], rel=0.03)
    # The nadir is the same from orbit.
    far = build_cloudscape(planet.clouds, sky, np.eye(1), workers=Workers(1))
    nadir = np.array([[0.0, 0.0, -1.0]])
    assert far.radiance(nadir)[0, 0] == pytest.approx(near.radiance(nadir)[0, 0], rel=0.01)
