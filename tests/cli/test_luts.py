"""Tables that engines look up, from the command line."""

import hashlib
import json
import math

import numpy as np
import OpenImageIO
import pytest

from skybake.commands.luts import luts
from skybake.commands.options import choices
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.luts import parametrisations, settings
from skybake.luts.aerial_perspective import air_segments
from skybake.luts.files import file_names
from skybake.preset import load_preset
from skybake.projection.camera import camera_from_angles
from skybake.projection.camera_file import load_camera
from tests.aerial.pictures import write_exr
from tests.cli.runs import AS_A_USER, invoke, listing, run
from tests.luts.sets import read_texture

WORLD = ("--preset", "earth-hillaire2020")
SMALL = (
    *("--transmittance-size", "16x8", "--multiple-scattering-size", "8x8"),
    *("--sky-view-size", "16x12", "--aerial-size", "4x3x5"),
)
FILES = sorted({name for names in file_names().values() for name in names} | {"luts.json"})


def test_a_new_folder_holds_tables_code_and_what_they_are(tmp_path):
    made = invoke("luts", *WORLD, *SMALL, "--sun", "5deg", "--json", "-o", tmp_path / "sky")
    assert made.exit_code == 0, made.output
    summary = json.loads(made.stdout)
    assert listing(tmp_path / "sky") == FILES
    assert sorted(path.rpartition("/")[2] for path in summary["files"]) == FILES
    about = json.loads((tmp_path / "sky" / "luts.json").read_text())
    assert about["recipe_hash"] == summary["recipe_hash"]
    assert about["recipe"]["tables"]["sun_elevation_deg"] == 5.0
    assert summary["sizes"]["aerial_perspective"] == [4, 3, 5]
    for table in about["tables"].values():
        least, most = table["range"]
        assert math.isfinite(least)
        assert most > 0.0


def test_both_formats_hold_the_same_values_and_tell_what_they_are(tmp_path):
    sizes = ("--look", "190,3", "--fov", "40deg", "--aspect", "2:1")
    assert invoke("luts", *WORLD, *SMALL, *sizes, "-q", "-o", tmp_path).exit_code == 0
    about = json.loads((tmp_path / "luts.json").read_text())
    for name, table in about["tables"].items():
        picture = OpenImageIO.ImageBuf(str(tmp_path / f"{name}.exr"))
        width, height, *depth = table["size"]
        assert (picture.spec().width, picture.spec().height) == (
            width,
            height * (depth[0] if depth else 1),
        )
        texels = read_texture(tmp_path / f"{name}.ktx2")
        channels = len(table["channels"])
        tall = texels[..., :channels].reshape(-1, width, channels)
        np.testing.assert_array_equal(picture.get_pixels(OpenImageIO.FLOAT), tall)
        assert picture.spec().getattribute("skybake:recipeHash") == about["recipe_hash"]
        assert picture.spec().getattribute("skybake:table") == name
    white = OpenImageIO.ImageBuf(str(tmp_path / "sky_view.exr")).spec()
    assert white.getattribute("whiteLuminance") == pytest.approx(39321.6)


def test_the_same_command_writes_the_same_bytes(tmp_path):
    digests = []
    for name in ("a", "b"):
        assert invoke("luts", *WORLD, *SMALL, "-q", "-o", tmp_path / name).exit_code == 0
        files = sorted((tmp_path / name).iterdir())
        digests.append([hashlib.sha256(path.read_bytes()).hexdigest() for path in files])
    assert digests[0] == digests[1]


ANGLES = {"azimuth": 215, "elevation": 4, "roll": 10, "fov": 50, "aspect": 1.5}


def test_a_camera_of_a_file_is_that_of_the_volume(tmp_path):
    """Roll and lens shift too, and its height is added."""
    told = {**ANGLES, "position": [3.0, 120.0, 0.0], "lens_shift": [0.1, -0.05]}
    (tmp_path / "camera.json").write_text(json.dumps(told))
    given = ("--camera", tmp_path / "camera.json", "--altitude", "1km")
    made = invoke("luts", *WORLD, *SMALL, *given, "-q", "-o", tmp_path / "sky")
    assert made.exit_code == 0, made.output
    about = json.loads((tmp_path / "sky" / "luts.json").read_text())
    known = {name: np.array(one["value"]) for name, one in about["constants"].items()}
    camera = load_camera(tmp_path / "camera.json")
    assert known["OBSERVER_ALTITUDE"] == pytest.approx(1.12)
    axes = [known[f"CAMERA_{name}"] for name in ("RIGHT", "UP", "FORWARD")]
    np.testing.assert_allclose(axes, camera.frame, atol=1e-12)
    np.testing.assert_allclose(known["CAMERA_SHIFT"], camera.shift, rtol=1e-12)
    halves = known["CAMERA_HALF_WIDTH"], known["CAMERA_HALF_HEIGHT"]
    assert halves == pytest.approx((camera.half_width, camera.half_height))
    # The first texel of the volume is where these constants say, up and to the left.
    right, up = camera.shift[0] - 0.75 * halves[0], camera.shift[1] + 2.0 / 3.0 * halves[1]
    ray = camera.frame[2] + right * camera.frame[0] + up * camera.frame[1]
    view = map_settings(sun_elevation=math.radians(30.0), altitude=1.12)
    scene = Scene(load_preset(WORLD[1]), view)
    texels = read_texture(tmp_path / "sky" / "aerial_perspective.ktx2")
    distance = np.array([128.0 * (0.5 / 5.0) ** 2])
    light = air_segments(scene, (ray / np.linalg.norm(ray))[None], distance).radiance
    expected = light[0, 0] @ scene.rgb_weights
    np.testing.assert_allclose(texels[0, 0, 0, :3], expected, rtol=1e-3)


