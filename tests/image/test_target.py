"""Every target's file encodes directions as the program looks them up, by its own formula.

The formulas are those of the programs' sources; programs that are at hand read the files
themselves in `tests.baking.test_target_readers` and by ``python -m tests.peers``.
"""

import math

import numpy as np
import pytest

from skybake.baking import default_path
from skybake.baking.orientation_chart import bake_orientation_chart
from skybake.errors import InputError
from skybake.image.settings import Encoding, MapSettings, View, map_settings
from skybake.image.target import TARGETS, find_target
from skybake.image.target_model import SUBJECTS
from skybake.image.target_sun import target_sun_direction
from skybake.preset import load_preset
from skybake.projection import Fisheye
from skybake.projection.cubemap import FACES
from tests.baking.maps import pixels
from tests.formats.cubes import VK, read_ktx2
from tests.peers.orientation import bake_directions, in_axes, worst_angle

PI = math.pi

# From directions in the program's own axes to u, from 0 at the left edge to 1.
FORMULAS = {
    "blender": lambda x, y, _z: 0.5 - np.arctan2(y, x) / (2.0 * PI),
    "unreal": lambda x, y, _z: (1.0 + np.arctan2(x, -y) / PI) / 2.0,
    "unity": lambda x, _y, z: 0.5 - np.arctan2(z, x) / (2.0 * PI),
    "godot": lambda x, _y, z: np.arctan2(x, -z) / (2.0 * PI),
    "three": lambda x, _y, z: np.arctan2(z, x) / (2.0 * PI) + 0.5,
    "mitsuba": lambda x, _y, z: np.arctan2(x, -z) / (2.0 * PI),
    **dict.fromkeys(
        ("filament", "usd", "houdini", "openexr"),
        lambda x, _y, z: (PI - np.arctan2(x, z)) / (2.0 * PI),
    ),
}
# From directions in the program's own axes to those by which it samples its cube.
CUBES = {
    "three": lambda x, y, z: (-x, y, z),
    "unity": lambda x, y, z: (x, y, z),
}


def bilinear(image, row, column):
    """Interpolate between centres of texels, columns wrapping; places in pixels from the corner."""
    height, width = image.shape[:2]
    top, left = np.floor(row - 0.5).astype(int), np.floor(column - 0.5).astype(int)
    down, right = (row - 0.5 - top)[:, None], (column - 0.5 - left)[:, None]
    rows = np.clip([top, top + 1], 0, height - 1)
    columns = np.array([left, left + 1]) % width
    upper = image[rows[0], columns[0]] * (1 - right) + image[rows[0], columns[1]] * right
    lower = image[rows[1], columns[0]] * (1 - right) + image[rows[1], columns[1]] * right
    return upper * (1 - down) + lower * down


@pytest.mark.parametrize("name", FORMULAS)
def test_an_equirect_map_has_directions_where_the_program_looks_them_up(tmp_path, name):
    (file,), brightest = bake_directions(tmp_path, name, "equirect", 128)
    image, axes = pixels(file), find_target(name).axes
    x, y, z = np.array(in_axes(name)).T
    u = FORMULAS[name](x, y, z) % 1.0
    up = {"Y": y, "Z": z}[axes.up[1]]
    if find_target(name).equirect_rows == "poles":
        row = np.arccos(up) / PI * (image.shape[0] - 1) + 0.5
    else:
        row = np.arccos(up) / PI * image.shape[0]
    seen = bilinear(image, row, u * image.shape[1])
    assert worst_angle(seen, brightest) < 0.6


def sample_cube(faces, x, y, z):
    """What a graphics library finds in six faces, after table 4 of OpenGL ES 2.0, 3.7.5."""
    size = np.abs([x, y, z])
    face = 2 * size.argmax(axis=0) + (
        np.take_along_axis(np.array([x, y, z]), size.argmax(axis=0)[None], 0)[0] < 0
    )
    s = np.choose(face, [-z, z, x, x, x, -x]) / size.max(axis=0)
    t = np.choose(face, [-y, -y, z, -z, -y, -y]) / size.max(axis=0)
    edge = faces[0].shape[0]
    places = (0.5 * (t + 1.0) * edge, 0.5 * (s + 1.0) * edge)
    found = [bilinear(image, *places) for image in faces]
    return np.take_along_axis(np.array(found), face[None, :, None], 0)[0]


