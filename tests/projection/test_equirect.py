import functools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.angles import zenith_azimuth
from skybake.projection import equirect

SUN_RADIUS = math.radians(0.2666)
SIZES = [64, 1024, 16384]
ELEVATIONS = [-89.9, -45.0, -0.1, 0.13, 5.0, 60.0, 87.0, 89.95, 90.0]


@functools.cache
def flux_on_map(width, elevation, bearing, radius=SUN_RADIUS):
    """Flux and its vertical component of an even disc of radiance 1, cells and texels."""
    height = width // 2
    cells = equirect.EquirectChart(width).disc_cells(
        math.radians(90.0 - elevation), bearing, radius
    )
    texel_flux = cells.weight * cells.solid_angle[:, None]
    row = cells.texel // width
    size = equirect.solid_angles(width, height)[row]
    cosine = np.cos(equirect.row_zeniths(height))[row]
    on_map = (texel_flux * size).sum(), (texel_flux * size * cosine).sum()
    on_disc = cells.solid_angle.sum(), (cells.solid_angle * np.cos(cells.zenith)).sum()
    return on_map, on_disc


@pytest.mark.parametrize("width", [4, 64, 1000, 16384])
def test_solid_angles_of_a_map_sum_to_4_pi(width):
    total = width * equirect.solid_angles(width, width // 2).sum()
    assert total == pytest.approx(4.0 * math.pi, rel=1e-12)


def test_solid_angle_of_a_row_is_its_zone():
    size = 512 * equirect.solid_angles(512, 256)
    upper = math.pi * np.arange(256) / 256
    zone = 2.0 * math.pi * (np.cos(upper) - np.cos(upper + math.pi / 256))
    np.testing.assert_allclose(size, zone, rtol=1e-12)


@pytest.mark.parametrize(
    ("column", "row", "axis"),
    [
        (0.0, 0.5, (0, 0, -1)),  # north at the left edge
        (0.25, 0.5, (1, 0, 0)),
        (0.5, 0.5, (0, 0, 1)),  # south in the middle
        (0.75, 0.5, (-1, 0, 0)),
        (0.5, 0.0, (0, 1, 0)),
        (0.5, 1.0, (0, -1, 0)),
    ],
)
def test_places_of_the_axes(column, row, axis):
    """Centres lie half a texel from the edges, so within the texels' half diagonal."""
    width = 512
    vectors = equirect.directions(width, width // 2)
    i = min(int(row * width / 2), width // 2 - 1)
    j = min(int(column * width), width - 1)
    assert math.acos(min(vectors[i, j] @ axis, 1.0)) < 1.5 * math.pi / (width / 2)


def test_directions_are_the_zeniths_and_bearings_of_their_rows_and_columns():
    vectors = equirect.directions(64, 32)
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=-1), 1.0, rtol=1e-14)
    zenith, bearing = zenith_azimuth(vectors)
    np.testing.assert_allclose(zenith, np.repeat(equirect.row_zeniths(32)[:, None], 64, 1))
    expected = np.repeat(equirect.column_bearings(64)[None], 32, 0)
    np.testing.assert_allclose(bearing % (2.0 * math.pi), expected)


@given(st.integers(0, 1023), st.integers(0, 511))
def test_every_texel_is_found_again_from_its_direction(column, row):
    zenith = equirect.row_zeniths(512)[row]
    bearing = equirect.column_bearings(1024)[column]
    vector = [
        math.sin(zenith) * math.sin(bearing),
        math.cos(zenith),
        -math.sin(zenith) * math.cos(bearing),
    ]
    back_zenith, back_bearing = zenith_azimuth(np.array(vector))
    assert back_zenith / math.pi * 512 == pytest.approx(row + 0.5, abs=1e-9)
    assert back_bearing % (2 * math.pi) / (2 * math.pi) * 1024 == pytest.approx(
        column + 0.5, abs=1e-9
    )


@pytest.mark.parametrize("elevation", ELEVATIONS)
@pytest.mark.parametrize("width", SIZES)
def test_disc_keeps_its_flux_on_the_map(width, elevation):
    (flux, _), (cells, _) = flux_on_map(width, elevation, 2.0)
    assert flux == pytest.approx(cells, rel=1e-6)


@pytest.mark.parametrize("elevation", ELEVATIONS)
@pytest.mark.parametrize("width", SIZES)
def test_cells_of_a_disc_cover_its_solid_angle(width, elevation):
    """A cap of 2 pi (1 - cos radius)."""
    _, (cells, _) = flux_on_map(width, elevation, 2.0)
    cap = 4.0 * math.pi * math.sin(SUN_RADIUS / 2.0) ** 2
    assert cells == pytest.approx(cap, rel=3e-4)


@pytest.mark.parametrize("elevation", [e for e in ELEVATIONS if abs(e) > 1.0])
@pytest.mark.parametrize("width", SIZES)
def test_disc_keeps_its_vertical_component_within_a_per_mille(width, elevation):
    """The first row's centre cannot light the ground as the zenith does.

    At 64x32 it looks 2.8 deg off the zenith, whose cosine is 0.12 % below 1.
    """
    (_, vertical), (_, expected) = flux_on_map(width, elevation, 2.0)
    is_corner = width == 64 and abs(elevation) > 87.0
    assert vertical == pytest.approx(expected, rel=1.25e-3 if is_corner else 1e-3)


@pytest.mark.parametrize("elevation", [-0.1, 5.0, 90.0])
@pytest.mark.parametrize("width", SIZES)
def test_cells_of_a_disc_keep_the_integral_of_limb_darkening(width, elevation):
    """Of 1 - u (1 - mu), the root of whose distance from the limb is hard to integrate."""
    cells = equirect.EquirectChart(width).disc_cells(
        math.radians(90.0 - elevation), 2.0, SUN_RADIUS
    )
    mu = np.sqrt(1.0 - (np.sin(cells.distance) / math.sin(SUN_RADIUS)) ** 2)
    got = (cells.solid_angle * (1.0 - 0.6 * (1.0 - mu))).sum()
    expected = (1.0 - 0.6 / 3.0) * math.pi * math.sin(SUN_RADIUS) ** 2
    assert got == pytest.approx(expected, rel=5e-4)


@given(st.floats(-90.0, 90.0), st.floats(0.0, 2.0 * math.pi))
def test_disc_of_any_place_keeps_its_flux_on_a_small_map(elevation, bearing):
    (flux, vertical), (cells, expected) = flux_on_map(128, elevation, bearing)
    assert flux == pytest.approx(cells, rel=1e-6)
    # The cosine of the first row's centre is 3e-4 below 1.
    assert vertical == pytest.approx(expected, abs=3.5e-4 * cells)


def test_disc_on_the_wrap_is_the_disc_elsewhere():
    width = 1024
    images = []
    for bearing, shift in ((0.0, 0), (math.pi, width // 2)):
        cells = equirect.EquirectChart(width).disc_cells(math.radians(60.0), bearing, SUN_RADIUS)
        image = np.bincount(
            cells.texel.ravel(),
            (cells.weight * cells.solid_angle[:, None]).ravel(),
            minlength=width * width // 2,
        )
        images.append(np.roll(image.reshape(width // 2, width), -shift, axis=1))
    np.testing.assert_allclose(*images, rtol=1e-6, atol=1e-9)


def test_a_sun_that_moves_by_a_tenth_of_a_texel_does_not_flicker():
    """Its brightest texel changes smoothly, as a sequence of frames needs."""
    width, step = 64, math.radians(5.625) / 10.0
    peaks = []
    for i in range(20):
        zenith = math.radians(45.0) + i * step
        cells = equirect.EquirectChart(width).disc_cells(zenith, 2.0, SUN_RADIUS)
        flux = cells.weight * cells.solid_angle[:, None]
        peaks.append(np.bincount(cells.texel.ravel(), flux.ravel()).max())
    assert np.abs(np.diff(np.log(peaks))).max() < 0.25
