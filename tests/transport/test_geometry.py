import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.kernels import (
    distance_to_entry,
    distance_to_exit,
    radius_at,
    ray_limits,
    shadow_interval,
)
from tests.media import RADIUS, TOP, cosine_to_sun, plain_medium

AIR = plain_medium()
MICROMETRE = 1e-9

cosines = st.floats(-1.0, 1.0)
altitudes = st.floats(0.0, TOP - RADIUS)
far_altitudes = st.one_of(altitudes, st.floats(0.0, 1e6))
azimuths = st.floats(0.0, math.pi)


def radius_by_vectors(r, mu, t):
    """Law of cosines with a mantissa of 64 bits."""
    r, mu, t = np.longdouble(r), np.longdouble(mu), np.longdouble(t)
    return float(np.hypot(t * np.sqrt(1 - mu * mu), r + t * mu))


@given(altitudes, cosines)
def test_a_ray_leaves_the_air_where_its_radius_is_the_tops(h, mu):
    t = distance_to_exit(RADIUS + h, mu, TOP)
    assert t >= 0.0
    assert radius_by_vectors(RADIUS + h, mu, t) == pytest.approx(TOP, abs=1e-7)


@pytest.mark.parametrize(
    ("mu", "distance"), [(1.0, 100.0), (0.0, math.sqrt(TOP**2 - RADIUS**2)), (-1.0, TOP + RADIUS)]
)
def test_distances_to_the_top_match_the_drawing(mu, distance):
    assert distance_to_exit(RADIUS, mu, TOP) == pytest.approx(distance, rel=1e-14)


@given(st.floats(1e-3, 1e6), st.floats(0.0, 0.999999))
def test_a_ray_from_outside_enters_the_planet_at_its_radius(h, aim):
    r = RADIUS + h
    closest = aim * RADIUS
    mu = -math.sqrt(1.0 - (closest / r) ** 2)
    t = distance_to_entry(r, mu, RADIUS)
    # One rounding of mu moves the hit by r * 1e-16 across, and more along at a graze.
    graze = math.sqrt(1.0 - aim**2)
    assert radius_by_vectors(r, mu, t) == pytest.approx(RADIUS, abs=4e-16 * r * r / RADIUS / graze)


@given(st.floats(1e-3, 1e6), st.floats(1.000001, 2.0))
def test_a_ray_that_passes_beside_the_planet_never_enters_it(h, aim):
    r = RADIUS + h
    mu = -math.sqrt(max(1.0 - (aim * RADIUS / r) ** 2, 0.0))
    # Where the line would pass outside the start itself, the ray looks up or level.
    assert distance_to_entry(r, mu if aim * RADIUS < r else 0.0, RADIUS) == math.inf


@given(far_altitudes, cosines, st.floats(0.0, 1e6))
def test_radius_along_a_ray_follows_the_law_of_cosines(h, mu, t):
    expected = radius_by_vectors(RADIUS + h, mu, t)
    assert radius_at(RADIUS + h, mu, t) == pytest.approx(expected, rel=1e-9, abs=1e-4)


def test_radius_keeps_micrometres_at_ground_level():
    for mu in (0.0, 1e-6, 1e-3, 1.0):
        rise = radius_by_vectors(RADIUS, mu, 1e-3) - RADIUS
        assert radius_at(RADIUS, mu, 1e-3) - RADIUS == pytest.approx(rise, abs=3 * MICROMETRE)


@given(far_altitudes, cosines, cosines, azimuths)
def test_shadow_is_where_the_way_to_the_sun_meets_the_planet(h, mu, mu_s, azimuth):
    r = RADIUS + h
    nu = cosine_to_sun(mu, mu_s, azimuth)
    first, last, _ = ray_limits(AIR, r, mu)
    assume(last - first > MICROMETRE)
    dark_first, dark_last = shadow_interval(r, mu, mu_s, nu, RADIUS, first, last)

    t = np.linspace(first, last, 403)[1:-1]
    view = np.array([math.sqrt(1.0 - mu * mu), 0.0, mu])
    horizontal = math.sqrt(1.0 - mu_s * mu_s)
    sun = np.array([horizontal * math.cos(azimuth), horizontal * math.sin(azimuth), mu_s])
    point = np.array([0.0, 0.0, r]) + t[:, None] * view
    along = point @ sun
    off_axis = np.linalg.norm(point - along[:, None] * sun, axis=1)
    is_dark = (along < 0.0) & (off_axis < RADIUS)
    # Within ten metres of the cylinder or of its end, rounding of nu at 1e6 km may decide.
    slack = 1e-2 if h > 1e3 else 1e-5
    is_sure = (np.abs(off_axis - RADIUS) > slack) & (np.abs(along) > slack)
    inside = (t > dark_first) & (t < dark_last)
    np.testing.assert_array_equal(inside[is_sure], is_dark[is_sure])


def test_a_ray_straight_down_sun_is_wholly_dark_or_wholly_lit():
    r = RADIUS + 10.0
    behind = -0.5  # the sun is 30 deg below the horizontal, the way back runs up
    assert shadow_interval(r, -behind, behind, -1.0, RADIUS, 0.0, 50.0) == (0.0, 50.0)
    assert shadow_interval(r, 0.5, 0.5, 1.0, RADIUS, 0.0, 50.0) == (math.inf, math.inf)


@given(st.floats(0.0, 1e6), cosines)
def test_limits_of_a_ray_lie_in_the_air(h, mu):
    first, last, hits_ground = ray_limits(AIR, RADIUS + h, mu)
    assert 0.0 <= first <= last < math.inf
    if first == last:
        return
    slack = max(1e-6, 1e-15 * (RADIUS + h) ** 2 / RADIUS)
    middle = radius_by_vectors(RADIUS + h, mu, 0.5 * (first + last))
    assert RADIUS - slack <= middle <= TOP + slack
    end = radius_by_vectors(RADIUS + h, mu, last)
    assert end == pytest.approx(RADIUS if hits_ground else TOP, abs=100.0 * slack)
