"""Cameras of JSON files and of OpenEXR's attributes, and the pictures that they see."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skybake.errors import InputError
from skybake.projection import Perspective
from skybake.projection.camera import Camera, camera_from_angles, camera_from_attributes
from skybake.projection.camera_file import load_camera

angles = st.floats(-3.0, 3.0)
elevations = st.floats(-1.5, 1.5)


def world_to_camera(camera, *, is_left_handed):
    """What a renderer writes: row vectors; the viewing direction is +Z or -Z."""
    right, up, forward = camera.frame
    third = forward if is_left_handed else -forward
    turn = np.stack([right, up, third], axis=1)
    made = np.eye(4)
    made[:3, :3] = turn
    made[3, :3] = -np.array(camera.position) @ turn
    return made


def world_to_ndc(camera, *, is_standard):
    """Of OpenEXR, from 0 to 1 and y downward, or from -1 to 1 and y upward."""
    lens = np.zeros((4, 4))
    x, y = camera.half_width, camera.half_height
    right, up = camera.shift
    if is_standard:
        lens[0, 0], lens[2, 0] = 0.5 / x, 0.5 - 0.5 * right / x
        lens[1, 1], lens[2, 1] = -0.5 / y, 0.5 + 0.5 * up / y
    else:
        lens[0, 0], lens[2, 0] = 1.0 / x, -right / x
        lens[1, 1], lens[2, 1] = 1.0 / y, -up / y
    lens[2, 2], lens[2, 3], lens[3, 2] = 1.01, 1.0, -0.1
    return world_to_camera(camera, is_left_handed=True) @ lens


def assert_same(one, other):
    np.testing.assert_allclose(one.frame, other.frame, atol=1e-9)
    np.testing.assert_allclose(one.position, other.position, atol=1e-9)
    np.testing.assert_allclose(one.shift, other.shift, atol=1e-9)
    np.testing.assert_allclose(
        [one.half_width, one.half_height], [other.half_width, other.half_height], rtol=1e-9
    )


@given(angles, elevations, angles, st.booleans(), st.booleans())
@settings(deadline=None, max_examples=50)
def test_a_camera_comes_back_from_the_matrices_of_either_convention(
    azimuth, elevation, roll, is_standard, has_both
):
    made = camera_from_angles(azimuth, elevation, roll, 0.9, 1.5)
    made = Camera(made.frame, made.half_width, made.half_height, (0.1, -0.2), (0.4, 1.7, -2.0))
    attributes = {"worldToNDC": world_to_ndc(made, is_standard=is_standard).ravel()}
    if has_both:
        attributes["worldToCamera"] = world_to_camera(made, is_left_handed=is_standard).ravel()
    assert_same(camera_from_attributes(attributes, "x.exr", unit=1.0), made)


@pytest.mark.parametrize("is_left_handed", [True, False])
def test_a_world_to_camera_of_either_handedness_looks_the_same_way(is_left_handed):
    made = camera_from_angles(0.7, -0.3, 0.2, 0.9, 1.5)
    attributes = {"worldToCamera": world_to_camera(made, is_left_handed=is_left_handed)}
    assert_same(camera_from_attributes(attributes, "x.exr", fov=0.9, aspect=1.5), made)


def test_a_world_with_z_up_looks_north_along_y():
    """Blender's camera that looks along +Y from 2 m above the ground, its matrix transposed."""
    camera_to_world = np.array([[1, 0, 0, 5], [0, 0, -1, 7], [0, 1, 0, 2], [0, 0, 0, 1.0]])
    placed = np.linalg.inv(camera_to_world).T
    seen = camera_from_attributes({"worldToCamera": placed}, "x.exr", fov=1.0, up="z")
    np.testing.assert_allclose(seen.frame, [[1, 0, 0], [0, 1, 0], [0, 0, -1]], atol=1e-12)
    np.testing.assert_allclose(seen.position, [0.005, 0.002, -0.007])


@given(angles, elevations, angles)
@settings(deadline=None, max_examples=50)
def test_a_picture_of_a_camera_looks_where_the_camera_does(azimuth, elevation, roll):
    made = camera_from_angles(azimuth, elevation, roll, 0.9, 2.0)
    made = Camera(made.frame, made.half_width, made.half_height, (0.1, -0.05))
    picture = Perspective.of_camera(made, 40)
    right, up, forward = made.frame
    seen = picture.vectors()[0, -1]
    u = made.shift[0] + made.half_width * 39 / 40
    v = made.shift[1] + made.half_height * 19 / 20
    expected = forward + u * right + v * up
    np.testing.assert_allclose(seen, expected / np.linalg.norm(expected), atol=2e-6)


def test_a_camera_that_rolls_clockwise_sees_its_right_sink():
    right = camera_from_angles(0.0, 0.0, math.radians(90), 1.0, 1.0).frame[0]
    np.testing.assert_allclose(right, [0, -1, 0], atol=1e-12)


