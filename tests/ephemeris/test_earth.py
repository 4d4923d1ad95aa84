"""The sun as seen from Earth, against SPA and printed refraction."""

import math
from datetime import UTC, datetime, timedelta, timezone

import numpy as np
import pytest

from skybake.ephemeris.earth import hour_angle, refraction, sun_position
from tests.ephemeris.places import PARIS, PLACES, QUITO, at


def spa(time, place):
    """Geometric elevation and azimuth by NREL's algorithm. [deg]"""
    from pvlib import spa

    found = spa.solar_position(
        np.array([time.timestamp()]),
        math.degrees(place.latitude),
        math.degrees(place.longitude),
        elev=0.0,
        pressure=0.0,
        temp=10.0,
        delta_t=spa.calculate_deltat(time.year, time.month),
        atmos_refract=0.0,
    )
    return float(found[3][0]), float(found[4][0])


@pytest.mark.parametrize("name", PLACES)
@pytest.mark.parametrize("years", [(1950, 2100), (1000, 2999)])
def test_the_sun_stands_where_spa_has_it(name, years):
    place = PLACES[name]
    for year in np.linspace(*years, 16).astype(int):
        for month in range(1, 13, 2):
            time = datetime(year, month, 1 + month, (5 * month + year) % 24, 17, 39, tzinfo=UTC)
            elevation, azimuth = map(math.degrees, sun_position(time, place))
            expected, bearing = spa(time, place)
            assert elevation == pytest.approx(expected, abs=0.001)
            across = math.remainder(azimuth - bearing, 360.0) * math.cos(math.radians(expected))
            assert across == pytest.approx(0.0, abs=0.001)


def test_a_time_means_the_same_by_any_clock():
    utc = datetime(2026, 6, 21, 4, 0, tzinfo=UTC)
    assert sun_position(utc, PARIS) == sun_position(
        utc.astimezone(timezone(timedelta(hours=-9, minutes=-30))), PARIS
    )


def test_the_antimeridian_is_one_place_from_both_sides():
    time = datetime(2026, 9, 1, 3, 30, tzinfo=UTC)
    assert sun_position(time, at(10.0, 180.0)) == pytest.approx(
        sun_position(time, at(10.0, -180.0)), abs=1e-12
    )


def test_the_noon_sun_is_in_the_south_of_the_north_and_in_the_north_of_the_south():
    """South is the middle of an equirect map, north its seam."""
    for latitude, bearing in ((48.0, 180.0), (-48.0, 0.0)):
        # True noon in Greenwich: the equation of time is zero on 15 April to 20 s.
        _, azimuth = sun_position(datetime(2026, 4, 15, 12, tzinfo=UTC), at(latitude, 0.0))
        assert math.remainder(math.degrees(azimuth) - bearing, 360.0) == pytest.approx(0, abs=0.3)


def test_the_sun_is_in_the_east_in_the_morning():
    _, azimuth = sun_position(datetime(2026, 3, 20, 11, 20, tzinfo=UTC), QUITO)
    assert math.degrees(azimuth) == pytest.approx(90.0, abs=0.5)
    assert hour_angle(datetime(2026, 3, 20, 11, 20, tzinfo=UTC), QUITO) < 0.0


@pytest.mark.parametrize(
    ("apparent", "lift"),
    # Allen (1976), Astrophysical Quantities, p. 125, at 10 degC and 1013 hPa; the almanacs
    # take 34' at the horizon. A day's weather changes it by more than 3 %.
    [(0.0, 35.4), (0.0, 34.0), (2.0, 18.4), (5.0, 9.9), (10.0, 5.3)],
)
def test_refraction_is_that_of_tables(apparent, lift):
    geometric = math.radians(apparent - lift / 60.0)
    assert math.degrees(refraction(geometric)) * 60.0 == pytest.approx(lift, rel=0.03)


@pytest.mark.parametrize("apparent", [0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 80.0])
def test_refraction_agrees_with_bennett_by_apparent_elevation(apparent):
    """Bennett (1982, J. Navigation 35, 255), which Meeus says agrees to 4 arcsec."""
    lift = 1.0 / math.tan(math.radians(apparent + 7.31 / (apparent + 4.4)))
    found = refraction(math.radians(apparent - lift / 60.0))
    assert math.degrees(found) * 60.0 == pytest.approx(lift, abs=0.1)


def test_refraction_has_no_step_in_value_slope_or_curvature():
    step = math.radians(0.001)
    elevations = np.arange(math.radians(-8.0), math.radians(10.0), step)
    lift = np.array([refraction(elevation) for elevation in elevations])
    slope, curvature = np.diff(lift) / step, np.diff(lift, 2) / step**2
    # Continuous functions change less between nodes the closer the nodes are.
    for values, bound in ((lift, 2e-5), (slope, 2e-3), (curvature, 0.5)):
        assert np.abs(np.diff(values)).max() < bound
        assert np.abs(np.diff(values[::4])).max() > 2.5 * np.abs(np.diff(values)).max()


def test_the_apparent_sun_rises_while_the_sun_rises():
    elevations = np.linspace(-math.pi / 2, math.pi / 2, 100_001)
    lift = np.array([refraction(elevation) for elevation in elevations])
    assert (lift >= 0.0).all()
    assert (np.diff(elevations + lift) > 0.0).all()
    assert lift[-1] == pytest.approx(0.0, abs=1e-8)
    assert (lift[elevations < math.radians(-5.0)] == 0.0).all()
