import math

import numpy as np
import pytest

from skybake.preset import load_preset
from skybake.sky.disc import Disc
from skybake.sky.sky import WAVELENGTHS, Sky

AU = 149_597_870.7
SUN = 695_700.0


def disc(preset="earth", elevation=30.0, altitude=0.0):
    sky = Sky(load_preset(preset), math.radians(elevation), altitude, method="hillaire")
    return Disc(sky.skylight, sky.source)


@pytest.mark.parametrize(("preset", "distance"), [("earth", 1.0), ("mars", 1.5237)])
def test_angular_radius_is_the_stars_over_its_distance(preset, distance):
    assert disc(preset).angular_radius == pytest.approx(math.asin(SUN / (distance * AU)), rel=1e-6)


def test_sun_over_earth_covers_68_microsteradian():
    radius = disc().angular_radius
    assert 2.0 * math.pi * (1.0 - math.cos(radius)) == pytest.approx(6.80e-5, rel=5e-3)


@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_bare_disc_holds_all_irradiance(preset):
    sun = disc(preset)
    edge = np.linspace(0.0, 1.0, 20001)
    # Substituting the distance by R sin(x) takes the root out of the limb.
    x = 0.5 * math.pi * 0.5 * (edge[1:] + edge[:-1])
    distance = np.arcsin(math.sin(sun.angular_radius) * np.sin(x))
    measure = 2.0 * math.pi * math.sin(sun.angular_radius) ** 2 * np.sin(x) * np.cos(x)
    ring = sun.bare_radiance(distance) * measure[:, None] * np.diff(edge)[:, None] * 0.5 * math.pi
    np.testing.assert_allclose(ring.sum(axis=0), 1.0, rtol=1e-4)


def test_limb_is_darker_and_redder_than_the_centre():
    """Allen's Astrophysical Quantities: at mu 0.1, 0.36 of the centre in the green."""
    sun = disc()
    mu = 0.1
    distance = np.array([0.0, math.asin(math.sin(sun.angular_radius) * math.sqrt(1 - mu * mu))])
    centre, limb = sun.bare_radiance(distance)
    ratio = limb / centre
    assert (np.diff(ratio) > 0.0).all()
    assert np.interp(550.0, WAVELENGTHS, ratio) == pytest.approx(0.40, abs=0.06)


def test_nothing_shines_beyond_the_edge():
    sun = disc()
    outside = sun.angular_radius * np.array([1.0001, 1.5, 100.0])
    assert (sun.bare_radiance(outside) == 0.0).all()


@pytest.mark.parametrize(
    ("elevation", "tolerance"), [(90.0, 1e-4), (30.0, 3e-4), (5.0, 0.01), (1.0, 0.06)]
)
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_direct_irradiance_is_the_transmittance_of_the_centre(preset, elevation, tolerance):
    """The lower the sun, the more air masses its disc spans."""
    sun = disc(preset, elevation)
    normal, horizontal = sun.irradiance_per_irradiance()
    centre = sun.transmittance(np.array([math.radians(90.0 - elevation)]))[0]
    bright = centre > 1e-3
    np.testing.assert_allclose(normal[bright], centre[bright], rtol=tolerance)
    sine = math.sin(math.radians(elevation))
    np.testing.assert_allclose(horizontal[bright], normal[bright] * sine, rtol=tolerance)


def test_the_sun_sets_over_its_own_width():
    """Geometric horizon, without refraction: gone at -0.27 deg, whole at +0.27 deg."""
    light = [disc("mars", e).irradiance_per_irradiance()[0].sum() for e in (0.2, 0.0, -0.1, -0.2)]
    assert (np.diff(light) < 0.0).all()
    assert disc("mars", -0.18).irradiance_per_irradiance()[0].sum() == 0.0
    assert disc("mars", -0.17).irradiance_per_irradiance()[0].sum() > 0.0


@pytest.mark.parametrize("altitude", [10.0, 400.0])
def test_the_sun_is_seen_below_the_horizontal_from_on_high(altitude):
    planet = load_preset("earth")
    dip = math.degrees(math.acos(planet.radius / (planet.radius + altitude)))
    above = disc("earth", -dip + 0.5, altitude).irradiance_per_irradiance()[0]
    below = disc("earth", -dip - 0.3, altitude).irradiance_per_irradiance()[0]
    assert above.sum() > 0.0
    assert below.sum() == 0.0


def test_no_air_is_in_front_of_the_sun_in_space():
    normal, _ = disc("earth", 30.0, 400.0).irradiance_per_irradiance()
    np.testing.assert_allclose(normal, 1.0, rtol=1e-12)


def test_a_low_sun_is_red():
    transmittance = disc("earth", 2.0).irradiance_per_irradiance()[0]
    assert transmittance[-1] > 20.0 * transmittance[0]
