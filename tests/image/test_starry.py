"""Stars in maps: where they are seen, how bright, and where they are not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from skybake.angles import direction_from_angles
from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.horizon import Horizon
from skybake.errors import InputError
from skybake.image.image import image_of_scene
from skybake.image.night import Night
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.image.starry import star_illuminance, star_xyz
from skybake.night.stars import _raised
from skybake.preset import load_preset
from skybake.projection import Equirect, Perspective

EARTH = load_preset("earth")
WINTER = CelestialFrame("earth", math.radians(85.0), math.radians(30.0))
"""Orion culminates."""


def scene(planet=EARTH, projection=None, *, frame=WINTER, night=None, **options):
    options = {"sun_elevation": math.radians(-40.0), "units": "nits", **options}
    night = Night(frame=frame) if night is None else night
    return Scene(planet, map_settings(projection or Equirect(256), night=night, **options))


def test_a_night_holds_the_light_of_its_stars():
    lit = scene(night=Night(WINTER, stars="only"))
    pixels = image_of_scene(lit).pixels.astype(float)
    chart = lit.settings.view.projection.canvases()[0].parts[0].chart
    luminance = pixels @ lit.luminance
    zenith, _ = chart.angles(0, chart.height)
    held = (luminance * np.cos(zenith) * chart.solid_angles(0, chart.height))[:64].sum()
    # Half of the light of V <= 6.5 is in the sky, and a good part of that passes the air.
    assert held == pytest.approx(star_illuminance(lit, lit.stars), rel=3e-3)
    assert 2.5e-5 < held < 9e-5


def test_sirius_is_the_brightest_and_stands_in_the_south():
    south = Perspective(300, 200, math.radians(60.0), math.radians(165.0), math.radians(40.0))
    pixels = image_of_scene(scene(projection=south)).pixels
    row, column = np.unravel_index(pixels[..., 1].argmax(), pixels.shape[:2])
    (chart,) = (part.chart for part in south.canvases()[0].parts)
    zenith, bearing = chart.angles(0, chart.height)
    # Right ascension 101.3 deg and declination -16.7 deg, on a planisphere for 30 deg north.
    hour_angle, declination, latitude = map(math.radians, (85.0 - 101.287, -16.716, 30.0))
    sine = math.sin(latitude) * math.sin(declination)
    sine += math.cos(latitude) * math.cos(declination) * math.cos(hour_angle)
    assert math.pi / 2 - zenith[row, column] == pytest.approx(math.asin(sine), abs=0.01)
    east = -math.cos(declination) * math.sin(hour_angle) / math.cos(math.asin(sine))
    assert math.sin(bearing[row, column]) == pytest.approx(east, abs=0.01)


def test_the_air_dims_stars_near_the_horizon_and_reddens_them():
    lit = scene()
    transmittance = lit.stars.transmittance
    height = np.degrees(np.arcsin(lit.stars.vectors[:, 1]))
    high, low = transmittance[height > 70.0], transmittance[(height > 4.0) & (height < 6.0)]
    assert 0.6 < high[:, 8].mean() < 0.95
    assert low[:, 8].mean() < 0.35 * high[:, 8].mean()
    assert (low[:, -1] > 2.0 * low[:, 2]).all()


def test_the_planet_hides_stars():
    assert (scene().stars.vectors[:, 1] > -0.001).all()
    above = scene(altitude=400.0).stars
    assert -0.36 < above.vectors[:, 1].min() < -0.3


def test_by_day_the_sky_outshines_all_stars():
    day = scene(sun_elevation=0.5)
    assert day.stars is None
    assert day.layer_names == ("sky", "sun")
    plain = Scene(EARTH, replace(day.settings, night=Night()))
    np.testing.assert_array_equal(image_of_scene(day).pixels, image_of_scene(plain).pixels)


def test_from_space_stars_stand_beside_the_sun():
    assert scene(sun_elevation=0.5, altitude=400.0).stars is not None


def test_the_sky_between_stars_is_not_black():
    night, black = (scene(night=Night(WINTER, is_shown=each)) for each in (True, False))
    lit, unlit = (image_of_scene(one).pixels[:60] @ night.luminance for one in (night, black))
    assert 1.2e-4 < lit.min() < 3e-4
    assert unlit.max() < 1e-6
    # It lights the ground as well.
    assert 0.6e-3 < night.sky_illuminance() < 1.4e-3


def test_the_glow_of_the_night_adds_to_twilight():
    def pixels(elevation, night):
        one = scene(sun_elevation=math.radians(elevation), night=night)
        return image_of_scene(one).pixels

    # That of airglow and stars, which the sun's place does not change.
    night = Night(WINTER, stars="exclude", zodiacal=0.0)
    glow = pixels(-11.0, night) - pixels(-11.0, Night())
    np.testing.assert_allclose(glow, pixels(-60.0, night), rtol=1e-3, atol=1e-9)


@pytest.mark.slow
def test_the_glow_of_the_night_appears_without_a_jump(monkeypatch):
    night = Night(WINTER, stars="exclude")
    world = load_preset("earth-hillaire2020")

    # The sun is put there by hand, beside the ecliptic of this frame.
    def at(elevation):
        return scene(world, Equirect(64), sun_elevation=elevation, night=night, method="hillaire")

    high, low = math.radians(-2.0), math.radians(-14.0)
    for _ in range(9):
        middle = 0.5 * (high + low)
        high, low = (middle, low) if at(middle).night_glow is None else (high, middle)
    above, below = at(high), at(low)
    assert (above.night_glow is None, below.night_glow is None) == (True, False)
    monkeypatch.setattr("skybake.image.outshone.glow_is_outshone", lambda _: False)
    with_it = image_of_scene(at(high)).pixels @ above.luminance
    without = image_of_scene(above).pixels @ above.luminance
    assert (with_it / without).max() < 1.005


def test_a_map_that_is_turned_has_the_stars_turned():
    plain, turned = (
        image_of_scene(scene(rotation=math.radians(each))).pixels for each in (0.0, 90.0)
    )
    np.testing.assert_allclose(np.roll(plain, -64, axis=1), turned, atol=1e-9, rtol=1e-3)


def test_refraction_raises_stars():
    low, high = (scene(night=Night(WINTER, is_refracted=each)).stars for each in (False, True))
    # More of them are seen: those that stand up to 34 arcmin below the horizon.
    assert len(high.vectors) > len(low.vectors)
    # The brightest, Sirius, is well above the horizon in both.
    lift = np.degrees(np.arcsin(high.vectors[0, 1]) - np.arcsin(low.vectors[0, 1]))
    assert 0.01 < lift < 0.03


def test_a_limit_leaves_faint_stars_out():
    few = scene(night=Night(WINTER, faintest_star=2.0)).stars
    assert 10 < len(few.vectors) < 40


def test_only_stars_are_the_stars_of_the_map():
    whole, only = (
        image_of_scene(scene(night=Night(WINTER, stars=each))).pixels
        for each in ("include", "only")
    )
    dark = image_of_scene(scene(night=Night(WINTER, stars="exclude"))).pixels
    np.testing.assert_allclose(only, whole - dark, atol=1e-9)


def test_a_world_of_three_wavelengths_has_stars_of_the_same_light():
    paper = scene(load_preset("earth-hillaire2020"))
    earth = scene(load_preset("earth-clear"))
    ratio = star_illuminance(paper, paper.stars) / star_illuminance(earth, earth.stars)
    assert ratio == pytest.approx(1.0, abs=0.1)
    assert (star_xyz(paper, paper.stars)[:, 1] > 0.0).all()


@pytest.mark.parametrize("name", ["airglow", "zodiacal"])
@pytest.mark.parametrize("scale", [-0.1, 101.0, math.nan])
def test_a_glow_beyond_bounds_is_refused(name, scale):
    with pytest.raises(InputError, match=f"{name}: must be from 0 to 100"):
        Night(**{name: scale})


@pytest.mark.parametrize("magnitude", [-2.0, 7.0, math.nan])
def test_a_magnitude_that_no_star_has_is_refused(magnitude):
    with pytest.raises(InputError, match=r"stars: magnitude must be from -1.44"):
        Night(faintest_star=magnitude)


@pytest.mark.parametrize("altitude", [0.0, 2.6])
def test_stars_are_raised_as_the_sun_is(altitude):
    horizon = Horizon("earth", altitude)
    elevation = np.radians([-0.4, 0.03, 1.0, 7.0, 30.0, 80.0]) - horizon.dip
    raised = _raised(direction_from_angles(0.3, elevation), horizon)
    expected = elevation + [horizon.lift(each) for each in elevation.tolist()]
    np.testing.assert_allclose(np.arcsin(raised[:, 1]), expected, rtol=0.0, atol=2.5e-6)
