"""Moons in front of the sun, against published elements and observed eclipses."""

import math
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from skybake.ephemeris.earth import sun_distance
from skybake.ephemeris.earth_moon import sun_and_moon
from skybake.ephemeris.mars import sun_position
from skybake.ephemeris.mars_moons import sun_and_moons
from skybake.ephemeris.moment import sun_at
from skybake.ephemeris.moon import MEAN_RADIUS, Moon, reaches, separation
from skybake.ephemeris.place import SITES, Place
from skybake.errors import InputError

SUN_RADIUS = 695_700.0

# "Eclipse Predictions by Fred Espenak, NASA's GSFC": Besselian elements of Five Millennium Canon of
# Solar Eclipses (Espenak and Meeus 2006, NASA/TP-2006-214141), t in hours of TDT from 18:00.
ELEMENTS = {
    "2026-08-12": (
        [0.4755140, 0.5189249, -7.73e-5, -8.04e-6],
        [0.7711830, -0.2301680, -1.246e-4, 3.77e-6],
        [14.7966700, -0.0120650, -3e-6],
        [88.7477875, 15.0030899],
        [0.5379550, 0.0000939, -1.21e-5],
        [-0.0081420, 0.0000935, -1.21e-5],
        (0.0046141, 0.0045911),
    ),
    "2024-04-08": (
        [-0.3182440, 0.5117116, 3.26e-5, -8.42e-6],
        [0.2197640, 0.2709589, -5.95e-5, -4.66e-6],
        [7.5862002, 0.0148440, -2e-6],
        [89.5912170, 15.0040817],
        [0.5358140, 0.0000618, -1.28e-5],
        [-0.0102720, 0.0000615, -1.27e-5],
        (0.0046683, 0.0046450),
    ),
}
DELTA_T = 69.184
"""Of UTC since 2017 (IERS Bulletin C). [s]"""

CORUNA = Place(math.radians(43.3713), math.radians(-8.3960))
BURGOS = Place(math.radians(42.3439), math.radians(-3.6969))
DALLAS = Place(math.radians(32.7767), math.radians(-96.7970))


def _besselian(day, place):
    """Distances from being touched by penumbra and umbra, in Earth radii (Meeus 1989)."""
    x, y, d, mu, l1, l2, slopes = ELEMENTS[day]
    start = datetime.fromisoformat(day + "T18:00+00:00")
    latitude, longitude = place.latitude, place.longitude
    u = math.atan(0.99664719 * math.tan(latitude))

    def at(time):
        t = ((time - start).total_seconds() + DELTA_T) / 3600.0
        here = [sum(a * t**i for i, a in enumerate(each)) for each in (x, y, d, mu, l1, l2)]
        tilt = math.radians(here[2])
        angle = math.radians(here[3]) + longitude - math.radians(0.00417807 * DELTA_T)
        xi = math.cos(u) * math.sin(angle)
        sine, cosine = 0.99664719 * math.sin(u), math.cos(u)
        eta = sine * math.cos(tilt) - cosine * math.cos(angle) * math.sin(tilt)
        zeta = sine * math.sin(tilt) + cosine * math.cos(angle) * math.cos(tilt)
        apart = math.hypot(here[0] - xi, here[1] - eta)
        return apart - (here[4] - zeta * slopes[0]), apart - abs(here[5] - zeta * slopes[1])

    return at


def _seen(place):
    """Distances of the discs' edges from touching outside and inside. [rad]"""

    def at(time):
        sun, moon = sun_and_moon(time, place, 0.0)
        apart = math.atan2(np.linalg.norm(np.cross(sun, moon)), sun @ moon)
        radii = (
            math.asin(SUN_RADIUS / np.linalg.norm(sun)),
            math.asin(MEAN_RADIUS / np.linalg.norm(moon)),
        )
        return apart - sum(radii), apart - (radii[1] - radii[0])

    return at


def _contacts(at, middle):
    """First to fourth contact, by bisection on both sides of the middle."""
    found = []
    for index, reach in ((0, 2.0), (1, 0.2)):
        for sign in (-1.0, 1.0):
            low, high = 0.0, reach * 3600.0
            for _ in range(40):
                half = 0.5 * (low + high)
                is_inside = at(middle + timedelta(seconds=sign * half))[index] < 0.0
                low, high = (half, high) if is_inside else (low, half)
            found.append(middle + timedelta(seconds=sign * low))
    return sorted(found)


