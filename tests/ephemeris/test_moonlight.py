"""The Moon as a light: where it stands, how it is lit and how it is turned."""

import math
from datetime import UTC, datetime, timedelta

import ephem
import erfa
import numpy as np
import pytest

from skybake.ephemeris.earth import ephem_days
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.lit_moon import moon_by_hand
from skybake.ephemeris.moment import sun_at
from skybake.ephemeris.moonlight import lit_moon_at
from skybake.ephemeris.place import Place
from skybake.errors import InputError

PARIS = Place(math.radians(48.8566), math.radians(2.3522))
AU = 149_597_870.7
TIMES = [datetime(2026, 1, 5, 3, tzinfo=UTC) + timedelta(days=17.3 * k) for k in range(12)]


def place_by_erfa(time, place):
    """Unit vector toward the Moon (+Y up, -Z north, +X east) by Meeus's series in ERFA."""
    utc = erfa.dtf2d("UTC", time.year, time.month, time.day, time.hour, time.minute, time.second)
    tai = erfa.utctai(*utc)
    tt = erfa.taitt(*tai)
    # The difference between UT1 and UTC, below 0.9 s, moves the Moon by 0.5 arcsec.
    to_earth = erfa.c2t06a(*tt, *utc, 0.0, 0.0)
    moon = to_earth @ erfa.moon98(*tt)["p"] * AU
    here = erfa.gd2gc(1, place.longitude, place.latitude, 0.0) / 1e3
    x, y, z = moon - here
    sine, cosine = math.sin(place.longitude), math.cos(place.longitude)
    east, out = -sine * x + cosine * y, cosine * x + sine * y
    sine, cosine = math.sin(place.latitude), math.cos(place.latitude)
    vector = np.array([east, cosine * out + sine * z, -(cosine * z - sine * out)])
    return vector / np.linalg.norm(vector)


def angle(one, other):
    return math.atan2(np.linalg.norm(np.cross(one, other)), float(np.dot(one, other)))


@pytest.mark.parametrize("time", TIMES, ids=str)
def test_the_moon_stands_within_20_arcsec_of_where_erfa_has_it(time):
    found = lit_moon_at(time, PARIS, 0.0)
    assert math.degrees(angle(found.direction, place_by_erfa(time, PARIS))) < 20.0 / 3600.0


@pytest.mark.parametrize("time", TIMES, ids=str)
def test_the_middle_of_the_disc_librates_within_a_tenth_of_a_degree_of_libastro(time):
    body = ephem.Moon(ephem_days(time))
    # From where the Moon is in the zenith libration is that from the centre of Earth.
    sidereal = ephem.Observer()
    sidereal.lon, sidereal.lat, sidereal.date = 0.0, 0.0, ephem_days(time)
    below = math.remainder(body.g_ra - sidereal.sidereal_time(), 2.0 * math.pi)
    found = lit_moon_at(time, Place(float(body.g_dec), below), 0.0)
    assert found.elevation > math.radians(89.5)
    longitude, latitude = found.sub_observer
    assert math.degrees(longitude) == pytest.approx(math.degrees(body.libration_long), abs=0.1)
    assert math.degrees(latitude) == pytest.approx(math.degrees(body.libration_lat), abs=0.1)
    sun = math.degrees(found.sub_solar[0])
    expected = 90.0 - math.degrees(body.colong)
    # libastro leaves out what parallax makes of the sun, 0.147 deg at most, and other small terms.
    assert math.remainder(sun - expected, 360.0) == pytest.approx(0.0, abs=0.3)


def test_the_first_quarter_is_lit_in_the_west_and_the_last_in_the_east():
    for time, toward_west in (("2026-04-23T20:00Z", True), ("2026-04-10T04:00Z", False)):
        moon = sun_at(time, PARIS).lit_moon
        assert math.degrees(moon.phase_angle) == pytest.approx(90.0, abs=8.0)
        assert moon.illuminated_fraction == pytest.approx(0.5, abs=0.08)
        right = np.array([math.cos(moon.azimuth), 0.0, math.sin(moon.azimuth)])
        # Who looks south has the west on the right.
        assert (right @ np.array(moon.sun) > 0.5) == toward_west
        assert (moon.sub_solar[0] > 0.0) == toward_west


def test_refraction_raises_the_moon_with_all_that_is_on_it():
    time = datetime(2026, 4, 1, 18, 30, tzinfo=UTC)
    bare = lit_moon_at(time, PARIS, 0.0)
    raised = lit_moon_at(time, PARIS, 0.0, Horizon("earth").lift)
    assert 0.0 < bare.elevation < math.radians(5.0)
    lift = raised.elevation - bare.elevation
    assert lift == pytest.approx(Horizon("earth").lift(bare.elevation))
    assert raised.azimuth == pytest.approx(bare.azimuth)
    assert raised.phase_angle == pytest.approx(bare.phase_angle, abs=1e-12)
    assert raised.sub_observer == pytest.approx(bare.sub_observer, abs=1e-12)


def test_an_observer_on_mars_has_no_moon_as_a_light():
    gale = Place(math.radians(-4.6), math.radians(137.4), "mars")
    assert sun_at("2026-04-01T18:40Z", gale).lit_moon is None


@pytest.mark.parametrize("phase", [0.0, 0.4, 1.5, 3.0, math.pi])
def test_a_moon_by_hand_has_the_phase_that_is_asked_for_and_looks_to_the_sun(phase):
    moon = moon_by_hand(1.0, 0.7, phase, 4.0, -0.3)
    assert moon.phase_angle == pytest.approx(phase, abs=1e-7)
    assert moon.sub_observer == pytest.approx((0.0, 0.0), abs=1e-12)
    sun = np.array([math.cos(-0.3) * math.sin(4.0), math.sin(-0.3), -math.cos(-0.3) * math.cos(4)])
    centre = np.array(moon.direction)
    apart = sun - (sun @ centre) * centre
    lit = np.array(moon.sun) - (np.array(moon.sun) @ centre) * centre
    if 0.0 < phase < math.pi:
        assert angle(lit, apart) == pytest.approx(0.0, abs=1e-9)


def test_a_moon_without_a_phase_is_full_opposite_to_the_sun_and_new_beside_it():
    opposite = moon_by_hand(0.0, math.radians(30.0), None, math.pi, math.radians(-30.0))
    assert opposite.phase_angle == pytest.approx(0.0, abs=1e-7)
    beside = moon_by_hand(math.pi, math.radians(-29.0), None, math.pi, math.radians(-30.0))
    assert math.degrees(beside.phase_angle) == pytest.approx(179.0)


@pytest.mark.parametrize(
    ("azimuth", "elevation", "phase", "message"),
    [
        (0.0, 1.7, 1.0, "moon elevation: must be from -90 to 90 deg, got 97.4028 deg"),
        (math.nan, 0.5, 1.0, "moon azimuth: must be finite, got nan"),
        (0.0, 0.5, 3.3, "moon phase: must be from 0deg to 180deg, got 189.076deg"),
    ],
)
def test_a_moon_that_does_not_exist_is_refused(azimuth, elevation, phase, message):
    with pytest.raises(InputError) as caught:
        moon_by_hand(azimuth, elevation, phase, 0.0, 0.0)
    assert str(caught.value) == message