@pytest.mark.parametrize(
    ("told", "line"),
    [
        ({**ANGLES, "fov": 175}, "camera.json: fov: must be greater than 0deg and at most 170deg"),
        ({**ANGLES, "aspect": 30}, "camera.json: aspect: must be from 0.05 to 20, got 30"),
        ({**ANGLES, "position": [0, -5, 0]}, "altitude: must be at least 0 m, got -5 m with that"),
    ],
)
def test_a_camera_that_is_out_of_range_is_one_line_and_leaves_nothing(tmp_path, told, line):
    (tmp_path / "camera.json").write_text(json.dumps(told))
    given = ("--camera", tmp_path / "camera.json")
    made = invoke("luts", *WORLD, *SMALL, *given, "-o", tmp_path / "sky")
    assert (made.exit_code, len(made.stderr.splitlines())) == (1, 1)
    assert line in made.stderr
    assert listing(tmp_path) == ["camera.json"]


def test_attributes_of_a_picture_tell_the_camera_and_its_proportions(tmp_path):
    turned = camera_from_angles(math.radians(200.0), 0.1, 0.0, math.radians(50.0), 1.6)
    frame = turned.frame
    world = np.eye(4)
    # Row vectors, and OpenEXR's cameras look along +Z.
    world[:3, :3] = frame.T
    plane = {"R": np.zeros((40, 64))}
    write_exr(tmp_path / "in.exr", plane, worldToCamera=world)
    given = ("--camera", tmp_path / "in.exr", "--fov", "50deg")
    made = invoke("luts", *WORLD, *SMALL, *given, "-q", "-o", tmp_path / "sky")
    assert made.exit_code == 0, made.output
    recipe = json.loads((tmp_path / "sky" / "luts.json").read_text())["recipe"]["tables"]
    assert recipe["look_azimuth_deg"] % 360.0 == pytest.approx(200.0, abs=1e-4)
    assert recipe["aspect"] == pytest.approx(1.6)
    assert recipe["fov_deg"] == pytest.approx(50.0)


def test_the_error_near_the_sun_is_stated_and_told_of_where_it_is_large(tmp_path):
    made = invoke("luts", "--preset", "earth", *SMALL, "--sun", "40deg", "-o", tmp_path)
    assert made.exit_code == 0, made.output
    about = json.loads((tmp_path / "luts.json").read_text())["tables"]["sky_view"]
    assert about["error_near_sun"]["within_deg"] == 2.0
    assert about["error_near_sun"]["largest_relative"] > 0.3
    assert "of the sun; --sky-view-size 32x24" in made.stdout