@pytest.mark.parametrize(
    ("day", "place", "middle"),
    [
        ("2026-08-12", CORUNA, "18:28:20"),
        ("2026-08-12", BURGOS, "18:29:17"),
        ("2024-04-08", DALLAS, "18:42:39"),
    ],
)
def test_contacts_are_within_5_s_of_those_of_nasas_elements(day, place, middle):
    time = datetime.fromisoformat(f"{day}T{middle}+00:00")
    for ours, published in zip(
        _contacts(_seen(place), time), _contacts(_besselian(day, place), time), strict=True
    ):
        assert abs((ours - published).total_seconds()) < 5.0


@pytest.mark.parametrize(("place", "seconds", "sun"), [(CORUNA, 76.0, 12.0), (BURGOS, 104.0, 8.0)])
def test_totality_in_spain_is_as_long_and_the_sun_as_high_as_the_ign_has_published(
    place, seconds, sun
):
    middle = datetime(2026, 8, 12, 18, 28 if place is CORUNA else 29, 17, tzinfo=UTC)
    _, second, third, _ = _contacts(_seen(place), middle)
    # The IGN lets light pass through the valleys of the moon's edge.
    assert (third - second).total_seconds() == pytest.approx(seconds, abs=5.0)
    height = sun_at(middle, place).sun_elevation
    assert math.degrees(height) == pytest.approx(sun, abs=0.5)


@pytest.mark.parametrize(
    ("site", "moon", "first", "lasts"),
    [
        # NASA's dates and sols: of Curiosity 2013-08-20 (369, near noon), 2019-03-26 (2359) and
        # 2019-03-17 (2350); of Perseverance 2022-04-02 (397, "a little more than 40 seconds").
        ("gale", 0, "2013-08-20T07:00", None),
        ("gale", 0, "2019-03-27T03:33", None),
        ("gale", 1, "2019-03-17T17:50", None),
        ("jezero", 0, "2022-04-02T10:43", 42.0),
    ],
)
def test_moons_of_mars_cross_the_sun_when_rovers_saw_them(site, moon, first, lasts):
    start = datetime.fromisoformat(first + "+00:00")
    inside = 0
    for second in range(0, 1800, 2):
        sun, moons = sun_and_moons(start + timedelta(seconds=second), SITES[site], 0.0)
        where, radius = moons[moon]
        apart = math.atan2(np.linalg.norm(np.cross(sun, where)), sun @ where)
        limit = math.asin(SUN_RADIUS / np.linalg.norm(sun)) + math.asin(
            radius / np.linalg.norm(where)
        )
        inside += apart < limit
    assert inside > 0
    if lasts is not None:
        assert 2.0 * inside == pytest.approx(lasts, abs=8.0)


def test_the_sun_of_the_moons_is_the_sun_of_mars():
    time = datetime(2022, 4, 2, 11, tzinfo=UTC)
    sun, _ = sun_and_moons(time, SITES["jezero"], 0.0)
    elevation, azimuth = sun_position(time, SITES["jezero"])
    assert math.asin(sun[2] / np.linalg.norm(sun)) == pytest.approx(elevation, abs=1e-4)
    assert math.atan2(sun[0], sun[1]) % (2 * math.pi) == pytest.approx(azimuth, abs=1e-4)


def test_the_moon_is_beside_the_sun_with_the_refraction_that_lifts_it():
    lifted, bare = (
        sun_at("2026-08-12T18:28:20Z", CORUNA, refraction=refraction)
        for refraction in (True, False)
    )
    assert lifted.sun_elevation > bare.sun_elevation
    apart = [
        separation(one.moon.azimuth, one.moon.elevation, one.sun_azimuth, one.sun_elevation)
        for one in (lifted, bare)
    ]
    assert apart[0] == pytest.approx(apart[1], abs=1e-9)


def test_a_shadow_reaches_places_that_the_parallax_of_the_moon_moves_it_to():
    distance = sun_distance(datetime(2026, 8, 12, tzinfo=UTC)) * 149_597_870.7
    moon = Moon(math.pi, math.radians(31.0))
    sun = math.pi, math.radians(30.0), math.radians(0.2666), distance
    assert not reaches(moon, *sun, 1000.0)
    assert reaches(moon, *sun, 5000.0)
    assert not reaches(Moon(math.pi, math.radians(31.0), distance=math.inf), *sun, 5000.0)
    assert not reaches(Moon(math.pi, math.radians(30.0), distance=2.0 * distance), *sun, 1000.0)


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ((0.0, 1.6), "moon elevation"),
        ((math.nan, 0.0), "moon azimuth"),
        ((0.0, 0.0, 0.0), "moon diameter"),
        ((0.0, 0.0, 0.01, -1.0), "moon distance"),
    ],
)
def test_moons_that_do_not_exist_are_refused(values, name):
    with pytest.raises(InputError, match=name):
        Moon(*values)
