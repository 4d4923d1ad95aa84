import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skybake.errors import InputError
from skybake.preset import load_preset
from skybake.sky.sky import Sky
from tests.skies import view_cosines

EARTH = load_preset("earth")
FEW = np.array([440.0, 550.0, 680.0])


def sky(planet=EARTH, elevation=20.0, altitude=0.0, **options):
    """A sky of three wavelengths by Hillaire's closure, which is built fast."""
    options = {"wavelengths": FEW, "method": "hillaire", **options}
    return Sky(planet, math.radians(elevation), altitude, **options)


DAY = sky()


def direction(zenith, bearing):
    zenith, bearing = np.radians(zenith), np.radians(bearing)
    return np.stack(
        [np.sin(zenith) * np.sin(bearing), np.cos(zenith), -np.sin(zenith) * np.cos(bearing)],
        axis=-1,
    )


@pytest.mark.parametrize(
    ("bearing", "axis"), [(0, (0, 0, -1)), (90, (1, 0, 0)), (180, (0, 0, 1)), (270, (-1, 0, 0))]
)
def test_bearings_of_the_sun_are_a_compass(bearing, axis):
    low = sky(elevation=0.0, sun_azimuth=math.radians(bearing))
    np.testing.assert_allclose(low.sun_direction, axis, atol=1e-12)


def test_a_sun_in_the_zenith_is_up():
    np.testing.assert_allclose(sky(elevation=90.0).sun_direction, (0, 1, 0), atol=1e-12)


@given(st.floats(0.0, 180.0), st.floats(0.0, 180.0))
def test_sky_is_symmetric_about_the_plane_of_the_sun(zenith, azimuth):
    left, right = DAY.radiance(direction(np.full(2, zenith), 180.0 + np.array([-1, 1]) * azimuth))
    np.testing.assert_allclose(left, right, rtol=1e-9)


@pytest.mark.parametrize("zenith", [0.0, 180.0])
def test_sky_is_one_at_the_zenith_and_at_the_nadir(zenith):
    around = DAY.radiance(direction(np.full(9, abs(zenith - 1e-6)), np.linspace(0.0, 360.0, 9)))
    np.testing.assert_allclose(around, around[:1].repeat(9, axis=0), rtol=1e-6)


def test_only_the_angle_to_the_sun_turns_with_it():
    east = sky(sun_azimuth=math.radians(90.0))
    views = direction([30.0, 60.0, 89.0, 130.0], [10.0, 50.0, 120.0, 300.0])
    turned = direction([30.0, 60.0, 89.0, 130.0], np.array([10.0, 50.0, 120.0, 300.0]) - 90.0)
    np.testing.assert_allclose(DAY.radiance(views), east.radiance(turned), rtol=1e-12)


def test_length_of_a_direction_does_not_matter():
    views = direction([10.0, 80.0], [0.0, 200.0])
    np.testing.assert_allclose(DAY.radiance(views), DAY.radiance(1e-3 * views), rtol=1e-12)


def test_any_shape_of_directions_is_kept():
    views = np.broadcast_to(direction(30.0, 0.0), (2, 5, 3))
    assert DAY.radiance(views).shape == (2, 5, 3)


def test_radiance_is_that_of_unit_irradiance_times_the_stars():
    mu, nu = view_cosines(np.array([20.0, 70.0]), np.array([0.0, 90.0]), 20.0)
    views = direction([20.0, 70.0], [180.0, 270.0])
    expected = DAY.radiance_per_irradiance(mu, nu) * DAY.irradiance
    np.testing.assert_allclose(DAY.radiance(views), expected, rtol=1e-9)


def test_a_wavelength_does_not_depend_on_those_beside_it():
    one = sky(wavelengths=FEW[1:2])
    views = direction([5.0, 45.0, 88.0, 120.0], [180.0, 90.0, 0.0, 30.0])
    np.testing.assert_allclose(one.radiance(views)[:, 0], DAY.radiance(views)[:, 1], rtol=1e-3)


@settings(max_examples=60)
@given(
    st.floats(-90.0, 90.0),
    st.one_of(st.floats(0.0, 100.0), st.floats(100.0, 1e6)),
    st.floats(0.0, 180.0),
    st.floats(0.0, 180.0),
)
def test_no_sun_no_place_and_no_view_gives_less_than_nothing(elevation, altitude, zenith, azimuth):
    one = sky(elevation=elevation, altitude=altitude)
    one.__dict__["atmosphere"] = DAY.atmosphere
    radiance = one.radiance_per_irradiance(*view_cosines(np.array([zenith]), azimuth, elevation))
    assert np.isfinite(radiance).all()
    assert (radiance >= 0.0).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((EARTH, math.radians(95.0)), "sun elevation: must be from -90 to 90 deg, got 95 deg"),
        ((EARTH, math.nan), "sun elevation"),
        ((EARTH, 0.1, -0.001), "altitude: must be at least 0 m, got -1 m"),
        ((EARTH, 0.1, math.inf), "altitude"),
        ((EARTH, 0.1, math.nan), "altitude"),
    ],
)
def test_impossible_suns_and_places_are_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        Sky(*arguments)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"sun_azimuth": math.inf}, "sun azimuth: must be finite"),
        ({"method": "magic"}, "method: must be one of full, scalar, hillaire, march, got 'magic'"),
    ],
)
def test_impossible_options_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        Sky(EARTH, 0.1, **options)


@pytest.mark.parametrize("views", [[0.0, 0.0, 0.0], [math.nan, 1.0, 0.0], [math.inf, 0.0, 0.0]])
def test_directions_without_a_direction_are_refused(views):
    with pytest.raises(InputError, match="directions: must be finite and longer than 0"):
        DAY.radiance(views)
