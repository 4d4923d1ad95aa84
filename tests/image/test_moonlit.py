"""The Moon in maps: its illuminance, its light in the air, and its disc."""

import math

import numpy as np
import pytest

from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.lit_moon import moon_by_hand
from skybake.image.image import image_of_scene
from skybake.image.light import moon_attributes
from skybake.image.moonlight import Moonlight
from skybake.image.night import Night
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.image.starry import star_xyz
from skybake.night.star_light import star_irradiance
from skybake.optics.moonlight import moon_share
from skybake.optics.spectrum import star_at
from skybake.optics.spectrum import star_irradiance as sunlight
from skybake.preset import load_preset
from skybake.projection import (
    Angular,
    Cubemap,
    Equirect,
    Fisheye,
    Octahedral,
    Perspective,
)
from skybake.sky.sky import Sky

EARTH = load_preset("earth")
SUN_AZIMUTH = math.radians(200.0)


def by_hand(elevation=60.0, phase=2.0, azimuth=140.0):
    angles = map(math.radians, (azimuth, elevation))
    return moon_by_hand(*angles, math.radians(phase), SUN_AZIMUTH, math.radians(-50.0))


def scene(moon=None, projection=None, *, shown="include", sun=-50.0, planet=EARTH, **options):
    options = {"units": "nits", "method": "hillaire", **options}
    settings = map_settings(
        projection or Equirect(128),
        sun_elevation=math.radians(sun),
        sun_azimuth=SUN_AZIMUTH,
        moonlight=Moonlight(moon, shown),
        **options,
    )
    return Scene(planet, settings)


def flux_of_disc(lit):
    """XYZ by all pixels of the disc, whichever way they look, as RGB. [lx]"""
    total = 0.0
    for canvas in lit.settings.view.projection.canvases():
        (part,) = canvas.parts
        pixels = Raster(lit, canvas).band("moon", 0, canvas.height).astype(float)
        size = part.chart.solid_angles(0, canvas.height)
        total += float(((pixels @ lit.luminance) * size).sum())
    return total


@pytest.mark.parametrize(
    "projection",
    [
        Equirect(64),
        Equirect(1024),
        Cubemap(64),
        Fisheye(128),
        Angular(128),
        Octahedral(128),
        Perspective(64, 48, math.radians(40.0), math.radians(140.0), math.radians(60.0)),
        Perspective(300, 200, math.radians(1.0), math.radians(140.0), math.radians(60.0)),
    ],
    ids=lambda each: f"{each.name}-{each.label}",
)
def test_every_projection_holds_the_light_of_the_disc(projection):
    lit = scene(by_hand(phase=70.0), projection)
    normal, _ = lit.moonlit.xyz()
    assert flux_of_disc(lit) == pytest.approx(normal[1], rel=0.01)


def test_a_full_moon_60_deg_high_lights_a_plain_as_it_is_measured():
    lit = scene(by_hand(), method="full")
    attributes = moon_attributes(lit)
    whole = attributes["skybake:moonIlluminance"] + lit.sky_illuminance()
    assert 0.25 < whole < 0.32
    assert attributes["skybake:moonPhaseAngle"] == pytest.approx(2.0)
    assert attributes["skybake:moonIlluminatedFraction"] == pytest.approx(0.9997, abs=1e-4)
    facing = attributes["skybake:moonNormalIlluminance"]
    assert attributes["skybake:moonIlluminance"] == pytest.approx(
        facing * math.sin(math.radians(60.0)), rel=1e-3
    )
    red, green, blue = attributes["skybake:moonColour"]
    assert red > green > blue


def test_a_map_is_the_sum_of_what_it_holds_without_the_moon_and_of_the_moon_alone():
    frame = CelestialFrame("earth", 1.0, math.radians(31.0))
    whole, without, alone = (
        image_of_scene(
            scene(by_hand(30.0, 90.0), shown=shown, sun=-20.0, night=Night(frame))
        ).pixels
        for shown in ("include", "exclude", "only")
    )
    assert whole == pytest.approx(without + alone, rel=1e-4, abs=1e-7)
    assert alone.max() > 1.0
    assert (alone.min(), without.max() < 1.0) == (pytest.approx(0.0, abs=1e-4), True)


