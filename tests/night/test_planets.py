"""Brightness of planets, and the discs and the shadow of the moons of Mars."""

import math

import numpy as np
import pytest

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.planets import Body
from skybake.night.planets import magnitude, phase_angle, planet_points, sunlit_share

# Distances from the sun and from the observer [au], phase angle [deg] and V, of the test cases
# that Mallama & Hilton (2018) published with their formulas.
PUBLISHED = (
    ("mercury", 0.310295423552, 1.32182643625754, 1.1677, -2.477),
    ("mercury", 0.413629222334, 0.92644808718613, 90.1662, 0.181),
    ("venus", 0.722722540169, 1.71607489554051, 1.3232, -3.917),
    ("venus", 0.721480714554, 0.37762511206278, 124.1348, -4.916),
    ("earth", 0.983331936476, 1.41317594650699, 8.7897, -3.269),
    ("jupiter", 5.446231815414, 6.44985867459088, 0.2446, -1.667),
    ("jupiter", 4.957681473205, 3.95393078136013, 0.3431, -2.934),
)


def body(name, from_sun, away, phase, radius=0.0):
    """A body on the x axis whose sun stands at a phase angle."""
    vector = np.array([away, 0.0, 0.0]) * ASTRONOMICAL_UNIT
    turn = math.radians(phase)
    sun = from_sun * ASTRONOMICAL_UNIT * np.array([-math.cos(turn), math.sin(turn), 0.0])
    return Body(name, vector, sun, radius, vector)


@pytest.mark.parametrize(("name", "from_sun", "away", "phase", "v"), PUBLISHED)
def test_planets_are_as_bright_as_published(name, from_sun, away, phase, v):
    one = body(name, from_sun, away, phase)
    assert phase_angle(one) == pytest.approx(phase)
    assert magnitude(one) == pytest.approx(v, abs=1e-3)


def test_saturn_is_brighter_with_open_rings():
    # At opposition in 2017 it had V = 0.0 with rings open by 26 deg, in 2025 edge on 0.6.
    pole = np.array([math.cos(0.708) * 0.1122, math.sin(0.708) * 0.1122, 0.9937])
    pole /= np.linalg.norm(pole)
    edge_on = np.cross(pole, [0.0, 0.0, 1.0])
    edge_on /= np.linalg.norm(edge_on)

    def opposition(tilt):
        direction = math.cos(tilt) * edge_on + math.sin(tilt) * pole
        vector = 8.75 * ASTRONOMICAL_UNIT * direction
        return magnitude(Body("saturn", vector, -vector / 8.75 * 9.75, 0.0, vector))

    assert opposition(0.0) == pytest.approx(0.74, abs=0.05)
    assert opposition(math.radians(26.0)) == pytest.approx(-0.22, abs=0.05)


def test_phobos_in_the_zenith_is_as_bright_as_venus_never_is():
    # 5980 km away and full: published are V -9.0 to -9.6; Deimos -5.1 to -5.7.
    phobos = body("phobos", 1.5237, 5980.0 / ASTRONOMICAL_UNIT, 0.01)
    deimos = body("deimos", 1.5237, 20062.0 / ASTRONOMICAL_UNIT, 0.01)
    assert -9.6 < magnitude(phobos) < -9.0
    assert -5.7 < magnitude(deimos) < -5.1


def test_a_moon_behind_mars_is_dark_and_beside_its_shadow_is_not():
    to_sun = np.array([2.28e8, 0.0, 0.0])
    places = np.array([[-9376.0, 0, 0], [-9376.0, 3500, 0], [9376.0, 0, 0], [-9376.0, 3389.5, 0]])
    share = sunlit_share(places, to_sun, 3389.5)
    np.testing.assert_allclose(share, [0.0, 1.0, 1.0, 0.5], atol=1e-6)


def test_the_disc_of_phobos_has_its_size_and_its_flux():
    # Phobos is seen in 2026.3 at a phase angle of 121 deg: a crescent.
    frame = CelestialFrame("mars", 1.0, 0.4, 2026.3)
    points = planet_points(frame, 0.0, 6.5)
    is_phobos = np.isclose(points.b_v, 0.6)
    assert is_phobos.sum() > 50
    vectors = points.vectors[is_phobos]
    width = np.linalg.norm(vectors[:, None] - vectors[None], axis=-1).max()
    assert math.degrees(width) * 60.0 == pytest.approx(8.0, abs=4.5)
    flux = (10.0 ** (-0.4 * points.v[is_phobos])).sum()
    assert -2.5 * math.log10(flux) == pytest.approx(-3.95, abs=0.05)


def test_a_limit_leaves_faint_planets_out():
    frame = CelestialFrame("earth", 1.0, 0.4, 2026.3)
    assert len(planet_points(frame, 0.0, 6.5).v) == 6
    assert len(planet_points(frame, 0.0, 3.0).v) == 5
    assert len(planet_points(frame, 0.0, -3.0).v) == 1
