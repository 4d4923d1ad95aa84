"""The sun as seen from Mars, against Mars24's examples, marstime and Mars's pole."""

import math
from datetime import UTC, datetime, timedelta

import ephem
import marstime
import numpy as np
import pytest

from skybake.ephemeris import mars
from skybake.ephemeris.place import SITES
from skybake.errors import InputError

EXAMPLE = datetime(2000, 1, 6, tzinfo=UTC)
J2000 = datetime(2000, 1, 1, 12, tzinfo=UTC)
TIMES = [datetime(1976, 7, 20, 11, 53, tzinfo=UTC) + timedelta(days=97.3 * n) for n in range(200)]


def declination_of_mars24(solar_longitude):
    """Planetographic latitude below the sun, "Algorithm and Worked Examples", eq. D-1."""
    return mars.declination(solar_longitude) + math.radians(0.25) * math.sin(solar_longitude)


def terrestrial_days(time):
    return (time - J2000) / timedelta(days=1) + mars.tt_less_utc(time) / 86_400.0


def test_the_worked_example_of_mars24_is_reproduced():
    """Mars24, "Algorithm and Worked Examples", example A, longitude and latitude 0."""
    now = mars.mars_time(EXAMPLE)
    assert math.degrees(now.solar_longitude) == pytest.approx(277.18758, abs=1.5e-5)
    assert math.degrees(now.equation_of_time) == pytest.approx(-5.18774, abs=1e-5)
    assert now.sol_date == pytest.approx(44_795.99976, abs=5e-6)
    assert 24.0 * (now.sol_date % 1.0) == pytest.approx(23.99425, abs=1e-5)
    true_hour = 12.0 + 12.0 / math.pi * now.hour_angle(0.0)
    assert true_hour == pytest.approx(23.64840, abs=1e-5)
    # Printed as -25.22838, with an obliquity of one more digit.
    declination = declination_of_mars24(now.solar_longitude)
    assert math.degrees(declination) == pytest.approx(-25.22838, abs=2e-4)
    # With Mars24's declination the sun is where Mars24 has it.
    elevation, azimuth = mars.horizontal(0.0, declination, now.hour_angle(0.0))
    assert 90.0 - math.degrees(elevation) == pytest.approx(154.26182, abs=2e-4)
    assert math.degrees(azimuth) == pytest.approx(191.03687, abs=0.003)


def test_spirits_planned_site_had_midnight_in_the_second_example():
    now = mars.mars_time(datetime(2004, 1, 3, 13, 46, 31, tzinfo=UTC))
    assert math.degrees(now.solar_longitude) == pytest.approx(327.32416, abs=1e-5)
    hours = 12.0 / math.pi * now.hour_angle(math.radians(-184.702))
    assert math.remainder(hours - 12.0, 24.0) == pytest.approx(0.0, abs=3e-4)


@pytest.mark.parametrize("longitude", [0.0, 137.44, -133.8])
def test_season_and_clock_agree_with_marstime(longitude):
    """It has the constants of 2000, which differ by 0.001 deg now and 0.003 deg in 1976."""
    for time in TIMES:
        days = terrestrial_days(time)
        now = mars.mars_time(time)
        season = math.degrees(now.solar_longitude) - marstime.Mars_Ls(days)
        assert math.remainder(season, 360.0) == pytest.approx(0.0, abs=0.003)
        assert math.degrees(now.equation_of_time) == pytest.approx(
            marstime.equation_of_time(days), abs=0.001
        )
        hours = 12.0 + 12.0 / math.pi * now.hour_angle(math.radians(longitude))
        expected = marstime.Local_True_Solar_Time(-longitude, days)
        assert math.remainder(hours - expected, 24.0) == pytest.approx(0.0, abs=3e-4)


def test_the_sun_stands_where_marstime_has_it_but_for_its_declination():
    """Mars24's declination is of a point on the ground, 0.25 deg from that of the sun."""
    for time in TIMES:
        days, latitude = terrestrial_days(time), math.radians(-4.59)
        now = mars.mars_time(time)
        hour_angle = now.hour_angle(math.radians(137.44))
        found, _ = mars.sun_in_season(now.solar_longitude, hour_angle, latitude)
        vertical = mars.planetographic_latitude(latitude)
        expected = marstime.solar_elevation(-137.44, math.degrees(vertical), days)
        assert math.degrees(found) == pytest.approx(expected, abs=0.26)
        theirs = declination_of_mars24(now.solar_longitude)
        same, _ = mars.horizontal(vertical, theirs, hour_angle)
        assert math.degrees(same) == pytest.approx(expected, abs=0.005)


def sun_from_the_pole(time):
    """Declination of the sun and hour angle at longitude 0, by Mars's rotation (IAU 2009)."""
    days = terrestrial_days(time)
    body = ephem.Mars(days + 36_525.0, epoch="2000")
    # Its longitude is of date; this brings it to the fixed equinox of the pole.
    longitude, latitude = body.hlon - math.radians(1.39697 * days / 36_525.0), float(body.hlat)
    x, y, z = (
        -math.cos(latitude) * math.cos(longitude),
        -math.cos(latitude) * math.sin(longitude),
        -math.sin(latitude),
    )
    tilt = math.radians(23.4392911)
    sun = np.array(
        [
            x,
            y * math.cos(tilt) - z * math.sin(tilt),
            y * math.sin(tilt) + z * math.cos(tilt),
        ]
    )
    centuries = days / 36_525.0
    ascension = math.radians(317.68143 - 0.1061 * centuries)
    height = math.radians(52.88650 - 0.0609 * centuries)
    pole = np.array(
        [
            math.cos(height) * math.cos(ascension),
            math.cos(height) * math.sin(ascension),
            math.sin(height),
        ]
    )
    node = np.array([-math.sin(ascension), math.cos(ascension), 0.0])
    turned = math.radians(176.630 + 350.89198226 * days)
    subsolar = math.atan2(sun @ np.cross(pole, node), sun @ node) - turned
    return math.asin(sun @ pole), -subsolar