def test_the_moon_by_day_is_a_disc_before_a_sky_that_stays_as_it_was():
    day, moonless = (scene(moon, sun=20.0) for moon in (by_hand(50.0, 80.0), None))
    pixels, sky = (image_of_scene(each).pixels @ each.luminance for each in (day, moonless))
    seen = pixels != sky
    assert 0 < np.count_nonzero(seen) < 10
    assert day.sky_illuminance() == moonless.sky_illuminance()
    assert day.moonlit.lights_air is False


def test_a_moon_below_the_horizon_is_not_in_the_map():
    low = scene(by_hand(-30.0))
    assert low.layer_names == ("sky", "sun")
    assert moon_attributes(low)["skybake:moonNormalIlluminance"] == 0.0
    assert (image_of_scene(low).pixels == image_of_scene(scene()).pixels).all()


def test_the_disc_is_left_out_with_that_of_the_sun_and_its_light_stays():
    lit = scene(by_hand(), sun_disc="exclude")
    assert lit.layer_names == ("sky",)
    assert lit.sky_illuminance() == pytest.approx(scene(by_hand()).sky_illuminance())


def test_stars_behind_the_moon_are_not_seen():
    frame = CelestialFrame("earth", 1.0, math.radians(31.0))
    night = Night(frame)
    stars = scene(night=night, sun=-30.0).stars
    x, y, z = stars.vectors[0]
    behind = moon_by_hand(math.atan2(x, -z), math.asin(y), 3.0, 0.0, -0.5)
    before, after = (
        star_xyz(lit, lit.stars)
        for lit in (scene(moon, night=night, sun=-30.0) for moon in (None, behind))
    )
    assert before[0, 1] > 0.0 == after[0, 1]
    assert (after[1:, 1] > 0.0).mean() > 0.99


def krisciunas_and_schaefer(moon_zenith, zenith, apart, phase, extinction=0.172):
    """V of the sky in moonlight, their equations 3, 15, 20 and 21. [mag arcsec⁻²]"""
    light = 10 ** (-0.4 * (3.84 + 0.026 * abs(phase) + 4e-9 * phase**4))
    scattering = 10**5.36 * (1.06 + math.cos(math.radians(apart)) ** 2) + 10 ** (6.15 - apart / 40)

    def mass(angle):
        return (1.0 - 0.96 * math.sin(math.radians(angle)) ** 2) ** -0.5

    nanolamberts = (
        scattering
        * light
        * 10 ** (-0.4 * extinction * mass(moon_zenith))
        * (1.0 - 10 ** (-0.4 * extinction * mass(zenith)))
    )
    return (20.7233 - math.log(nanolamberts / 34.08)) / 0.92104


@pytest.mark.parametrize("moon_zenith", [15.0, 45.0, 70.0])
def test_the_moonlit_sky_is_as_bright_as_it_was_measured(moon_zenith):
    sky = Sky("earth-clear", math.radians(90.0 - moon_zenith))
    nodes = sky.wavelengths
    sun = sunlight(star_at(sky.planet.star, 1.0), nodes)
    # A star of V = 0 with the colour of moonlight, for the band that V is.
    zero = star_irradiance(np.array([0.0]), np.array([0.9]), nodes)[0]
    band = np.exp(-0.5 * ((nodes - 548.0) / 38.0) ** 2)
    arcsecond = math.radians(1.0 / 3600.0) ** 2
    off = []
    for phase in (7.0, 45.0, 90.0):
        angle = math.radians(phase)
        moon = sun * moon_share(angle, nodes, 384_400.0, sun_longitude=-angle)
        for zenith, azimuth in ((0, 0), (30, 90), (60, 90), (60, 180), (30, 180), (75, 60)):
            mu, mu_moon = (math.cos(math.radians(each)) for each in (zenith, moon_zenith))
            flat = math.sin(math.radians(zenith)) * math.sin(math.radians(moon_zenith))
            nu = mu * mu_moon + flat * math.cos(math.radians(azimuth))
            seen = moon * sky.radiance_per_irradiance(np.array([mu]), np.array([nu]))[0]
            v = -2.5 * math.log10((seen * band).sum() * arcsecond / (zero * band).sum())
            apart = math.degrees(math.acos(nu))
            off.append(v - krisciunas_and_schaefer(moon_zenith, zenith, apart, phase))
    assert len(off) == 18
    assert np.abs(off).max() < 0.25
    assert np.abs(off).mean() < 0.15
