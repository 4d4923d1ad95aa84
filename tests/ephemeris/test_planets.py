"""Planets from Earth and Mars, against JPL's DE421 with light-time, in axes of J2000."""

import math
from datetime import UTC, datetime

import numpy as np
import pytest

from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.place import SITES, Place
from skybake.ephemeris.planets import bodies_over, observer_from_centre
from skybake.ephemeris.sidereal import frame_at
from tests.ephemeris.places import PARIS

ARCSECOND = math.radians(1.0 / 3600.0)
GALE = SITES["gale"]

# Where, when, and right ascension and declination from the planet's centre. [deg]
PLACES = (
    ("earth", (2026, 8, 12), "mercury", 125.8779, 19.8348),
    ("earth", (2026, 8, 12), "venus", 183.9891, -2.8811),
    ("earth", (2026, 8, 12), "mars", 90.0621, 23.6799),
    ("earth", (2026, 8, 12), "jupiter", 131.5895, 18.4752),
    ("earth", (2026, 8, 12), "saturn", 14.0241, 3.2049),
    ("earth", (2026, 8, 12), "uranus", 63.0379, 20.9675),
    ("earth", (1985, 2, 3), "venus", 0.1789, 1.6222),
    ("earth", (1985, 2, 3), "jupiter", 301.6010, -20.5797),
    ("earth", (1985, 2, 3), "saturn", 235.6843, -17.4938),
    ("mars", (2027, 3, 1), "mercury", 326.4763, -14.4914),
    ("mars", (2027, 3, 1), "venus", 312.6529, -18.9710),
    ("mars", (2027, 3, 1), "earth", 330.5293, -16.6595),
    ("mars", (2027, 3, 1), "moon", 330.3304, -16.7426),
    ("mars", (2027, 3, 1), "jupiter", 140.5968, 15.8787),
    ("mars", (2027, 3, 1), "saturn", 10.2008, 1.7356),
    ("mars", (1990, 6, 1), "venus", 124.7820, 19.8590),
    ("mars", (1990, 6, 1), "earth", 181.3439, 1.4711),
)


def unit(degrees):
    ra, dec = np.radians(degrees)
    return np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])


def body(name, time, place):
    return next(each for each in bodies_over(frame_at(time, place)) if each.name == name)


@pytest.mark.parametrize(("planet", "day", "name", "ra", "dec"), PLACES)
def test_planets_are_where_jpl_has_them(planet, day, name, ra, dec):
    place = GALE if planet == "mars" else PARIS
    centre = body(name, datetime(*day, tzinfo=UTC), place).centre
    away = np.linalg.norm(centre / np.linalg.norm(centre) - unit((ra, dec)))
    assert away < 2.5 * ARCSECOND


def test_the_observer_sees_the_parallax_of_near_planets():
    # Venus at 0.27 au on 2025-03-22: 32 arcsec between the ends of a radius of Earth.
    time = datetime(2025, 3, 22, tzinfo=UTC)
    venus = body("venus", time, PARIS)
    here = observer_from_centre(frame_at(time, PARIS), 0.0)
    assert np.linalg.norm(here) == pytest.approx(6371.0)
    np.testing.assert_allclose(venus.centre - here, venus.vector)
    assert np.linalg.norm(venus.centre) == pytest.approx(0.28 * 149597870.7, rel=0.02)


def test_the_observer_stands_upon_the_ellipsoid_of_mars():
    frame = CelestialFrame("mars", 0.3, math.radians(40.0), 2026.5)
    here = observer_from_centre(frame, 0.0)
    pole = unit((317.681, 52.887))
    axial = here @ pole
    across = np.linalg.norm(here - axial * pole)
    assert (across / 3396.19) ** 2 + (axial / 3376.20) ** 2 == pytest.approx(1.0, abs=1e-6)
    # The vertical is that of the frame.
    assert math.atan2(axial / 3376.20**2, across / 3396.19**2) == pytest.approx(math.radians(40.0))


def test_phobos_and_deimos_are_as_far_as_their_orbits_take_them():
    moons = {
        each.name: each
        for each in bodies_over(frame_at(datetime(2026, 5, 1, tzinfo=UTC), GALE))
        if each.radius
    }
    assert np.linalg.norm(moons["phobos"].centre) == pytest.approx(9376.0, rel=0.016)
    assert np.linalg.norm(moons["deimos"].centre) == pytest.approx(23458.0, rel=0.001)


def test_without_a_date_there_are_no_planets():
    assert bodies_over(CelestialFrame("earth", 1.0, 0.5)) == []


def test_the_sun_of_a_body_is_as_far_as_its_orbit():
    jupiter = body("jupiter", datetime(2026, 5, 1, tzinfo=UTC), Place(0.1, 0.2))
    assert 4.95 < np.linalg.norm(jupiter.sun) / 149597870.7 < 5.46
