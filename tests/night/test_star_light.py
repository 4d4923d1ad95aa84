"""The catalogue, and the light of stars."""

import math

import numpy as np
import pytest

from skybake.colour.observer import load_observer, xyz_weights
from skybake.night.catalogue import load_catalogue
from skybake.night.star_light import star_irradiance
from skybake.optics.spectrum import star_irradiance as sun_irradiance
from skybake.preset import load_preset

NODES, _ = load_observer()
WEIGHTS = xyz_weights(NODES, NODES, np.ones_like(NODES))


def xyz_of(v, b_v):
    return star_irradiance(np.array([v]), np.array([b_v]), NODES)[0] @ WEIGHTS


def test_the_catalogue_has_the_light_of_hipparcos():
    # Hipparcos has 95.7 stars of V = 0 up to V = 6.5.
    stars = load_catalogue()
    assert len(stars.v) == 8874
    assert (10.0 ** (-0.4 * stars.v)).sum() == pytest.approx(95.7, rel=2e-3)
    assert (np.diff(stars.v) >= 0.0).all()


def test_a_limit_leaves_the_fainter_ones_out():
    # 22 stars are of first magnitude by the usual lists, to V = 1.5, with one more of 1.5 exactly.
    assert 20 <= len(load_catalogue().brighter_than(1.5).v) <= 23
    assert load_catalogue().brighter_than(-1.44).v.size == 1


def test_the_sun_as_a_star_is_as_bright_as_the_sun():
    # V -26.76 and B-V 0.654 make an illuminance of 133.1 klx.
    assert xyz_of(-26.76, 0.654)[1] == pytest.approx(133.1e3, rel=0.01)
    wavelengths = np.array([440.0, 550.0])
    star = star_irradiance(np.array([-26.76]), np.array([0.654]), wavelengths)[0]
    sun = sun_irradiance(load_preset("earth").star, wavelengths)
    np.testing.assert_allclose(star, sun, rtol=0.04)


@pytest.mark.parametrize(
    ("b_v", "x", "y"), [(-0.3, 0.2459, 0.2429), (0.0, 0.2684, 0.2733), (0.65, 0.3262, 0.3342)]
)
def test_stars_have_the_colour_of_their_b_v(b_v, x, y):
    # The first two by an independent calculation; the sun's is x 0.3234, y 0.3327.
    xyz = xyz_of(0.0, b_v)
    assert xyz[:2] / xyz.sum() == pytest.approx((x, y), abs=0.004)


def test_a_magnitude_is_a_factor_of_the_fifth_root_of_a_hundred():
    assert xyz_of(0.0, 1.0)[1] / xyz_of(5.0, 1.0)[1] == pytest.approx(100.0)
    assert 2.53e-6 < xyz_of(0.0, -0.3)[1] < xyz_of(0.0, 1.5)[1] < 2.78e-6
    assert math.isfinite(xyz_of(6.5, 3.332)[1])
