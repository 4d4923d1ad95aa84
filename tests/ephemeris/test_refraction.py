"""Light of the sun bent by the air of Earth, against rays traced through it."""

import math

import numpy as np
import pytest

from skybake.ephemeris import earth
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.place import GROUND_RADII
from skybake.ephemeris.refraction import REFRACTIVITY, SCALE_HEIGHT, Refraction

GROUND = GROUND_RADII["earth"]
STEP = 2.0  # km


def refractive_index(radius):
    """Of the air that the closed form stands for, exponential in n * radius, and its slope."""
    index = 1.0
    for _ in range(30):
        rise = index * radius - (1.0 + REFRACTIVITY) * GROUND
        index = 1.0 + REFRACTIVITY * math.exp(-rise / SCALE_HEIGHT)
    fall = (index - 1.0) / SCALE_HEIGHT
    return index, -fall * index / (1.0 + fall * radius)


def change(state):
    """Of position and n * direction along a ray: d(n t)/ds is the gradient of n."""
    radius = math.hypot(state[0], state[1])
    index, slope = refractive_index(radius)
    return np.concatenate([state[2:] / index, slope * state[:2] / radius])


def traced_bending(altitude, apparent):
    """Angle between a ray at an observer and where it has left the air."""
    radius = GROUND + altitude
    index, _ = refractive_index(radius)
    state = np.array([0.0, radius, index * math.cos(apparent), index * math.sin(apparent)])
    while True:
        outward = float(state[:2] @ state[2:])
        height = math.hypot(state[0], state[1]) - GROUND
        if outward > 0.0 and height > 130.0:
            return abs(apparent - math.atan2(state[3], state[2]))
        step = STEP if height < 140.0 else 20.0
        a = change(state)
        b = change(state + 0.5 * step * a)
        c = change(state + 0.5 * step * b)
        d = change(state + step * c)
        state = state + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)


@pytest.mark.parametrize(
    ("altitude", "above"),
    [
        *[(0.0, angle) for angle in (0.0, 1.0, 10.0, 45.0)],
        *[(10.0, angle) for angle in (0.01, 1.0, 3.0, 3.3, 20.0)],
        *[(400.0, angle) for angle in (0.01, 0.1, 0.5, 1.0)],
    ],
)
def test_rays_are_bent_as_a_traced_one_within_two_percent(altitude, above):
    """Angles above the horizon, in degrees, on either side of the observer's horizontal."""
    air = Refraction(altitude)
    apparent = air.horizon + math.radians(above)
    expected = traced_bending(altitude, apparent)
    assert air.bending(apparent) == pytest.approx(expected, rel=0.02, abs=1e-7)


def test_a_ray_that_grazes_the_limb_is_bent_twice():
    assert math.degrees(Refraction(0.0).bending(0.0)) * 60.0 == pytest.approx(34.0)
    orbit = Refraction(400.0)
    assert math.degrees(orbit.bending(orbit.horizon)) * 60.0 == pytest.approx(68.0, rel=0.01)


@pytest.mark.parametrize("altitude", [0.0, 0.5, 10.0, 400.0, 36000.0])
def test_bending_goes_on_through_the_horizontal(altitude):
    air = Refraction(altitude)
    angles = np.linspace(max(air.horizon, -0.02), 0.02, 401)
    bending = np.array([air.bending(angle) for angle in angles])
    assert np.all(np.diff(bending) <= 0.0)
    assert np.abs(np.diff(bending, n=2)).max() < 1e-6


@pytest.mark.parametrize("elevation", [0.0, 1.0, 5.0, 20.0, 60.0])
def test_at_sea_level_it_is_close_to_saemundssons_formula(elevation):
    angle = math.radians(elevation)
    assert Refraction(0.0).lift(angle) == pytest.approx(earth.refraction(angle), rel=0.06)


@pytest.mark.parametrize("altitude", [0.0, 0.002, 3.0, 10.0, 400.0])
def test_a_sun_that_sets_lower_is_never_seen_higher(altitude):
    horizon = Horizon("earth", altitude)
    elevations = np.radians(np.linspace(-35.0, 30.0, 1301))
    seen = np.array([angle + horizon.lift(angle) for angle in elevations])
    assert np.all(np.diff(seen) > 0.0)
    assert np.abs(np.diff(seen - elevations)).max() < math.radians(0.05)


@pytest.mark.parametrize("altitude", [0.0, 0.002, 3.0, 10.0, 400.0])
def test_the_sun_rises_where_its_upper_edge_is_seen_on_the_horizon_of_maps(altitude):
    """Where Sæmundsson's formula at sea level has 34.4'."""
    horizon = Horizon("earth", altitude)
    upper_edge = horizon.risen(1.0) + math.radians(16.0 / 60.0)
    seen = upper_edge + horizon.lift(upper_edge)
    assert seen == pytest.approx(-horizon.dip, abs=math.radians(0.4 / 60.0))


def test_without_refraction_nothing_is_lifted_from_orbit():
    horizon = Horizon("earth", 400.0, refraction=False)
    assert horizon.lift(-horizon.dip) == 0.0
    assert horizon.risen(1.0) == pytest.approx(-horizon.dip - math.radians(16.0 / 60.0))
