import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.colour.exposure import auto_ev, luminance_from_ev, luminance_from_units
from skybake.colour.space import find_colour_space
from skybake.errors import InputError
from skybake.formats.preview import display_values
from skybake.projection.equirect import directions, row_zeniths, solid_angles

SKY_ON_DISPLAY, PLANET_ON_DISPLAY = 0.36, 0.7


def graded_sky(zenith, horizon, ground=None):
    """Luminance from zenith to horizon, with the ground at a tenth of the zenith's."""
    sky = np.geomspace(zenith, horizon, 64)
    below = np.full(64, zenith / 10.0 if ground is None else ground)
    return np.broadcast_to(np.concatenate([sky, below])[:, None], (128, 256)).copy()


def map_ev(luminance):
    """Of an equirect map."""
    rows, columns = luminance.shape
    above = row_zeniths(rows)[:, None] < math.pi / 2.0
    return auto_ev(luminance, solid_angles(columns, rows)[:, None], above)


def with_aureole(sky, peak, radius):
    """Around a sun 20 deg high in the south, halved every `radius` degrees."""
    toward = np.array([0.0, math.sin(math.radians(20.0)), math.cos(math.radians(20.0))])
    rows, columns = sky.shape
    distance = np.degrees(np.arccos(np.clip(directions(columns, rows) @ toward, -1.0, 1.0)))
    above = row_zeniths(rows)[:, None] < math.pi / 2.0
    return sky + np.where(above, peak * 0.5 ** (distance / radius), 0.0), distance


def codes(colour, luminance, ev, view="aces1"):
    """Display values of a colour of luminance 1 at a luminance."""
    pixel = np.array(colour, np.float32) * shown(luminance, ev)
    space = find_colour_space("lin_rec709")
    return display_values(pixel.reshape(1, 1, 3).astype(np.float32), space, view)[0, 0]


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
    ev = map_ev(np.full((64, 128), luminance))

    assert shown(luminance, ev) == pytest.approx(SKY_ON_DISPLAY, rel=1e-9)


@pytest.mark.parametrize(("zenith", "horizon"), [(2e3, 2e4), (100.0, 5e3), (1e-5, 1e-4)])
def test_noon_sunset_and_deep_twilight_stay_within_four_stops_of_middle_grey(zenith, horizon):
    ev = map_ev(graded_sky(zenith, horizon))

    assert shown(zenith, ev) > 0.18 / 2**4
    assert shown(horizon, ev) < 0.18 * 2**4


def test_the_sun_does_not_change_the_exposure():
    sky = graded_sky(2e3, 8e3)
    without = map_ev(sky)
    sky[30:32, 100:102] = 1.6e9

    assert map_ev(sky) == pytest.approx(without, abs=0.02)


def test_a_lit_planet_below_black_space_is_exposed_for_the_planet():
    """The sun stands in the black half, which must not count as a sky."""
    space = graded_sky(1e-30, 1e-30, ground=5e3)
    space[20, 100] = 1.6e9

    assert shown(5e3, map_ev(space)) == pytest.approx(PLANET_ON_DISPLAY, rel=0.01)


def test_a_dark_sky_high_above_bright_ground_leaves_the_ground_below_white():
    ev = map_ev(graded_sky(50.0, 500.0, ground=5e3))

    assert codes((1.0, 1.0, 1.0), 5e3, ev).max() < 0.9


def test_the_light_around_the_sun_goes_white_and_leaves_the_sky_bright():
    """As on Mars: seven stops above the sky, halved every 3 deg."""
    sky = graded_sky(500.0, 1e3, ground=100.0)
    glow, distance = with_aureole(sky, 1e5, 3.0)
    ev = map_ev(glow)

    assert codes((1.0, 1.0, 1.0), np.median(glow[distance < 4.0]), ev).min() > 250 / 255
    assert ev - map_ev(sky) < 0.5


def test_a_night_side_does_not_brighten_the_lit_part_of_a_planet():
    planet = graded_sky(1e-30, 1e-30, ground=5e3)
    planet[64:, 40:] = 1e-3

    assert shown(5e3, map_ev(planet)) == pytest.approx(PLANET_ON_DISPLAY, rel=0.01)


@pytest.mark.parametrize("ground", [1e-6, 1e3, 4e3])
def test_ground_darker_than_the_sky_does_not_change_the_exposure(ground):
    sky = graded_sky(4e3, 4e3, ground=ground)

    assert shown(4e3, map_ev(sky)) == pytest.approx(SKY_ON_DISPLAY, rel=1e-9)


def test_snow_brighter_than_the_sky_stays_below_white():
    ev = map_ev(graded_sky(2e3, 2e3, ground=2e4))

    assert shown(2e4, ev) == pytest.approx(PLANET_ON_DISPLAY)


def test_a_climb_into_space_changes_the_exposure_without_a_step():
    """The sky darkens by a factor of e with each step, down to a luminance of nothing."""
    evs = np.array([map_ev(graded_sky(4e3 / np.exp(k), 8e3 / np.exp(k), 3e3)) for k in range(80)])

    assert np.abs(np.diff(evs)).max() < 1.0 / math.log(2.0) + 1e-9
    assert np.ptp(evs[10:]) < 1e-9


def test_a_value_counts_by_its_solid_angle():
    luminance, solid_angle = np.array([100.0, 400.0]), np.array([3.0, 1.0])

    assert auto_ev(luminance, solid_angle) == pytest.approx(
        auto_ev(np.array([100.0, 100.0, 100.0, 400.0]))
    )


def test_a_map_of_black_or_of_rounding_noise_below_zero_gets_a_finite_exposure():
    assert map_ev(np.zeros((64, 128))) == 0.0
    assert map_ev(np.full((64, 128), -1e-7)) == 0.0


def test_starless_night_is_not_brightened_without_end():
    assert map_ev(np.full((64, 128), 1e-12)) == -20.0