def test_the_direction_to_the_sun_is_that_by_orbit_and_rotation_of_mars():
    """Of Mars24's two declinations, only this one is; the other is up to 0.25 deg off."""
    for year in range(1990, 2031, 3):
        for month in (1, 5, 9):
            time = datetime(year, month, 11, 3, 4, 5, tzinfo=UTC)
            declination, hour_angle = sun_from_the_pole(time)
            now = mars.mars_time(time)
            found = mars.declination(now.solar_longitude)
            assert math.degrees(found - declination) == pytest.approx(0.0, abs=0.01)
            off = math.remainder(now.hour_angle(0.0) - hour_angle, 2.0 * math.pi)
            assert math.degrees(off) == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("degrees", [-25.0, 0.0, 10.0, 25.0])
def test_the_noon_sun_is_in_the_zenith_where_the_vertical_points_at_it(degrees):
    season = math.asin(math.sin(math.radians(degrees)) / 0.42565)
    vertical = math.radians(degrees)
    for latitude in np.radians(np.linspace(degrees - 0.3, degrees + 0.3, 601)):
        elevation, _ = mars.sun_in_season(season, 0.0, latitude)
        off = abs(mars.planetographic_latitude(latitude) - vertical)
        assert elevation == pytest.approx(math.pi / 2 - off, abs=1e-6)


def test_the_vertical_leaves_the_radius_by_a_third_of_a_degree_at_most():
    assert mars.planetographic_latitude(0.0) == 0.0
    assert mars.planetographic_latitude(math.pi / 2) == pytest.approx(math.pi / 2)
    assert math.degrees(mars.planetographic_latitude(math.pi / 4)) == pytest.approx(
        45.338, abs=1e-3
    )
    # Viking 2 in both kinds (Mayo et al. 1977).
    utopia = mars.planetographic_latitude(SITES["utopia"].latitude)
    assert math.degrees(utopia) == pytest.approx(47.97, abs=0.01)


@pytest.mark.parametrize(
    ("hours", "latitude", "elevation", "azimuth"),
    [
        (6.0, 0.0, 0.0, 90.0),
        (18.0, 0.0, 0.0, 270.0),
        (15.0, 0.0, 45.0, 270.0),
        (12.0, 30.0, 60.0, 180.0),
        (12.0, -30.0, 60.0, 0.0),
        (0.0, 90.0, 0.0, 0.0),
    ],
)
def test_at_the_equinox_the_sun_goes_along_the_equator(hours, latitude, elevation, azimuth):
    hour_angle = math.radians(15.0 * (hours - 12.0))
    found, bearing = mars.horizontal(math.radians(latitude), 0.0, hour_angle)
    assert math.degrees(found) == pytest.approx(elevation, abs=1e-9)
    assert math.remainder(math.degrees(bearing) - azimuth, 360.0) == pytest.approx(0.0, abs=1e-9)


def test_leap_seconds_are_those_of_the_international_earth_rotation_service():
    for time, seconds in {
        datetime(1972, 1, 1, tzinfo=UTC): 42.184,
        datetime(1976, 7, 20, tzinfo=UTC): 47.184,
        datetime(1998, 12, 31, 23, 59, 59, tzinfo=UTC): 63.184,
        datetime(1999, 1, 1, tzinfo=UTC): 64.184,
        datetime(2016, 12, 31, 23, 59, 59, tzinfo=UTC): 68.184,
        datetime(2017, 1, 1, tzinfo=UTC): 69.184,
        datetime(2100, 1, 1, tzinfo=UTC): 69.184,
    }.items():
        assert mars.tt_less_utc(time) == pytest.approx(seconds, abs=1e-9)


@pytest.mark.parametrize("year", [1971, 2128])
def test_years_for_which_the_series_was_not_fitted_are_refused(year):
    with pytest.raises(InputError, match="must be in the years 1972 to 2127, got"):
        mars.mars_time(datetime(year, 6, 1, tzinfo=UTC))


@pytest.mark.parametrize(
    ("site", "time", "hours"),
    # Local mean solar time of landings: 15:03 and 15:53.
    [
        ("gale", datetime(2012, 8, 6, 5, 17, 57, tzinfo=UTC), 15.06),
        ("jezero", datetime(2021, 2, 18, 20, 43, 49, tzinfo=UTC), 15.89),
    ],
)
def test_the_rovers_landed_in_the_afternoon(site, time, hours):
    now = mars.mars_time(time)
    mean = 24.0 * (now.sol_date % 1.0) + math.degrees(SITES[site].longitude) / 15.0
    assert mean % 24.0 == pytest.approx(hours, abs=0.06)


def test_sites_are_on_the_map():
    assert list(SITES) == sorted(SITES)
    for place in SITES.values():
        assert abs(place.latitude) < math.pi / 2
        assert abs(place.longitude) <= math.pi


def test_the_sun_is_as_far_as_vsop87_has_it():
    for time in TIMES:
        expected = ephem.Mars(terrestrial_days(time) + 36_525.0).sun_distance
        assert mars.mars_time(time).sun_distance == pytest.approx(expected, abs=4e-4)


@pytest.mark.parametrize(("season", "distance"), [(71, 1.6660), (251, 1.3814), (341, 1.5104)])
def test_the_sun_is_farthest_at_ls_71_and_nearest_at_ls_251(season, distance):
    """Semi-major axis and eccentricity of JPL's elements; half a parameter between them."""
    assert mars.distance_in_season(math.radians(season)) == pytest.approx(distance, abs=1e-4)
