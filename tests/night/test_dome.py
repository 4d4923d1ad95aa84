"""The night's sky at the ground and from orbit, against published luminances."""

import math

import numpy as np
import pytest

from skybake.angles import direction_from_angles
from skybake.ephemeris.celestial import CelestialFrame
from skybake.night.air import ABOVE, row_zeniths
from skybake.night.dome import NightDome
from skybake.sky.sky import Sky

GALACTIC_POLE_OVERHEAD = CelestialFrame("earth", math.radians(192.9), math.radians(27.1))


def dome(frame=GALACTIC_POLE_OVERHEAD, *, altitude=0.0, sun=(-60.0, 0.0), **options):
    elevation, azimuth = map(math.radians, sun)
    sky = Sky("earth-clear", elevation, altitude, sun_azimuth=azimuth)
    return NightDome(sky, frame, **options)


@pytest.fixture(scope="module")
def dark():
    return dome()


def magnitude(luminance):
    """Of a square arcsecond, in V, of a spectrum like the sun's."""
    return 12.58 - 2.5 * math.log10(luminance)


def horizontal(night):
    zenith = row_zeniths(night.zenith_horizon)[:ABOVE]
    mean = night.xyz[:ABOVE, :, 1].mean(axis=1)
    return 2.0 * math.pi * np.trapezoid(mean * np.sin(zenith) * np.cos(zenith), zenith)


def test_the_zenith_of_a_dark_place_is_as_dark_as_measured(dark):
    # Falchi et al. (2016) take 22.0 for a natural sky, Patat (2003) has 21.6 at solar maximum.
    assert 21.55 < magnitude(dark.xyz[0, :, 1].mean()) < 22.0
    x, y, z = dark.xyz[0].mean(axis=0)
    # Redder than the sun at 0.323, 0.333: B-V is about 1.
    assert (x / (x + y + z), y / (x + y + z)) == pytest.approx((0.358, 0.367), abs=0.01)


def test_the_ground_of_a_moonless_night_has_a_millilux(dark):
    assert 0.6e-3 < horizontal(dark) < 1.4e-3


def test_airglow_alone_is_the_same_all_round_and_brighter_low():
    alone = dome(zodiacal=0.0).xyz - dome(airglow=0.0, zodiacal=0.0).xyz
    np.testing.assert_allclose(alone, np.broadcast_to(alone[:, :1], alone.shape), rtol=1e-9)
    zenith = np.degrees(row_zeniths(math.pi / 2)[:ABOVE])
    at = [alone[np.argmin(abs(zenith - each)), 0, 1] for each in (0.0, 60.0, 80.0)]
    assert 1.5 < at[1] / at[0] < 2.0
    assert 1.8 < at[2] / at[0] < 3.5


def test_zodiacal_light_stands_over_the_sun():
    # Without Milky Way: the difference of two skies.
    frame = CelestialFrame("earth", math.radians(90.0), 0.0)
    sun = (-20.0, 280.0)
    with_it, without = (dome(frame, sun=sun, airglow=0.0, zodiacal=each).xyz for each in (1.0, 0.0))
    light = (with_it - without)[:ABOVE, :, 1]
    low = np.argmin(abs(row_zeniths(math.pi / 2)[:ABOVE] - math.radians(70.0)))
    brightest = np.argmax(light[low]) * 0.5
    assert brightest == pytest.approx(280.0, abs=25.0)
    assert light[low].max() > 5.0 * np.median(light[low])


def test_from_orbit_airglow_is_brighter_above_the_limb_than_beside_it():
    ring = dome(altitude=400.0, zodiacal=0.0)
    luminance = ring.xyz[:, :, 1].mean(axis=1)
    zenith = np.degrees(row_zeniths(ring.zenith_horizon))
    brightest = zenith[np.argmax(luminance)]
    # A tangent height of about 90 km.
    assert brightest == pytest.approx(107.5, abs=0.5)
    assert luminance.max() > 20.0 * luminance[np.argmin(abs(zenith - 90.0))]


@pytest.mark.slow
def test_zodiacal_light_is_dimmer_from_mars():
    frame = CelestialFrame("mars", 1.0, 0.0)

    def zodiacal(preset):
        sky = Sky(preset, math.radians(-60.0), method="hillaire")
        night, without = (
            NightDome(sky, frame, airglow=0.0, zodiacal=each).xyz[0, 0, 1] for each in (1.0, 0.0)
        )
        return night - without

    # It falls with the distance to the power of 2.3, and dust dims it on Mars.
    assert zodiacal("mars-clear") / zodiacal("earth-clear") == pytest.approx(0.38, abs=0.08)


def test_milky_way_is_where_its_stars_are():
    frame = CelestialFrame("earth", math.radians(266.4), math.radians(-28.9))
    night = dome(frame, airglow=0.0, zodiacal=0.0)
    # The centre of the galaxy is in the zenith, and its plane crosses the sky.
    elevation = 0.5 * math.pi - row_zeniths(night.zenith_horizon)[:ABOVE]
    bearing = 2.0 * math.pi * np.arange(720) / 720
    up = direction_from_angles(bearing, elevation[:, None])[..., 1]
    luminance = night.xyz[:ABOVE, :, 1]
    assert luminance[up > 0.97].mean() > 3.0 * np.median(luminance[(up > 0.3) & (up < 0.6)])


def test_a_world_of_three_wavelengths_has_the_same_night():
    frame = GALACTIC_POLE_OVERHEAD

    def night(preset):
        sky = Sky(preset, math.radians(-60.0), method="hillaire")
        return NightDome(sky, frame).xyz

    paper, earth = night("earth-hillaire2020"), night("earth-clear")
    np.testing.assert_allclose(paper[0, 0], earth[0, 0], rtol=0.1)
    assert paper[:ABOVE].min() > 0.0
