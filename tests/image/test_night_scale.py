"""The scale of maps of a night."""

import math

import numpy as np

from skybake.ephemeris.celestial import CelestialFrame
from skybake.image.night import Night
from skybake.image.night_scale import night_scaled
from skybake.image.settings import map_settings

LIT = Night(CelestialFrame("earth", 0.0, 0.5))


def at(elevation, night=LIT):
    return map_settings(size=(64, 32), sun_elevation=math.radians(elevation), night=night)


def evs(*maps):
    return [each.encoding.ev for each in night_scaled(maps)]


def test_a_map_of_a_night_has_the_scale_of_a_night():
    assert evs(at(-8.1)) == [-3.0]
    assert evs(at(-7.9)) == [None]


def test_a_sequence_has_one_scale():
    assert evs(at(-30.0), at(-9.0)) == [-3.0, -3.0]
    assert evs(at(-30.0), at(-7.0)) == [None, None]


def test_a_black_night_keeps_its_scale():
    assert evs(at(-30.0, Night())) == [None]
    assert evs(at(-30.0, Night(LIT.frame, is_shown=False))) == [None]


def test_half_floats_hold_dark_ground_and_a_full_moon_at_this_scale():
    (night,) = night_scaled([at(-30.0)])
    for luminance in (1e-5, 2e-4, 5e3):
        value = luminance / night.encoding.white_luminance
        assert abs(float(np.float16(value)) / value - 1.0) < 5e-4
