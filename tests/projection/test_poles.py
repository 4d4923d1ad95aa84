"""Equirect maps whose first and last rows are the poles, as the letter of OpenEXR has them."""

import math

import numpy as np
import pytest

from skybake.projection import Equirect
from skybake.projection.equirect import EquirectChart, row_zeniths, solid_angles

SUN_RADIUS = math.radians(0.2666)
CAP = 4.0 * math.pi * math.sin(0.5 * SUN_RADIUS) ** 2
ELEVATIONS = [-89.9, -45.0, -0.1, 0.13, 5.0, 60.0, 87.0, 88.0, 89.95, 90.0]


def disc_on(rows, width, elevation):
    """Pixel values of an even disc of radiance 1."""
    chart = EquirectChart(width, rows)
    cells = chart.disc_cells(math.radians(90.0 - elevation), 2.0, SUN_RADIUS)
    flux = (cells.weight * cells.solid_angle[:, None]).ravel()
    return np.bincount(cells.texel.ravel(), flux, width * chart.height).reshape(chart.height, width)


def read_by_the_letter(image):
    """Flux of a map and its vertical component, where row i is at pi i / (height - 1).

    A reader interpolates between rows, as Mitsuba's envmap does; here by Simpson's rule, 8
    intervals between two rows.
    """
    height, width = image.shape
    rows = image.sum(axis=1) * 2.0 * math.pi / width
    fine = 8 * (height - 1)
    theta = np.linspace(0.0, math.pi, fine + 1)
    radiance = np.interp(theta, np.linspace(0.0, math.pi, height), rows)
    weight = np.where(np.arange(fine + 1) % 2, 4.0, 2.0)
    weight[[0, -1]] = 1.0
    weight *= math.pi / fine / 3.0 * np.sin(theta)
    return (weight * radiance).sum(), (weight * radiance * np.cos(theta)).sum()


@pytest.mark.parametrize("elevation", ELEVATIONS)
@pytest.mark.parametrize("width", [64, 1024, 2048])
def test_a_reader_of_the_letter_finds_the_energy_of_the_disc(width, elevation):
    flux, vertical = read_by_the_letter(disc_on("poles", width, elevation))
    assert flux == pytest.approx(CAP, rel=4e-4)
    expected = CAP * math.sin(math.radians(elevation))
    assert vertical == pytest.approx(expected, abs=1.6e-3 * CAP if width == 64 else 4e-4 * CAP)


def test_such_a_reader_loses_half_of_a_sun_in_the_zenith_where_rows_are_centred():
    """Mitsuba itself has 0.47 of the flux of a darkened disc at 90 deg, and 0.96 at 88 deg."""
    shares = [read_by_the_letter(disc_on("centres", 2048, each))[0] / CAP for each in (90.0, 88.0)]
    assert shares == pytest.approx([0.4865, 0.96], abs=0.005)


@pytest.mark.parametrize("width", [4, 64, 1000, 16384])
def test_solid_angles_sum_to_4_pi(width):
    total = width * solid_angles(width, width // 2, "poles").sum()
    assert total == pytest.approx(4.0 * math.pi, rel=1e-10)


@pytest.mark.parametrize("height", [2, 32, 500])
def test_solid_angles_are_the_weights_of_rows_in_an_interpolated_map(height):
    """Integrals of the hat functions of rows over the sphere, by trapezoids."""
    step = math.pi / (height - 1)
    theta = np.linspace(0.0, math.pi, (height - 1) * 64 + 1)
    size = solid_angles(2 * height, height, "poles")
    for row in {0, 1, height // 2, height - 1}:
        hat = np.maximum(1.0 - np.abs(theta / step - row), 0.0) * np.sin(theta)
        assert size[row] == pytest.approx(np.trapezoid(hat, theta) * math.pi / height, rel=1e-3)


def test_the_first_row_is_the_zenith_and_the_last_the_nadir():
    (canvas,) = Equirect(64, "poles").canvases()
    zenith, bearing = canvas.parts[0].chart.angles(0, 32)
    assert zenith[[0, -1], 0].tolist() == [0.0, math.pi]
    np.testing.assert_allclose(np.diff(zenith[:, 0]), math.pi / 31)
    np.testing.assert_array_equal(bearing, EquirectChart(64).angles(0, 32)[1])
    assert canvas.envmap == "latlong"
    np.testing.assert_array_equal(row_zeniths(32, "poles"), zenith[:, 0])


def test_the_recipe_and_the_name_say_where_rows_are():
    assert Equirect(64).recipe()["equirect_rows"] == "centres"
    assert Equirect(64, "poles").recipe()["equirect_rows"] == "poles"
    assert (Equirect(64).label, Equirect(64, "poles").label) == ("equirect", "equirect_poles")