@pytest.mark.parametrize("name", CUBES)
def test_a_cubemap_has_directions_where_the_program_samples_it(tmp_path, name):
    settings = {"layout": "faces"} if name == "unity" else {}
    files, brightest = bake_directions(tmp_path, name, "cubemap", 64, **settings)
    x, y, z = (np.array(one) for one in CUBES[name](*np.array(in_axes(name)).T))
    seen = sample_cube([pixels(file) for file in files], x, y, z)
    # RGBE rounds to 1/256 of the largest channel.
    assert worst_angle(seen, brightest) < 0.7


def test_a_ktx2_has_directions_where_bevy_samples_it(tmp_path):
    """It negates z; nothing else is turned."""
    (file,), brightest = bake_directions(tmp_path, "bevy", "cubemap", 64)
    assert file.suffix == ".ktx2"
    header, levels, _, _ = read_ktx2(file)
    assert header["vk"] == VK["float"]
    texels = np.frombuffer(levels[0], np.float32).reshape(6, 64, 64, 4)
    x, y, z = np.array(in_axes("bevy")).T
    assert worst_angle(sample_cube(texels[..., :3], x, y, -z), brightest) < 0.1


@pytest.mark.parametrize("target", TARGETS.values(), ids=lambda target: target.name)
def test_every_value_of_a_target_has_a_reason_and_a_source(target):
    assert tuple(target.reasons) == SUBJECTS
    assert all(reason.text.endswith(".") and reason.source for reason in target.reasons.values())
    assert target.verified
    assert set(target.maps) <= {"equirect", "cubemap"}
    assert sorted(axis[1] for axis in target.axes) == ["X", "Y", "Z"]


@pytest.mark.parametrize(
    ("name", "direction"),
    [
        ("blender", (0.5, 0.866025, 0.0)),
        ("unreal", (0.5, -0.866025, 0.0)),
        ("unity", (0.5, 0.0, 0.866025)),
        ("three", (0.5, 0.0, -0.866025)),
    ],
)
def test_a_sun_in_the_north_north_east_is_there_in_every_program(name, direction):
    settings = map_settings(target=name, sun_elevation=0.0, sun_azimuth=math.radians(30.0))
    assert target_sun_direction(settings, name) == pytest.approx(direction, abs=1e-6)


def test_a_rotation_turns_what_the_program_takes_for_north():
    turned = map_settings(
        target="three",
        rotation=math.radians(30.0),
        sun_elevation=0.0,
        sun_azimuth=math.radians(30.0),
    )
    assert math.degrees(turned.view.rotation) == pytest.approx(300.0)
    assert target_sun_direction(turned, "three") == pytest.approx((0.0, 0.0, -1.0))


def test_what_is_given_comes_before_what_a_target_has():
    settings = map_settings(target="unreal", units="ev15", sun_disc="include", pixel="float")
    assert settings.encoding.units == "ev15"
    assert settings.lighting.sun_disc == "include"
    assert settings.encoding.pixel == "float"
    assert settings.encoding.omit_exposure
    scale = map_settings(target="unreal", ev=12.0).encoding
    assert scale.white_luminance == pytest.approx(1.2 * 2**12)


@pytest.mark.parametrize(
    ("target", "given", "message"),
    [
        ("blender", {"projection": "cubemap"}, "projection: must be equirect for the target"),
        ("mitsuba", {"rows": "centres"}, "equirect-rows: must be poles for the target mitsuba"),
        ("three", {"projection": "cubemap", "space": "world"}, "cube-space: must be flip-x for"),
        ("maya", {}, "target: must be one of blender, usd, mitsuba"),
    ],
)
def test_what_a_program_does_not_take_is_refused(target, given, message):
    with pytest.raises(InputError, match=message):
        map_settings(target=target, **given)


def test_names_of_faces_are_in_one_order():
    settings = map_settings("cubemap", 4, target="three", face_names="posx")
    faces = [canvas.face for canvas in settings.view.projection.canvases()]
    assert [name[0] + name[-1] for name in faces] == list(FACES)


def test_a_map_that_was_put_together_by_hand_is_checked_with_its_files(tmp_path):
    settings = MapSettings(View(projection=Fisheye(16)), encoding=Encoding(target="unreal"))
    for write in (
        lambda: default_path(load_preset("earth"), settings),
        lambda: bake_orientation_chart(tmp_path / "a.hdr", settings),
    ):
        with pytest.raises(InputError, match="projection: must be equirect for the target unreal"):
            write()
    assert not list(tmp_path.iterdir())