def test_a_time_and_a_place_give_the_sun(tmp_path):
    moment = ("--time", "2026-06-21T10:00Z", "--lat", "48.85", "--lon", "2.35")
    made = invoke("luts", "--preset", "earth", *SMALL, *moment, "-q", "-o", tmp_path)
    assert made.exit_code == 0, made.output
    about = json.loads((tmp_path / "luts.json").read_text())
    assert 55.0 < about["sun"]["elevation_deg"] < 65.0


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (("--altitude", "100km"), 1, "altitude: must be below the top of the atmosphere at 100 km"),
        (("--clouds", "cumulus"), 1, "clouds: must be none, since tables hold clear air, got "),
        (("--units", "nits", "--pixel", "half", "--ev", "3"), 2, "--units: cannot be combined"),
        (("--sky-view-size", "16x11"), 2, "--sky-view-size: height must be even"),
        (("--sky-view-size", "16x12x3"), 2, "--sky-view-size: must be width and height, got"),
        (("--aerial-size", "4x4"), 2, "--aerial-size: must be width, height and depth, got 4x4"),
        (("--aerial-size", "4x4x1025"), 2, "--aerial-size: must be from 2 to 4096x4096x1024"),
        (("--aerial-size", "4096x4096x2"), 2, "--aerial-size: must be at most 16777216 texels"),
        (("--transmittance-size", "1x8"), 2, "--transmittance-size: must be from 2 to 4096x4096"),
        (("--fov", "171deg"), 2, "--fov: must be greater than 0deg and at most 170deg, got"),
        (("--aspect", "16:9:4"), 2, "'--aspect': must be such as 16:9 or 1.778, got '16:9:4'"),
        (("--aspect", "1000"), 2, "--aspect: must be from 0.05 to 20, got 1000"),
        (("--far", "0m"), 2, "--far: must be from 0.001 to 100000 km, got 0 km"),
        (
            ("--time", "2026-08-12T18:00Z", "--lat", "43.3713", "--lon=-8.396"),
            1,
            "time: sun must not be in eclipse, in whose shadow air has another light, got ",
        ),
        (("--camera-up", "z"), 2, "--camera-up: needs --camera"),
        (("--camera", "none.json"), 1, "none.json"),
        (("--camera", "a.json", "--look", "1,2"), 2, "--look: cannot be combined with --camera"),
        (("--method", "march"), 2, "'march' is not one of 'full', 'scalar', 'hillaire'"),
    ],
)
def test_what_cannot_be_made_is_one_line_and_leaves_nothing(tmp_path, arguments, status, line):
    made = invoke("luts", *WORLD, *SMALL, *arguments, "-o", tmp_path / "sky")
    assert made.exit_code == status
    assert line in made.stderr
    assert len(made.stderr.splitlines()) == 1
    assert listing(tmp_path) == []


def test_a_value_that_halves_cannot_hold_leaves_neither_files_nor_folder(tmp_path):
    bright = ("--ev", "-5", "--pixel", "half", "--sun", "20deg")
    made = invoke("luts", "--preset", "earth", *SMALL, *bright, "-q", "-o", tmp_path / "sky")
    assert made.exit_code == 1
    assert "sky_view.ktx2: values in half must be at most 65504" in made.stderr
    assert listing(tmp_path) == []


def test_a_target_that_is_no_folder_or_cannot_be_written_is_refused(tmp_path):
    (tmp_path / "file").write_text("mine")
    made = invoke("luts", *WORLD, *SMALL, "-o", tmp_path / "file")
    assert (made.exit_code, made.stderr) == (
        1,
        f"skybake: {tmp_path / 'file'}: must be a folder, got a file\n",
    )
    made = invoke("luts", *WORLD, *SMALL, "-o", tmp_path / "no" / "sky")
    assert made.exit_code == 1
    assert "folder must exist" in made.stderr
    assert (tmp_path / "file").read_text() == "mine"
    closed = tmp_path / "closed"
    closed.mkdir(0o555)
    status, _, errors = run("luts", *WORLD, *SMALL, "-o", closed, wrapper=AS_A_USER)
    assert status == 1
    assert "must be writable" in errors
    assert listing(closed) == []


def test_files_of_a_folder_stay_where_a_new_set_fails(tmp_path):
    assert invoke("luts", *WORLD, *SMALL, "-q", "-o", tmp_path).exit_code == 0
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    bright = ("--ev", "-5", "--pixel", "half", "--sun", "20deg")
    assert invoke("luts", *WORLD, *SMALL, *bright, "-q", "-o", tmp_path).exit_code == 1
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_choices_and_defaults_are_those_of_the_engine():
    assert choices.PARAMETRISATIONS == parametrisations.PARAMETRISATIONS
    assert choices.TABLE_PIXELS == settings.PIXELS
    assert {*choices.TABLE_METHODS, "march"} == set(choices.METHODS)
    made = settings.TableSettings()
    shown = {one.name: one.show_default for one in luts.params if isinstance(one.show_default, str)}
    sizes = {f"{name}_size": size for name, size in made.sizes.items()}
    sizes["aerial_size"] = sizes.pop("aerial_perspective_size")
    for name, size in sizes.items():
        assert shown[name] == "x".join(map(str, size))
    assert shown["fov"] == f"{math.degrees(made.fov):.0f}deg"
    assert shown["far"] == f"{made.far:g}km"
    assert shown["aspect"] == "16:9"
    assert made.aspect == pytest.approx(16 / 9)
    assert shown["look"] == f"{math.degrees(made.azimuth):g},{made.elevation:g}"
    defaults = {one.name: one.default for one in luts.params}
    assert defaults["parametrisation"] == made.parametrisation
    assert defaults["pixel"] == made.pixel
