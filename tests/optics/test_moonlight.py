"""The light of the Moon above the air, against published magnitudes."""

import math

import numpy as np
import pytest

from skybake.colour.observer import xyz_weights
from skybake.optics.moonlight import LEVEL, disc_reflectance, earthshine, moon_share, sphere_phase
from skybake.optics.spectrum import star_at, star_spectrum
from skybake.preset import load_preset

SUN = star_spectrum(star_at(load_preset("earth").star, 1.0))
NODES = np.arange(380.0, 721.0, 5.0)
SUN_V = -26.76
MEAN = 384_400.0


def light(share):
    """XYZ of a share of the sunlight at 1 au. [lx]"""
    wavelengths, sunlight = SUN
    return xyz_weights(NODES, wavelengths, sunlight * share(wavelengths)).sum(axis=0)


def magnitude(degrees, level=LEVEL):
    phase = math.radians(degrees)
    moon = light(lambda nodes: moon_share(phase, nodes, MEAN, sun_longitude=-phase) / level)
    sun = light(np.ones_like)
    return SUN_V - 2.5 * math.log10(moon[1] / sun[1])


@pytest.mark.parametrize(("phase", "expected"), [(7.0, -12.55), (90.0, -10.03)])
def test_the_model_of_rolo_has_its_published_brightness(phase, expected):
    assert magnitude(phase, level=LEVEL) == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("phase", range(5, 101, 5))
def test_moonlight_follows_the_law_of_allen_within_a_seventh_of_a_magnitude(phase):
    assert magnitude(phase) == pytest.approx(-12.73 + 0.026 * phase + 4e-9 * phase**4, abs=0.15)


def test_moonlight_is_redder_than_sunlight_and_more_so_at_the_quarter():
    full, quarter, sun = (
        light(lambda nodes: moon_share(math.radians(2.0), nodes, MEAN)),
        light(lambda nodes: moon_share(math.radians(90.0), nodes, MEAN)),
        light(np.ones_like),
    )
    x, y = (np.array([each[k] / each.sum() for each in (sun, full, quarter)]) for k in (0, 1))
    assert (np.diff(x) > 0.005).all()
    assert x[1:] == pytest.approx([0.346, 0.355], abs=0.003)
    assert y[1:] == pytest.approx([0.352, 0.359], abs=0.003)


def test_the_light_goes_on_smoothly_where_the_model_ends():
    degrees = np.arange(0.0, 180.0, 0.25)
    values = [disc_reflectance(math.radians(g), np.array([550.0]))[0] for g in degrees]
    steps = np.diff(np.log(values))
    assert (steps <= 1e-12).all()
    assert steps[degrees[:-1] < 165.0].min() > -0.045
    assert values[0] == values[6]


def test_half_as_far_the_moon_is_four_times_as_bright():
    far, near = (moon_share(0.5, NODES, distance) for distance in (MEAN, 0.5 * MEAN))
    assert near == pytest.approx(4.0 * far)


def test_earthshine_near_new_moon_is_as_bright_as_it_is_measured():
    new = light(lambda nodes: earthshine(math.radians(160.0), nodes, MEAN))
    assert 0.3 < new[1] < 0.6
    full = light(lambda nodes: earthshine(math.radians(5.0), nodes, MEAN))
    assert full[1] < 2e-3
    # Bluer than moonlight is.
    moon = light(lambda nodes: moon_share(0.0, nodes, MEAN))
    assert new[2] / new[1] > 1.1 * moon[2] / moon[1]


def test_a_sphere_has_all_its_light_at_0_and_none_at_half_a_turn():
    assert (sphere_phase(0.0), sphere_phase(math.pi)) == (1.0, 0.0)
    # At 0 the law is cos / 2, whose integral over the lit side is 1.
    node, weight = np.polynomial.legendre.leggauss(64)
    omega, width = math.pi / 4 * (node + 1.0), math.pi / 4 * weight
    law = np.cos(omega) * np.sin(omega) / (np.cos(omega) + np.sin(omega))
    assert sphere_phase(math.pi / 2) == pytest.approx((law * width).sum(), rel=1e-9)
