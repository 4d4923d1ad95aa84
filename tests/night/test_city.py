"""The glow of cities."""

import math

import numpy as np
import pytest

from skybake.colour.observer import xyz_weights
from skybake.ephemeris.celestial import CelestialFrame
from skybake.errors import InputError
from skybake.image.night import Night
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.night.channels import Channels
from skybake.night.city import (
    _LED,
    _SODIUM,
    CITY_RADIUS,
    _bands,
    ground_response,
    lamp_channels,
    lit_by_disc,
    toward_city,
)
from skybake.night.dome import NightDome
from skybake.preset import load_preset
from skybake.sky.sky import WAVELENGTHS, Sky

WEIGHTS = xyz_weights(WAVELENGTHS, np.array([300.0, 900.0]), np.ones(2))


# CIE 15: the standard high-pressure sodium lamp HP1, and LED-B3 of 4103 K.
@pytest.mark.parametrize(("bands", "x", "y"), [(_SODIUM, 0.533, 0.415), (_LED, 0.3756, 0.3723)])
def test_lamps_have_their_colours(bands, x, y):
    xyz = _bands(WAVELENGTHS, bands) @ WEIGHTS
    assert xyz[:2] / xyz.sum() == pytest.approx((x, y), abs=0.012)


def test_half_of_the_light_is_of_either_lamp():
    spectrum = lamp_channels(Channels(Sky("earth", 0.5)))
    assert spectrum @ WEIGHTS[:, 1] == pytest.approx(1.0)
    sodium = _bands(WAVELENGTHS, _SODIUM)
    sodium /= 2.0 * (sodium @ WEIGHTS[:, 1])
    led = spectrum - sodium
    assert (led >= 0.0).all()
    assert led @ WEIGHTS[:, 1] == pytest.approx(0.5)


def test_a_city_is_brighter_toward_its_bearing():
    east, west, zenith = np.array([[1.0, 0, 0], [-1.0, 0, 0], [0, 1.0, 0]])
    factor = toward_city(np.stack([east, west, zenith]), math.radians(90.0))
    np.testing.assert_allclose(factor, [1.9, 0.1, 1.0])
    assert (toward_city(np.stack([east, west]), None) == 1.0).all()


def test_a_city_lights_planes_as_a_disc_does():
    above = lit_by_disc(np.zeros(3), np.array([1e-6, CITY_RADIUS, 3.0 * CITY_RADIUS]))
    assert above == pytest.approx([1.0, 0.5, 0.1])
    beside = lit_by_disc(CITY_RADIUS * np.array([0.5, 1.0, 1.5, 20.0]), np.full(4, 1e-3))
    assert beside == pytest.approx([1.0, 0.5, 0.0, 0.0], abs=1e-4)


def test_the_zenith_has_the_luminance_that_is_asked_for_and_the_horizon_is_brighter():
    # Of three wavelengths, whose solution without a ground takes the least time.
    sky = Sky("earth-hillaire2020", math.radians(-60.0), method="hillaire")
    frame = CelestialFrame("earth", 1.0, 0.5)
    lit, dark = (NightDome(sky, frame, city=each).xyz[..., 1] for each in (2e-3, 0.0))
    glow = (lit - dark)[:, 0]
    assert glow[0] == pytest.approx(2e-3, rel=1e-6)
    assert 2.0 < glow[250] / glow[0] < 4.0
    # The ground shows what falls on it, not lamps.
    assert 0.0 < glow[-1] < glow[0]
    np.testing.assert_allclose(lit - dark, np.broadcast_to(glow[:, None], lit.shape), atol=1e-9)


@pytest.mark.slow
def test_the_answer_of_the_air_does_not_depend_on_the_ground():
    zenith = np.radians([0.0, 60.0, 80.0, 88.0])
    grey, white = (
        ground_response(Sky(load_preset("earth-clear", {"ground.albedo": albedo}), 0.5), zenith)
        for albedo in (0.3, 0.6)
    )
    np.testing.assert_allclose(grey, white, rtol=1e-4)
    # 5 to 1 at 590 nm between the horizon and the zenith, where an endless city makes 12 to 1.
    at = np.argmin(abs(WAVELENGTHS - 590.0))
    assert grey[3, at] / grey[0, at] == pytest.approx(4.86, rel=0.03)


def test_from_space_a_glow_by_its_zenith_is_refused():
    settings = map_settings(size=64, altitude=400.0, night=Night(city=1e-3))
    with pytest.raises(InputError, match="light pollution: must be seen from below the top of the"):
        Scene(load_preset("earth"), settings)


@pytest.mark.parametrize("city", [-0.1, 1.1, math.nan])
def test_a_glow_beyond_bounds_is_refused(city):
    with pytest.raises(InputError, match="light pollution: must be from 0 to 1000mcd"):
        Night(city=city)
