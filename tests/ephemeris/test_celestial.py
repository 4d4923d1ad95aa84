"""Where stars stand, against ERFA, hand calculation and the sun's own ephemeris."""

import math
from datetime import UTC, datetime

import erfa
import numpy as np
import pytest

from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.mars import sun_in_season
from skybake.ephemeris.place import SITES
from skybake.ephemeris.sidereal import frame_at, frame_in_season
from skybake.night.catalogue import load_catalogue
from tests.ephemeris.places import PARIS, QUITO

STARS = load_catalogue()
ARCSECOND = math.radians(1.0 / 3600.0)
POLARIS = np.radians([[37.954, 89.264]])


def by_erfa(time, place):
    """Directions of all stars by the IAU's routines, in the axes of maps."""
    days = 2451545.0 + (time - datetime(2000, 1, 1, 12, tzinfo=UTC)).total_seconds() / 86400.0
    seen = erfa.apco13(
        days, 0.0, 0.0, place.longitude, place.latitude, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.55
    )
    ra, dec = STARS.places.T
    east, north = STARS.motions.T
    zero = np.zeros_like(ra)
    of_date = erfa.atciq(ra, dec, east / np.cos(dec), north, zero, zero, seen[0])
    azimuth, zenith, *_ = erfa.atioq(*of_date, seen[0])
    level = np.sin(zenith)
    return np.stack([level * np.sin(azimuth), np.cos(zenith), -level * np.cos(azimuth)], axis=-1)


# ERFA warns of years in which it does not know the leap seconds.
@pytest.mark.filterwarnings("ignore:ERFA function")
@pytest.mark.parametrize("place", [PARIS, QUITO])
@pytest.mark.parametrize("year", [1900, 1980, 2026, 2050])
def test_stars_stand_where_erfa_has_them(place, year):
    time = datetime(year, 3, 1, 3, tzinfo=UTC)
    ours = frame_at(time, place).directions(STARS.places, STARS.motions)
    away = np.linalg.norm(ours - by_erfa(time, place), axis=-1)
    assert away.max() < 2.0 * ARCSECOND


def test_the_pole_star_is_as_high_as_the_latitude():
    for hour in range(0, 24, 3):
        frame = frame_at(datetime(2026, 1, 1, hour, tzinfo=UTC), PARIS)
        ((_, up, south),) = frame.directions(POLARIS)
        assert math.asin(up) == pytest.approx(PARIS.latitude, abs=math.radians(0.7))
        assert south < 0.0


def test_the_sidereal_time_is_what_culminates():
    place = np.array([[1.2, 0.3]])
    ((east, up, south),) = CelestialFrame("earth", 1.2, 0.5).directions(place)
    assert east == pytest.approx(0.0, abs=1e-4)
    assert (up, south) == pytest.approx((math.cos(0.2), math.sin(0.2)), abs=2e-4)
    # An hour later it is in the west.
    assert CelestialFrame("earth", 1.46, 0.5).directions(place)[0, 0] < -0.2


def test_fast_stars_move():
    years = np.array([2000.0, 2100.0])
    frames = [CelestialFrame("mars", 0.0, 0.7, year) for year in years]
    first, last = (frame.directions(STARS.places, STARS.motions) for frame in frames)
    moved = np.linalg.norm(last - first, axis=-1) / ARCSECOND
    # Alpha Centauri moves 3.7 arcsec a year and Arcturus 2.3.
    brightest = np.argsort(STARS.v)[:4]
    assert sorted(moved[brightest].round(-1))[-2:] == [230.0, 370.0]


@pytest.mark.parametrize("solar_longitude", [0.0, 1.0, 2.5, 4.4])
@pytest.mark.parametrize("hour_angle", [-2.0, 0.7])
def test_the_sun_of_mars_is_among_its_stars(solar_longitude, hour_angle):
    latitude = SITES["gale"].latitude
    frame = frame_in_season(solar_longitude, hour_angle, latitude)
    # The orbit's pole and the equinox of the northern spring, IAU and Standish (1992).
    node, inclination, tilt = map(math.radians, (49.558, 1.850, 23.4392911))
    sine = math.sin(inclination)
    x, y, z = sine * math.sin(node), -sine * math.cos(node), math.cos(inclination)
    orbit = np.array(
        [x, math.cos(tilt) * y - math.sin(tilt) * z, math.sin(tilt) * y + math.cos(tilt) * z]
    )
    ra, dec = map(math.radians, (317.681, 52.887))
    pole = np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])
    equinox = np.cross(pole, orbit)
    equinox /= np.linalg.norm(equinox)
    sun = math.cos(solar_longitude) * equinox + math.sin(solar_longitude) * np.cross(orbit, equinox)
    east, up, south = frame.rotation @ sun
    elevation, azimuth = sun_in_season(solar_longitude, hour_angle, latitude)
    assert math.asin(up) == pytest.approx(elevation, abs=math.radians(0.01))
    assert math.remainder(math.atan2(east, -south) - azimuth, 2 * math.pi) == pytest.approx(
        0.0, abs=math.radians(0.01)
    )


def seen(right_ascension, declination, *, sidereal_hours, latitude):
    """Elevation and bearing of what has hours and degrees, by a planisphere. [deg]"""
    frame = CelestialFrame("earth", math.radians(15.0 * sidereal_hours), math.radians(latitude))
    place = np.radians([[15.0 * right_ascension, declination]])
    ((east, up, south),) = frame.directions(place)
    return math.degrees(math.asin(up)), math.degrees(math.atan2(east, -south)) % 360.0


def test_orion_rises_on_its_side_and_stands_upright_in_the_south():
    # From Paris: the belt rises due east, and culminates 40 deg high in the south.
    rises = seen(5.6, -1.2, sidereal_hours=5.6 - 5.85, latitude=48.9)
    assert rises == pytest.approx((0.0, 92.0), abs=3.0)
    belt = seen(5.6, -1.2, sidereal_hours=5.6, latitude=48.9)
    assert belt == pytest.approx((39.9, 180.0), abs=0.2)
    betelgeuse = seen(5.919, 7.41, sidereal_hours=5.6, latitude=48.9)
    rigel = seen(5.242, -8.2, sidereal_hours=5.6, latitude=48.9)
    # Betelgeuse at the upper left, in the east of Rigel at the lower right.
    assert betelgeuse[0] > belt[0] > rigel[0]
    assert betelgeuse[1] < 180.0 < rigel[1]


def test_the_southern_cross_stands_upright_over_sydney():
    acrux = seen(12.443, -63.1, sidereal_hours=12.5, latitude=-33.9)
    gacrux = seen(12.519, -57.11, sidereal_hours=12.5, latitude=-33.9)
    # In the south, with its long axis to the pole below.
    assert acrux == pytest.approx((60.8, 180.0), abs=1.0)
    assert gacrux == pytest.approx((66.8, 180.0), abs=1.0)
    # Half a day later it is upside down, 7 deg above the horizon.
    assert seen(12.443, -63.1, sidereal_hours=0.443, latitude=-33.9)[0] == pytest.approx(
        7.0, abs=0.2
    )
