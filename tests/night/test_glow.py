"""Airglow, zodiacal light and the Milky Way above the air."""

import math

import numpy as np
import pytest

from skybake.colour.observer import load_observer
from skybake.ephemeris.celestial import TO_ECLIPTIC
from skybake.night.airglow import airglow_layers, path_through
from skybake.night.milky_way import DIFFUSE, TO_GALAXY, starlight, starlight_spectrum
from skybake.night.zodiacal import zodiacal_colours, zodiacal_light

EARTH = 6371.0
LOW, HIGH = airglow_layers()
NODES, BARS = load_observer()


def test_airglow_has_the_luminance_of_its_parts():
    luminance = sum(
        683.002 * layer.radiance @ np.interp(layer.wavelengths, NODES, BARS[:, 1], 0.0, 0.0)
        for layer in (LOW, HIGH)
    )
    # 200 R of the green line are 3.87e-5 cd/m2, the continuum is 1.06e-4, the rest 2.5e-5.
    assert luminance == pytest.approx(1.68e-4, rel=0.03)
    green = LOW.wavelengths == 557.7
    assert 683.0 * 0.999 * LOW.radiance[green].sum() == pytest.approx(3.87e-5, rel=0.02)


@pytest.mark.parametrize("zenith", [0.0, 30.0, 60.0, 80.0])
@pytest.mark.parametrize("layer", [LOW, HIGH])
def test_a_thin_layer_brightens_toward_the_horizon_as_van_rhijn_has_it(layer, zenith):
    sine = EARTH / (EARTH + layer.height) * math.sin(math.radians(zenith))
    near, far = path_through(layer, EARTH, EARTH, np.cos(np.radians([zenith])))
    assert near[0] == 0.0
    assert far[0] == pytest.approx(1.0 / math.sqrt(1.0 - sine**2), rel=0.01)


def test_from_orbit_the_layer_is_a_ring_about_the_earth():
    zenith = np.radians(np.linspace(90.0, 180.0, 9001))
    near, far = path_through(LOW, EARTH, EARTH + 400.0, np.cos(zenith))
    brightest = zenith[np.argmax(near + far)]
    tangent = (EARTH + 400.0) * math.sin(brightest) - EARTH
    assert tangent == pytest.approx(89.0, abs=4.0)
    assert (near + far).max() / near[-1] == pytest.approx(65.0, rel=0.3)
    assert near[-1] == pytest.approx(1.0, rel=1e-3)
    assert far[-1] == 0.0


def test_the_zodiacal_light_is_that_of_the_table():
    longitude, latitude = np.radians([[90.0, 180.0, 30.0, 300.0], [0.0, 0.0, 0.0, 5.0]])
    light = zodiacal_light(longitude, latitude) / 1e-11
    np.testing.assert_allclose(light, [259.0, 230.0, 2480.0, 442.0])
    assert zodiacal_light(np.array([1.0]), np.array([math.pi / 2]))[0] == pytest.approx(77e-11)
    near_sun = zodiacal_light(np.radians([2.0, 14.0, 16.0]), np.zeros(3))
    assert (np.diff(np.log(near_sun)) < 0.0).all()


def test_the_zodiacal_light_is_redder_than_the_sun_near_it():
    near, far = zodiacal_colours(np.array([400.0, 500.0, 700.0]))
    assert near[0] < far[0] < 1.0 < far[2] < near[2]
    np.testing.assert_allclose((near[1], far[1]), 1.0)


def test_the_poles_of_the_galaxy_and_the_ecliptic_are_where_they_are():
    def place(degrees):
        ra, dec = np.radians(degrees)
        return np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])

    np.testing.assert_allclose(TO_GALAXY @ place((192.85948, 27.12825)), [0, 0, 1], atol=1e-6)
    np.testing.assert_allclose(TO_GALAXY @ place((266.405, -28.936)), [1, 0, 0], atol=1e-4)
    np.testing.assert_allclose(TO_ECLIPTIC @ place((270.0, 66.5607)), [0, 0, 1], atol=1e-5)


def test_starlight_has_its_mean_and_is_brightest_in_the_milky_way():
    vectors = np.random.default_rng(3).normal(size=(200000, 3))
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    light = starlight(vectors) / DIFFUSE
    # Stars of V = 10 to the square degree; Allen (1973) has 105 with the bright ones.
    assert light.mean() == pytest.approx(103.0, rel=0.02)
    at_pole = light[np.abs(vectors[:, 2]) > 0.95]
    in_plane = light[np.abs(vectors[:, 2]) < 0.03]
    assert 30.0 < at_pole.mean() < 50.0
    assert in_plane.mean() > 5.0 * at_pole.mean()


def test_one_star_to_the_square_degree_has_its_luminance():
    nodes = np.arange(380.0, 781.0)
    luminous = np.interp(nodes, NODES, BARS[:, 1])
    assert 683.002 * (starlight_spectrum(nodes) @ luminous) == pytest.approx(8.6e-7, rel=0.02)
