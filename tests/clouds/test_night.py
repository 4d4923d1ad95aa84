"""Clouds by night: in the light of the Moon, of the sky and of cities."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from skybake.clouds.build import build_cloudscape
from skybake.clouds.directions import unit_vectors
from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.lit_moon import moon_by_hand
from skybake.image.moonlight import Moonlight
from skybake.image.night import Night
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.image.starry import star_xyz
from skybake.jit.workers import Workers
from skybake.night.air import NightAir
from skybake.night.glow_air import GlowAir
from skybake.preset import load_preset
from skybake.sky.extended import STEPS
from skybake.sky.sky import Sky
from tests.clouds.tile_worlds import tile_world

FRAME = CelestialFrame("earth", 1.0, math.radians(31.0))
ZENITH = np.radians([0.5, 45.0, 79.0, 95.0])[:, None]
AROUND = 2.0 * math.pi * np.arange(16)[None] / 16.0
TOWARD_MOON = math.radians(140.0), math.radians(40.0)


@pytest.fixture(scope="module")
def overcast(tmp_path_factory):
    return deck(tmp_path_factory.mktemp("overcast"), 16.0)


def deck(folder, depth):
    """A world of three wavelengths under a deck of an optical depth."""
    values = np.full((1, 1, 1), depth / 0.4, np.float32)
    return load_preset(tile_world(folder, values, (0.4, 0.4, 0.4), 0.6))


def scene(planet="earth-hillaire2020", *, sun=-50.0, night=None, moon=None, shown="include"):
    settings = map_settings(
        size=(64, 32),
        sun_elevation=math.radians(sun),
        sun_azimuth=math.radians(140.0),
        clouds_quality="draft",
        method="hillaire",
        units="nits",
        night=night or Night(),
        moonlight=Moonlight(moon, shown),
    )
    return Scene(load_preset(planet) if isinstance(planet, str) else planet, settings)


def luminances(lit):
    return lit.evaluate(ZENITH, AROUND, 1e-9) @ lit.luminance


def moon(phase=2.0):
    return moon_by_hand(*TOWARD_MOON, math.radians(phase), 2.0, math.radians(-50.0))


def test_the_moon_lights_clouds_as_a_sun_of_its_light_would(overcast):
    moonlit = scene(overcast, moon=moon(), shown="only")
    sunlit = scene(overcast, sun=40.0)
    ratio = sunlit.xyz_weights[:, 1].sum() / moonlit.moonlit.air_weights[:, 1].sum()
    np.testing.assert_allclose(luminances(sunlit), ratio * luminances(moonlit), rtol=3e-3)


@pytest.mark.slow
def test_a_cloudy_night_is_the_sum_of_its_lights(overcast):
    night = Night(FRAME)
    whole, by_moon, by_night = (
        luminances(scene(overcast, moon=each, shown=shown, night=night))
        for each, shown in ((moon(), "include"), (moon(), "only"), (None, "include"))
    )
    np.testing.assert_allclose(whole, by_moon + by_night, rtol=1e-4)
    assert by_night.min() > 0.0


def test_an_overcast_hides_stars_and_darkens_the_night(overcast):
    night = Night(FRAME)
    clear, cloudy = scene(night=night), scene(overcast, night=night)
    assert star_xyz(clear, clear.stars)[:, 1].max() > 1e-7
    assert star_xyz(cloudy, cloudy.stars)[:, 1].max() == 0.0
    # What a deck of optical depth 16 lets through over a ground of albedo 0.3.
    left = cloudy.sky_illuminance() / clear.sky_illuminance()
    assert left == pytest.approx(0.44, abs=0.02)


def test_over_a_city_an_overcast_is_tens_of_times_as_bright_as_a_clear_sky(overcast):
    # Kyba et al. (2011) measured 10 in the haze of Berlin; this air has hardly any.
    night = Night(FRAME, city=3e-3)
    clear, cloudy = (
        luminances(scene(each, night=night)) for each in ("earth-hillaire2020", overcast)
    )
    assert 10.0 < cloudy[0].mean() / clear[0].mean() < 25.0


@pytest.mark.slow
def test_at_dusk_clouds_darken_without_a_step(overcast):
    # Without zodiacal light, which follows the sun.
    night = Night(FRAME, zodiacal=0.0)
    lit = [scene(overcast, sun=each, night=night) for each in (-17.0, -21.0, -30.0)]
    twilight, last, dark = (luminances(each).mean(axis=1) for each in lit)
    assert [len(each.lit_clouds) for each in lit] == [2, 2, 1]
    assert (twilight > 1.01 * dark).all()
    np.testing.assert_allclose(last, dark, rtol=2e-3)


@pytest.mark.slow
def test_in_a_white_furnace_clouds_are_white(tmp_path):
    # Air and clouds that absorb nothing over a white ground.
    white = {"constituents.ozone": "none", "constituents.aerosol": "none", "ground.albedo": 1.0}
    values = np.full((2, 4, 4), 2.0, np.float32)
    values[:, 1:3, 1:3] = 20.0
    world = tile_world(tmp_path, values, (0.4, 0.4, 0.4), 1.0, extends="earth-clear")
    planet = load_preset(world, white)
    sky = Sky(planet, 0.5, altitude=0.2)
    air = NightAir(sky, has_airglow=False)
    rings = np.ones((STEPS, sky.wavelengths.size))
    glow = GlowAir(sky, SimpleNamespace(air=air, rings=rings, airglow=0.0, city=0.0))
    clouds = build_cloudscape(
        planet.clouds, sky, glow.colours, quality="draft", workers=Workers(1), air=glow
    )
    zenith, bearing = np.radians([10.0, 40.0, 60.0, 80.0, 95.0]), np.radians([0, 50, 110, 200, 300])
    light = clouds.radiance(unit_vectors(zenith, bearing))
    np.testing.assert_allclose(light / air.weights.sum(axis=0), 1.0, atol=0.015)
