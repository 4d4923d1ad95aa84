import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.colour.exposure import auto_ev, luminance_from_ev, luminance_from_units
from skybake.errors import InputError

SKY_ON_DISPLAY = 0.36


def graded_sky(zenith, horizon, ground=None):
    """Luminance from zenith to horizon, with the ground at a tenth of the zenith's."""
    sky = np.geomspace(zenith, horizon, 64)
    below = np.full(64, zenith / 10.0 if ground is None else ground)
    return np.broadcast_to(np.concatenate([sky, below])[:, None], (128, 256)).copy()


def shown(luminance, ev):
    return luminance / luminance_from_ev(ev)


def test_units_are_candela_or_exposed_for_ev_15():
    assert luminance_from_units("nits") == 1.0
    assert luminance_from_units("ev15") == 1.2 * 2**15 == luminance_from_ev(15.0)


def test_unknown_units_are_refused_with_the_known_ones():
    with pytest.raises(InputError, match="units: must be one of ev15, nits, got 'lux'"):
        luminance_from_units("lux")


@pytest.mark.parametrize("ev", [math.nan, math.inf, -31.0, 41.0])
def test_an_exposure_value_out_of_range_is_refused(ev):
    with pytest.raises(InputError, match="ev: must be within -30 to 40"):
        luminance_from_ev(ev)


@given(st.floats(1e-4, 1e5))
def test_a_uniform_sky_is_shown_at_its_brightness_whatever_it_is(luminance):
    ev = auto_ev(np.full((64, 128), luminance))

    assert shown(luminance, ev) == pytest.approx(SKY_ON_DISPLAY, rel=1e-9)


@pytest.mark.parametrize(("zenith", "horizon"), [(2e3, 2e4), (100.0, 5e3), (1e-5, 1e-4)])
def test_noon_sunset_and_deep_twilight_stay_within_four_stops_of_middle_grey(zenith, horizon):
    ev = auto_ev(graded_sky(zenith, horizon))

    assert shown(zenith, ev) > 0.18 / 2**4
    assert shown(horizon, ev) < 0.18 * 2**4


def test_the_sun_does_not_change_the_exposure():
    sky = graded_sky(2e3, 8e3)
    without = auto_ev(sky)
    sky[30:32, 100:102] = 1.6e9

    assert auto_ev(sky) == pytest.approx(without, abs=0.02)


def test_a_lit_planet_below_black_space_is_exposed_for_the_planet():
    """The sun stands in the black half, which must not count as a sky."""
    space = graded_sky(1e-30, 1e-30, ground=5e3)
    space[20, 100] = 1.6e9

    assert shown(5e3, auto_ev(space)) == pytest.approx(SKY_ON_DISPLAY, rel=0.01)


def test_a_dark_sky_high_above_bright_ground_leaves_the_ground_below_white():
    assert shown(5e3, auto_ev(graded_sky(50.0, 500.0, ground=5e3))) <= 2.0 + 1e-9


def test_a_map_of_black_or_of_rounding_noise_below_zero_gets_a_finite_exposure():
    assert auto_ev(np.zeros((64, 128))) == 0.0
    assert auto_ev(np.full((64, 128), -1e-7)) == 0.0


def test_starless_night_is_not_brightened_without_end():
    assert auto_ev(np.full((64, 128), 1e-12)) == -20.0


@pytest.mark.parametrize("shape", [(1, 1), (1, 2), (2, 4), (96, 16), (513, 1026)])
def test_maps_of_any_shape_are_exposed(shape):
    assert shown(70.0, auto_ev(np.full(shape, 70.0))) == pytest.approx(SKY_ON_DISPLAY)
