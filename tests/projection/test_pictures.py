"""Fisheye and perspective pictures: where pixels look, and discs that keep their flux."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.angles import direction_from_angles
from skybake.errors import InputError
from skybake.projection import PROJECTIONS, Fisheye, Perspective, find_projection
from skybake.projection.frame import look_frame

SUN_RADIUS = math.radians(0.2666)
CAP = 4.0 * math.pi * math.sin(SUN_RADIUS / 2.0) ** 2

NORTH, EAST, SOUTH, WEST, UP = (0, 0, -1), (1, 0, 0), (0, 0, 1), (-1, 0, 0), (0, 1, 0)


def chart(projection):
    (canvas,) = projection.canvases()
    (part,) = canvas.parts
    return part.chart


def vectors(made):
    zenith, bearing = made.angles(0, made.height)
    zenith, bearing = np.broadcast_arrays(zenith, bearing)
    return np.stack(
        [np.sin(zenith) * np.sin(bearing), np.cos(zenith), -np.sin(zenith) * np.cos(bearing)],
        axis=-1,
    )


def degrees_between(a, b):
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    return math.degrees(2.0 * math.asin(min(0.5 * float(np.linalg.norm(a - b)), 1.0)))


@given(st.floats(-7.0, 7.0), st.floats(-math.pi / 2, math.pi / 2))
def test_axes_of_a_picture_are_right_handed_and_of_length_1(azimuth, elevation):
    right, up, forward = look_frame(azimuth, elevation)
    np.testing.assert_allclose(np.cross(right, up), -forward, atol=1e-12)
    np.testing.assert_allclose(np.cross(up, forward), -right, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm([right, up, forward], axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(forward, direction_from_angles(azimuth, elevation), atol=1e-12)
    assert abs(right[1]) < 1e-12
    assert up[1] > -1e-12


@pytest.mark.parametrize(
    ("place", "axis"), [((50, 50), UP), ((100, 50), SOUTH), ((0, 50), NORTH), ((50, 0), EAST)]
)
def test_a_fisheye_shows_the_sky_as_one_sees_it_lying_on_the_back(place, axis):
    """Row and column of 101 pixels; the horizon is the rim, half a pixel outside."""
    seen = vectors(chart(Fisheye(101)))
    assert degrees_between(seen[place], axis) < 180.0 / 101 * 0.51


def test_distance_from_the_middle_of_a_fisheye_is_the_angle_from_the_zenith():
    made = chart(Fisheye(64, fov=math.radians(200.0)))
    zenith, _ = made.angles(0, 64)
    x, y = np.meshgrid(np.arange(64) - 31.5, np.arange(64) - 31.5)
    np.testing.assert_allclose(np.degrees(zenith), np.hypot(x, y) * 200.0 / 64, rtol=1e-9)
    np.testing.assert_array_equal(made.looks_nowhere(0, 64), np.hypot(x, y) > 32.0)


def test_a_perspective_covers_its_angle_from_the_left_edge_to_the_right():
    made = chart(Perspective(1000, 500, math.radians(60.0), math.radians(90.0), 0.0))
    seen = vectors(made)
    middle = seen[249:251].mean(axis=0)
    pixel = math.degrees(2.0 * math.tan(math.radians(30.0)) / 1000 * 0.75)
    assert degrees_between(middle[0], middle[-1]) == pytest.approx(60.0 - pixel, abs=1e-3)
    assert degrees_between(middle[499:501].mean(axis=0), EAST) < 0.01
    # Left of east is north, and row 0 looks up.
    assert middle[0] @ np.array(NORTH) == pytest.approx(math.sin(math.radians(30.0)), abs=1e-3)
    assert seen[0, 500, 1] == pytest.approx(
        math.sin(math.atan(0.5 * math.tan(math.radians(30.0)))), abs=1e-3
    )


PICTURES = [
    Perspective(64, 48, math.radians(90.0), 1.0, 0.2),
    Perspective(512, 288, math.radians(30.0), 4.0, -0.4),
    Perspective(40, 40, math.radians(150.0), 0.0, 1.0),
    Fisheye(64),
    Fisheye(256, math.radians(220.0)),
    Fisheye(200, math.radians(120.0), 2.0, 0.3),
]


@pytest.mark.parametrize("picture", PICTURES)
@pytest.mark.parametrize("aside", [(0.0, 0.0), (0.1, -0.2), (-0.3, 0.15)])
def test_a_disc_keeps_its_flux_and_its_place(picture, aside):
    made = chart(picture)
    # A sun that lies in the picture.
    frame = look_frame(picture.azimuth, picture.elevation)
    place = frame.forward + aside[0] * frame.right * 0.5 + aside[1] * frame.up * 0.5
    place /= np.linalg.norm(place)
    zenith, bearing = math.acos(place[1]), math.atan2(place[0], -place[2])
    cells = made.disc_cells(zenith, bearing, SUN_RADIUS)
    assert cells.solid_angle.sum() == pytest.approx(CAP, rel=5e-4)
    texel, size = cells.texel[:, 0], made.solid_angles(0, made.height).ravel()
    flux = cells.weight[:, 0] * cells.solid_angle * size[texel]
    assert flux.sum() == pytest.approx(cells.solid_angle.sum(), rel=1e-9)
    centre = flux @ vectors(made).reshape(-1, 3)[texel] / flux.sum()
    width = math.degrees(math.sqrt(size[texel].max()))
    assert degrees_between(centre / np.linalg.norm(centre), place) < width


@pytest.mark.parametrize("picture", PICTURES)
def test_a_disc_behind_a_picture_leaves_it_untouched(picture):
    x, y, z = -look_frame(picture.azimuth, picture.elevation).forward
    cells = chart(picture).disc_cells(math.acos(y), math.atan2(x, -z), SUN_RADIUS)
    assert cells.distance.size == 0


@pytest.mark.parametrize("picture", PICTURES)
def test_a_disc_that_a_pictures_edge_cuts_is_there_in_part(picture):
    """The left edge of a perspective, the rim of a fisheye."""
    right, _, forward = look_frame(picture.azimuth, picture.elevation)
    half = 0.5 * picture.fov
    x, y, z = math.cos(half) * forward - math.sin(half) * right
    cells = chart(picture).disc_cells(math.acos(y), math.atan2(x, -z), SUN_RADIUS)
    assert 0.3 * CAP < cells.solid_angle.sum() < 0.7 * CAP
    assert np.isfinite(cells.weight).all()


def test_solid_angles_of_a_fisheye_make_the_hemisphere():
    size = chart(Fisheye(512)).solid_angles(0, 512)
    assert size.sum() == pytest.approx(2.0 * math.pi, rel=2e-3)


def test_solid_angles_of_a_perspective_make_its_pyramid():
    size = chart(Perspective(200, 100, math.radians(80.0))).solid_angles(0, 100)
    a, b = math.tan(math.radians(40.0)), 0.5 * math.tan(math.radians(40.0))
    whole = 4.0 * math.asin(a * b / math.sqrt((1.0 + a * a) * (1.0 + b * b)))
    assert size.sum() == pytest.approx(whole, rel=1e-9)


@pytest.mark.parametrize("picture", PICTURES)
def test_footprints_are_the_steps_of_the_zenith_angle_between_pixels(picture):
    """Root of the sum of squares of the differences to the right and downward."""
    made = chart(picture)
    zenith, _ = made.angles(0, made.height)
    across, along = np.gradient(zenith)
    footprint = np.broadcast_to(made.footprints(0, made.height), zenith.shape)
    # Zenith angles have a kink at the zenith, and gradients are one-sided at edges.
    smooth = (zenith > 0.3) & (zenith < math.pi - 0.3)
    smooth[[0, -1]] = smooth[:, [0, -1]] = False
    np.testing.assert_allclose(footprint[smooth], np.hypot(across, along)[smooth], rtol=0.05)


def test_a_band_of_rows_is_that_band_of_the_picture():
    for picture in PICTURES:
        made = chart(picture)
        for whole, band in zip(made.angles(0, made.height), made.angles(5, 9), strict=True):
            np.testing.assert_array_equal(whole[5:9], band)
        np.testing.assert_array_equal(made.footprints(0, made.height)[5:9], made.footprints(5, 9))


@pytest.mark.parametrize(
    ("name", "size", "options", "fault"),
    [
        ("panorama", None, {}, "projection"),
        ("perspective", (64,), {}, "width and height"),
        ("perspective", (64, 32), {"fov": math.radians(171.0)}, "170deg"),
        ("perspective", (64, 0), {}, "size"),
        ("perspective", (64, 32), {"elevation": 1.7}, "elevation"),
        ("perspective", (64, 32), {"azimuth": math.nan}, "azimuth"),
        ("fisheye", (64, 32), {}, "square"),
        ("fisheye", (64,), {"fov": 0.0}, "fov"),
        ("fisheye", (64,), {"fov": math.radians(280.0)}, "270deg"),
        ("equirect", (64, 33), {}, "twice"),
        ("equirect", (64, 32), {"fov": 1.0}, "fov"),
        ("cubemap", (64, 64), {}, "edge"),
        ("cubemap", (64,), {"layout": "star"}, "star"),
    ],
)
def test_a_shape_that_a_projection_has_not_is_refused(name, size, options, fault):
    with pytest.raises(InputError, match=fault):
        find_projection(name, size, options)


@pytest.mark.parametrize("name", PROJECTIONS)
def test_every_projection_makes_a_small_picture_of_itself(name):
    made = find_projection(name)
    for small in (made.smaller(64), made.glance(64)):
        (canvas,) = small.canvases()
        assert canvas.width == (64 if name != "perspective" or small != made else 1920)
        assert canvas.height > 0