def test_the_sun_of_a_rolled_and_shifted_picture_is_where_the_picture_shows_its_direction():
    picture = Perspective(200, 100, 0.5, roll=0.6, shift=(0.2, -0.1))
    (canvas,) = picture.canvases()
    (part,) = canvas.parts
    zenith, bearing = part.chart.angles(0, 100)
    cells = part.chart.disc_cells(float(zenith[30, 140]), float(bearing[30, 140]), 0.004)
    rows, columns = np.divmod(np.unique(cells.texel[:, 0][cells.solid_angle > 0.0]), 200)
    assert abs(rows.mean() - 30) < 1
    assert abs(columns.mean() - 140) < 1
    row, column = part.chart.places(part.chart.vectors(30, 31)[0, 140])
    np.testing.assert_allclose([row, column], [30.5, 140.5])


@pytest.fixture
def written(tmp_path):
    def write(told):
        path = tmp_path / "camera.json"
        path.write_text(json.dumps(told))
        return path

    return write


def test_a_focal_length_and_a_vertical_angle_tell_the_width(written):
    told = {"azimuth": 90, "elevation": 10}
    lens = load_camera(written({**told, "focal_length": 50, "sensor_width": 36}), aspect=1.5)
    assert lens.half_width == pytest.approx(0.36)
    assert lens.half_height == pytest.approx(0.24)
    vertical = load_camera(written({**told, "fov_vertical": 40, "aspect": 2}))
    assert vertical.half_height == pytest.approx(math.tan(math.radians(20)))
    assert vertical.half_width == pytest.approx(2 * vertical.half_height)


def test_lengths_of_a_camera_file_are_in_its_units(written):
    told = {"azimuth": 0, "elevation": 0, "fov": 50, "position": [0, 200, 0], "units": "cm"}
    assert load_camera(written(told)).position == (0, pytest.approx(0.002), 0)


singular = [1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1]
sheared = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1]
columns = [1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
unit = np.eye(4).ravel().tolist()


@pytest.mark.parametrize(
    ("told", "problem"),
    [
        ({}, "got no azimuth"),
        ([], "must be a JSON object, got list"),
        ({"azimuth": 0, "elevation": 0}, "fov must be given"),
        ({"azimuth": 0, "elevation": 95, "fov": 50}, "elevation must be from -90 to 90, got 95"),
        ({"azimuth": "north", "elevation": 0}, "fov must be given"),
        ({"azimuth": "n", "elevation": 0, "fov": 50}, "azimuth must be a finite number, got 'n'"),
        ({"azimuth": 0, "elevation": 0, "fov": 180}, "fov must be greater than 0 and less"),
        ({"fov": 50, "fov_vertical": 50}, "fov_vertical cannot be combined with fov"),
        ({"focal_length": 50}, "focal_length and sensor_width must be greater than 0"),
        ({"look": 5}, "unknown key 'look'; known keys: worldToCamera"),
        ({"units": "inch"}, "units must be one of m, cm, mm, km, ft, got 'inch'"),
        ({"up_axis": "x"}, "up_axis must be y or z, got 'x'"),
        ({"aspect": 0}, "aspect must be greater than 0, got 0"),
        ({"worldToCamera": [1, 2, 3]}, "must be 16 numbers, got an array of shape (3,)"),
        ({"worldToCamera": "unit"}, "worldToCamera: must be 16 numbers"),
        ({"worldToCamera": unit}, "does not tell how wide the picture is"),
        ({"worldToCamera": singular, "fov": 50}, "must not be singular, got rows 1 0 0 0 1 0"),
        ({"worldToCamera": sheared, "fov": 50}, "without shear"),
        ({"worldToCamera": columns, "fov": 50}, "must be transposed"),
        ({"worldToNDC": unit}, "must be of a perspective camera"),
        ({"worldToNDC": [0] * 16}, "must be of a perspective camera"),
        ({"worldToNDC": [math.nan] * 16}, "must be finite, got nan"),
    ],
)
def test_a_faulty_camera_file_is_refused_in_one_line_that_says_why(written, told, problem):
    path = written(told)
    with pytest.raises(InputError) as caught:
        load_camera(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert problem in message
    assert "\n" not in message


def test_matrices_that_disagree_are_refused():
    made = camera_from_angles(0.7, -0.3, 0.2, 0.9, 1.5)
    other = camera_from_angles(0.8, -0.3, 0.2, 0.9, 1.5)
    attributes = {
        "worldToCamera": world_to_camera(other, is_left_handed=True),
        "worldToNDC": world_to_ndc(made, is_standard=True),
    }
    with pytest.raises(InputError, match="must agree"):
        camera_from_attributes(attributes, "x.exr")
