"""A sun is convolved exactly, whatever the roughness."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from skybake.ibl.diffuse import diffuse_cube
from skybake.ibl.harmonics import harmonics_of
from skybake.ibl.points import disc, uniform_disc
from skybake.ibl.specular import SpecularFilter
from tests.ibl.maps import directions

SUN = np.array([0.48, 0.6, 0.64])
FLUX = np.array([3.0, 2.0, 1.0])
RADIUS = math.radians(0.2666)
DARK = np.zeros((6, 16, 16, 3), np.float32)


@pytest.fixture(scope="module")
def sun():
    return uniform_disc(SUN, FLUX, RADIUS)


def test_the_parts_of_a_disc_are_within_it_and_make_it_up():
    parts, distances, sizes = disc(SUN, RADIUS)
    assert np.linalg.norm(parts, axis=1) == pytest.approx(1.0)
    assert np.arccos(parts @ SUN) == pytest.approx(distances, abs=1e-7)
    assert distances.max() < RADIUS
    assert sizes.sum() == pytest.approx(2.0 * math.pi * (1.0 - math.cos(RADIUS)))


def test_irradiance_of_a_sun_is_its_own_times_the_cosine(sun):
    shown = diffuse_cube(DARK, sun, 32).reshape(-1, 3)
    cosine = np.maximum(directions(32) @ SUN, 0.0)
    # The disc sets over half a degree, the cosine at once.
    assert np.abs(math.pi * shown - cosine[:, None] * FLUX).max() < 2e-3 * FLUX.max()
    above = cosine > 2.0 * RADIUS
    assert (math.pi * shown / FLUX)[above] == pytest.approx(
        np.repeat(cosine[above, None], 3, 1), rel=2e-4
    )


@pytest.mark.parametrize("roughness", [0.05, 1 / 6, 0.5, 1.0])
def test_the_lobe_of_a_sun_is_an_independent_quadrature(sun, roughness):
    edge = 64
    shown = SpecularFilter(DARK, sun).cube(edge, roughness, 16).reshape(-1, 3)
    normals = directions(edge)
    apart = np.arccos(np.clip(normals @ SUN, -1.0, 1.0))
    nearest = np.argsort(apart)[[0, 1, 2, 5, 20, 100, 1000, 6000]]
    a = roughness**4

    def density(half):
        return a / (math.pi * (math.cos(half) ** 2 * (a - 1.0) + 1.0) ** 2)

    def all_around(half):
        return 8.0 * math.pi * density(half) * math.cos(half) * math.sin(half) * math.cos(2 * half)

    total = quad(all_around, 0.0, min(3e-3, math.pi / 4))[0]
    total += quad(all_around, min(3e-3, math.pi / 4), math.pi / 4, limit=200)[0]
    # A fine square grid over the disc.
    right = np.cross(SUN, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, SUN)
    step = np.linspace(-1.0, 1.0, 101) * RADIUS
    u, v = (grid.ravel() for grid in np.meshgrid(step, step))
    inside = np.hypot(u, v) < RADIUS
    parts = SUN + np.outer(u[inside], right) + np.outer(v[inside], up)
    parts /= np.linalg.norm(parts, axis=1)[:, None]
    for i in nearest:
        cosines = np.maximum(parts @ normals[i], -1.0)
        lobe = [density(0.5 * math.acos(min(c, 1.0))) * max(c, 0.0) for c in cosines]
        expected = np.mean(lobe) / total * FLUX
        assert shown[i] == pytest.approx(expected, rel=0.01, abs=1e-9)


def test_harmonics_of_a_sun_are_the_functions_in_its_direction(sun):
    x, y, z = SUN
    linear = math.sqrt(3.0 / (4.0 * math.pi))
    found = harmonics_of(DARK, sun)
    assert found[1] == pytest.approx(linear * y * FLUX, rel=1e-4)
    assert found[2] == pytest.approx(linear * z * FLUX, rel=1e-4)
    assert found[3] == pytest.approx(linear * x * FLUX, rel=1e-4)
    assert found[7] == pytest.approx(math.sqrt(15.0 / (4.0 * math.pi)) * x * z * FLUX, rel=1e-4)
