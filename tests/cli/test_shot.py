"""Shots, as users type them."""

import json
import math

import numpy as np
import OpenImageIO
import pytest

from skybake.formats.reader import read_image
from tests.cli.runs import invoke, listing

SMALL = ("shot", "--size", "64x36", "-q")
ORBIT = ("--altitude", "400km", "--sun", "-10deg")


def shot(*arguments):
    result = invoke(*SMALL, *arguments)
    assert result.exit_code == 0, result.stderr
    return result


@pytest.mark.usefixtures("warm")
def test_a_shot_is_the_perspective_map_of_the_same_view_and_a_picture_of_it(folder):
    shot("--sun", "20deg", "--look", "170,5", "--preview", "-o", "a.exr")
    view = ("--projection", "perspective", "--size", "64x36", "--look", "170,5")
    assert (
        invoke("render", "--sun", "20deg", *view, "-q", "--preview", "-o", "b.exr").exit_code == 0
    )
    assert (folder / "a.exr").read_bytes() == (folder / "b.exr").read_bytes()
    assert (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()


@pytest.mark.usefixtures("warm")
def test_a_rolled_camera_shows_the_horizon_upright(folder):
    shot("--look", "horizon,90", "--roll", "90deg", "--no-preview", "-o", "a.exr")
    assert listing(folder) == ["a.exr"]
    pixels, _ = read_image(folder / "a.exr")
    # Clockwise: the ground is to the right.
    blue_to_red = pixels[:, :, 2] / pixels[:, :, 0]
    assert blue_to_red[:, :20].min() > blue_to_red[:, -20:].max()


@pytest.mark.usefixtures("warm")
def test_a_camera_of_a_file_or_of_another_shot_sees_the_same(folder):
    told = {"azimuth": 200, "elevation": 8, "roll": 12, "fov": 40, "position": [5, 300, 7]}
    (folder / "camera.json").write_text(json.dumps(told))
    shot("--camera", "camera.json", "--no-preview", "-o", "a.exr")
    numbers = ("--look", "200,8", "--roll", "12deg", "--fov", "40deg", "--altitude", "300m")
    shot(*numbers, "--no-preview", "-o", "b.exr")
    one, other = (read_image(folder / name)[0] for name in ("a.exr", "b.exr"))
    np.testing.assert_allclose(one, other, rtol=1e-3)
    assert one.shape == (36, 64, 3)


@pytest.mark.usefixtures("warm")
def test_a_picture_by_default_stands_beside_its_light_under_a_name_that_tells_the_view(folder):
    shot("--look", "sun", "--roll", "3deg", "--preset", "mars")
    name = "mars_sun30.00deg_perspective_az180deg_el30deg_fov50deg_roll3deg"
    assert listing(folder) == [f"{name}.exr", f"{name}.png"]
    assert OpenImageIO.ImageBuf(f"{name}.png").spec().width == 64


@pytest.mark.usefixtures("warm")
def test_the_setting_sun_stands_on_the_limb(folder):
    dip = math.degrees(math.acos(6360.0 / 6760.0))
    limb = ("--look", "limb", "--fov", "10deg", "--no-preview", "--sun-disc", "only")
    shot("--altitude", "400km", "--sun", f"{-dip:.3f}deg", *limb, "-o", "a.exr")
    pixels, _ = read_image(folder / "a.exr")
    rows, _ = np.nonzero(pixels.sum(axis=2))
    assert 15 <= rows.min() <= 18


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (
            ("--look", "up"),
            "--look': must be sun, moon, horizon, limb, planet or AZIMUTH,ELEVATION",
        ),
        (("--look", "sun,90"), "sun takes no azimuth, got 'sun,90'"),
        (("--look", "180,95"), "must be from -90deg to 90deg, got 95"),
        (("--look", "limb"), "--look: limb needs a camera above the atmosphere"),
        (("--look", "planet", "--altitude", "130km"), "--look: planet must fit into a picture"),
        (("--fov", "175deg"), "--fov: must be greater than 0deg and at most 170deg"),
        (("--camera-units", "cm"), "--camera-units: needs --camera"),
        (("--camera", "camera.xml"), "camera.xml: suffix must be .json or .exr"),
        (("--camera", "c.json", "--roll", "3"), "--roll: cannot be combined with --camera"),
        (("--no-preview", "--preview", "a.png"), "--preview: cannot be combined"),
        (("--sun-disc", "exclude", "--sun-soft"), "--sun-soft: cannot be combined"),
        (("-o", "a.png"), "a.png: suffix must be .exr or .hdr"),
        (("-o", "a.hdr", "--pixel", "half"), "--pixel: needs an .exr output"),
        (("--size", "64"), "--size: must be a width and a height, got 64"),
    ],
)
def test_wrong_use_of_a_shot_is_told_in_a_line(folder, arguments, problem):
    result = invoke(*SMALL, *arguments)
    assert result.exit_code == 2
    assert problem in " ".join(result.stderr.split())
    assert not listing(folder)


@pytest.mark.parametrize(
    ("told", "problem"),
    [
        (
            {"azimuth": 0, "elevation": 0, "fov": 50, "position": [0, -3, 0]},
            "got -3 m with that of",
        ),
        ({"azimuth": 0, "elevation": 0, "fov": 50, "aspect": 1}, "such as 64x64, got 64x36"),
        ({"worldToCamera": [0] * 16, "fov": 50}, "last column must be 0 0 0 1"),
        (None, "skybake: camera.json: cannot be read: No such file"),
    ],
)
def test_a_camera_that_cannot_be_is_refused_in_a_line(folder, told, problem):
    if told is not None:
        (folder / "camera.json").write_text(json.dumps(told))
    result = invoke(*SMALL, "--camera", "camera.json")
    assert result.exit_code == 1
    assert problem in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert not [name for name in listing(folder) if name != "camera.json"]
