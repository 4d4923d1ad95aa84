"""The light of an evening that ends in a moonlit night."""

import math

import numpy as np
import pytest

from skybake.ephemeris.moment import TimeSpan
from skybake.ephemeris.place import Place
from skybake.image.moonlight import Moonlight
from skybake.image.night import Night
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset

ATACAMA = Place(math.radians(-24.6), math.radians(-70.4))
EVENING = TimeSpan("2026-08-21T21:40Z", "2026-08-22T00:10Z", ATACAMA)


def scene(moment, preset="earth-hillaire2020"):
    settings = map_settings(
        size=(128, 64),
        sun_elevation=moment.sun_elevation,
        sun_azimuth=moment.sun_azimuth,
        method="hillaire",
        night=Night(moment.celestial),
        moonlight=Moonlight(moment.lit_moon),
    )
    return Scene(load_preset(preset), settings)


def test_a_world_of_three_wavelengths_has_the_same_moon():
    last = EVENING.moments(2)[1]
    paper, earth = (
        scene(last, preset).moonlit.illuminance_above
        for preset in ("earth-hillaire2020", "earth-clear")
    )
    assert paper == pytest.approx(earth, rel=0.02)


@pytest.mark.slow
def test_from_day_to_night_light_falls_without_a_jump():
    moments = EVENING.moments(31)
    light = [scene(moment).sky_illuminance() for moment in moments]
    assert light[0] > 4e3
    assert 1e-3 < light[-1] < 0.02
    falls = -np.diff(np.log(light))
    # In five minutes at most by 1.3, and from one such step to the next that changes little.
    assert (falls > 0.0).all()
    assert falls.max() < 1.4
    assert np.abs(np.diff(falls)).max() < 0.4
    assert falls[-5:].max() < 0.01
