"""Air in pictures of renderers, as users put it in."""

import json
import math
import subprocess
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from skybake.formats.exr_layers import channel_types, read_exr
from skybake.projection import Perspective
from tests.aerial.pictures import beauty, write_exr
from tests.cli.runs import invoke, listing, render

SHAPE = 36, 64
CAMERA = {"azimuth": 150, "elevation": 4, "fov": 50, "position": [3, 100, -7]}
SUN = ("--sun", "20deg")


@pytest.fixture
def scene(folder):
    """A folder with a picture of things 20 m to 20 km away, and its camera."""
    depth = np.geomspace(20.0, 20_000.0, SHAPE[0] * SHAPE[1]).reshape(SHAPE)
    write_exr(folder / "in.exr", beauty(depth), kinds={"Z": "float"})
    (folder / "camera.json").write_text(json.dumps(CAMERA))
    return folder


def aerial(*arguments, beauty="in.exr", camera=("--camera", "camera.json")):
    given = ("--beauty", beauty, *camera, *SUN, "-q", "-o", "out.exr")
    return invoke("aerial", *given, *arguments)


def done(*arguments, **keywords):
    result = aerial(*arguments, **keywords)
    assert result.exit_code == 0, result.stderr
    return pixels("out.exr")


def pixels(path):
    return OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.FLOAT)


@pytest.mark.usefixtures("warm")
def test_far_things_lose_contrast_and_blue_most_of_all(scene):
    light, depth = done(), pixels("in.exr")[..., 4]
    write_exr("in.exr", beauty(depth, 0.0), kinds={"Z": "float"})
    passing = (light - done())[..., :3] / 0.2
    assert passing[0, 0].min() > 0.995
    red, green, blue = passing[-1, -1]
    assert 0.05 < blue < green < red < 0.9


@pytest.mark.usefixtures("warm")
def test_every_other_channel_part_and_attribute_stays_bit_for_bit(folder):
    depth = np.full(SHAPE, 5000.0)
    generator = np.random.default_rng(1)
    others = {f"crypto.{name}": generator.normal(size=SHAPE) for name in "RGBA"}
    planes = {**beauty(depth), **others, "id": np.full(SHAPE, 0.0)}
    kinds = dict.fromkeys((*others, "Z"), "float")
    kinds["id"] = "uint"
    matrix = np.arange(16.0).reshape(4, 4)
    told = {"compression": "dwaa:45", "comment": "kept", "myMatrix": matrix}
    write_exr(folder / "in.exr", planes, kinds=kinds, **told)
    (folder / "camera.json").write_text(json.dumps(CAMERA))
    (before,) = read_exr(folder / "in.exr")
    done("--depth-channel", "Z")
    (after,) = read_exr(folder / "out.exr")
    assert channel_types(after) == channel_types(before)
    assert after.channels == before.channels
    assert after.attributes["comment"] == "kept"
    assert after.attributes["myMatrix"] == before.attributes["myMatrix"]
    assert after.attributes["compression"].startswith("zip")
    for name in before.channels:
        same = np.array_equal(after.plane(name), before.plane(name))
        assert same == (name not in {"R", "G", "B"})


@pytest.mark.usefixtures("warm")
def test_all_parts_of_a_file_are_kept_and_the_named_one_is_changed(folder):
    specs, planes = [], []
    for name in ("masks", "beauty", "normals"):
        spec = OpenImageIO.ImageSpec(64, 36, 4, "half")
        spec.channelnames = ("R", "G", "B", "Z")
        spec["oiio:subimagename"] = name
        specs.append(spec)
        planes.append(np.random.default_rng(len(specs)).uniform(1, 2, (36, 64, 4)))
    output = OpenImageIO.ImageOutput.create("in.exr")
    output.open("in.exr", tuple(specs))
    for k, (spec, plane) in enumerate(zip(specs, planes, strict=True)):
        if k:
            output.open("in.exr", spec, "AppendSubimage")
        output.write_image(plane.astype(np.float32))
    output.close()
    (folder / "camera.json").write_text(json.dumps(CAMERA))
    done("--layer", "beauty", "--depth-channel", "beauty.Z", "--depth-units", "km")
    before, after = read_exr(folder / "in.exr"), read_exr(folder / "out.exr")
    assert [part.name for part in after] == ["masks", "beauty", "normals"]
    same = [np.array_equal(a.pixels, b.pixels) for a, b in zip(before, after, strict=True)]
    assert same == [True, False, True]


@pytest.mark.usefixtures("warm")
def test_things_at_distance_0_stay_bit_for_bit_and_infinity_is_the_sky(folder):
    depth = np.zeros(SHAPE)
    depth[:, 32:] = math.inf
    light = np.random.default_rng(2).uniform(0.0, 3.0, SHAPE)
    light[:, 32:] = 0.0
    write_exr(folder / "in.exr", beauty(depth, light), kinds={"Z": "float"})
    (folder / "camera.json").write_text(json.dumps(CAMERA))
    out, before = done(), pixels("in.exr")
    assert np.array_equal(out[:, :32], before[:, :32])
    view = ("--projection", "perspective", "--size", "64x36", "--look", "150,4", "--fov", "50")
    sky = ("--altitude", "100m", "--sun-disc", "exclude", *SUN, *view)
    render(folder / "sky.exr", *sky)
    np.testing.assert_allclose(out[:, 32:, :3], pixels("sky.exr")[:, 32:], rtol=2e-3)


@pytest.mark.usefixtures("warm")
def test_the_sky_is_put_behind_what_is_not_covered(folder):
    alpha = np.ones(SHAPE)
    alpha[:, 40:] = 0.0
    alpha[:, 30:40] = 0.5
    write_exr(folder / "in.exr", beauty(np.full(SHAPE, 30.0), 0.2 * alpha, alpha))
    (folder / "camera.json").write_text(json.dumps(CAMERA))
    empty = done()
    assert (empty[:, 40:, :3] == 0.0).all()
    filled = done("--sky", "fill")
    assert (filled[..., 3] == 1.0).all()
    write_exr(folder / "in.exr", beauty(np.full(SHAPE, 30.0), 0.0, 0.0))
    sky = done("--sky", "fill")[..., :3]
    np.testing.assert_allclose(
        filled[:, 30:40, :3], 0.5 * sky[:, 30:40] + empty[:, 30:40, :3], rtol=2e-3
    )
    np.testing.assert_array_equal(filled[:, :30, :3], empty[:, :30, :3])


@pytest.mark.usefixtures("warm")
def test_cameras_of_attributes_and_of_json_give_the_same(scene):
    by_file = done()
    picture = Perspective(64, 36, math.radians(50), math.radians(150), math.radians(4))
    frame = picture.canvases()[0].parts[0].chart.frame
    placed = np.eye(4)
    placed[:3, :3] = np.stack([frame.right, frame.up, frame.forward], axis=1)
    placed[3, :3] = -np.array(CAMERA["position"]) @ placed[:3, :3]
    half = math.tan(math.radians(25))
    lens = np.diag([1 / half, 64 / 36 / half, 1.0, 0.0])
    lens[2, 3] = 1.0
    depth = pixels("in.exr")[..., 4]
    told = {"worldToCamera": placed, "worldToNDC": placed @ lens}
    write_exr(scene / "own.exr", beauty(depth), kinds={"Z": "float"}, **told)
    np.testing.assert_allclose(done(beauty="own.exr", camera=()), by_file, rtol=2e-3)
    assert "aerial" in pixels_text(scene / "out.exr")


def pixels_text(path):
    return subprocess.run(["exrheader", path], capture_output=True, text=True, check=True).stdout


@pytest.mark.usefixtures("warm")
def test_a_crop_gets_what_the_whole_picture_has_there(scene):
    whole = done()
    source = OpenImageIO.ImageBuf("in.exr")
    crop = OpenImageIO.ImageBufAlgo.crop(source, OpenImageIO.ROI(10, 40, 5, 25))
    assert crop.write("crop.exr")
    part = pixels_of_window("crop.exr")
    assert part == (10, 5, 64, 36)
    result = aerial(beauty="crop.exr")
    assert result.exit_code == 0, result.stderr
    np.testing.assert_allclose(pixels("out.exr"), whole[5:25, 10:40], rtol=2e-3)


def pixels_of_window(path):
    (part,) = read_exr(Path(path))
    return part.window


@pytest.mark.usefixtures("warm")
def test_froxels_are_near_what_is_marched(scene):
    marched = done()
    np.testing.assert_allclose(done("--method", "froxel"), marched, rtol=0.01)


def nothing(_):
    pass


def spoil(value, row=3, column=7):
    def write(folder):
        depth = np.full(SHAPE, 50.0)
        depth[row, column] = value
        write_exr(folder / "in.exr", beauty(depth), kinds={"Z": "float"})

    return write


def shrink(folder):
    write_exr(folder / "z.exr", {"Z": np.ones((18, 32))})


def singular(folder):
    (folder / "camera.json").write_text(json.dumps({"worldToCamera": [0] * 15 + [1], "fov": 50}))


def no_colour(folder):
    write_exr(folder / "in.exr", {"Y": np.ones(SHAPE), "Z": np.ones(SHAPE)})


def no_depth(folder):
    write_exr(folder / "in.exr", {name: np.ones(SHAPE) for name in "RGB"})


def dark(folder):
    light = np.full(SHAPE, 1.0)
    light[2, 5] = math.nan
    write_exr(folder / "in.exr", beauty(np.full(SHAPE, 9.0), light))


@pytest.mark.parametrize(
    ("spoiled", "arguments", "problem"),
    [
        (
            spoil(math.nan),
            (),
            "in.exr: Z: must be at least 0, got nan at column 7, row 3; --depth-b",
        ),
        (spoil(-2.0), (), "in.exr: Z: must be at least 0, got -2 at column 7, row 3"),
        (shrink, ("--depth", "z.exr"), "z.exr: depth must be as large as in.exr, 64x36, got 32x18"),
        (singular, (), "camera.json: worldToCamera: must not be singular"),
        (no_colour, (), "in.exr: channels must be R, G, B; channels: Y, Z"),
        (no_depth, (), "in.exr: depth must be called Z, or be named; channels: R, G, B"),
        (nothing, ("--depth-channel", "P"), "channel 'P' must be there; channels: R, G, B, A, Z"),
        (nothing, ("--layer", "spec"), "layer 'spec' must have R, G, B; channels: R, G, B, A, Z"),
        (dark, (), "in.exr: R: must be finite, got nan at column 5, row 2"),
        (nothing, ("--depth", "gone.exr"), "gone.exr: must be an image file, got nothing"),
    ],
)
def test_faulty_files_are_refused_in_a_line_and_nothing_is_written(
    scene, spoiled, arguments, problem
):
    spoiled(scene)
    result = aerial(*arguments)
    assert result.exit_code == 1
    assert problem in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert "out.exr" not in listing(scene)


def test_a_picture_without_a_camera_is_refused(scene):
    result = aerial(camera=())
    assert result.exit_code == 1
    assert "in.exr: camera must be given, got neither worldToCamera nor worldToNDC" in result.stderr
    assert "out.exr" not in listing(scene)


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("value", [math.nan, -1.0])
def test_what_depths_of_the_background_mean_can_be_said(scene, value):
    spoil(value)(scene)
    untouched = done("--depth-background", "0")
    np.testing.assert_array_equal(untouched[3, 7], pixels("in.exr")[3, 7])
    far = done("--depth-background", "inf")
    assert np.abs(far[3, 7, :3] - untouched[3, 7, :3]).max() > 0.01


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("--sun-size", "2deg"), "--sun-size: needs --sky fill"),
        (("--sky", "fill", "--sun-disc", "only"), "--sun-disc only: must be include or exclude"),
        (("--fov", "190deg"), "--fov: must be less than 180deg for a camera, got 190deg"),
        (("--units", "nits", "--ev", "3"), "--units: cannot be combined with --ev"),
        (("--depth", "z.png"), "z.png: suffix must be .exr"),
    ],
)
def test_wrong_use_is_told_in_a_line(scene, arguments, problem):
    result = aerial(*arguments)
    assert result.exit_code == 2
    assert problem in " ".join(result.stderr.split())
    assert "out.exr" not in listing(scene)


ECLIPSE = ("--time", "2026-08-12T18:00Z", "--lat", "43.3713", "--lon=-8.396")


def test_a_time_of_an_eclipse_is_refused(scene):
    result = invoke(
        "aerial", "--beauty", "in.exr", "--camera", "camera.json", *ECLIPSE, "-o", "o.exr"
    )
    assert result.exit_code == 1
    assert result.stderr.splitlines()[-1].startswith("skybake: time: sun must not be in eclipse")
    assert not (scene / "o.exr").exists()


@pytest.mark.usefixtures("warm")
def test_at_night_the_lights_that_are_not_in_the_air_are_told(scene):
    given = ("--beauty", "in.exr", "--camera", "camera.json", "--sun=-30deg", "-q", "-o", "o.exr")
    result = invoke("aerial", *given)
    assert result.exit_code == 0
    assert "warning: sun is more than 18 degrees below the horizon" in result.stderr
    assert (scene / "o.exr").exists()


@pytest.mark.usefixtures("warm")
def test_by_moonlight_the_air_is_not_dark(scene):
    """A full Moon gives 0.2 lx, and 1 stands for 0.15 cd/m2."""
    night = ("--sun=-30deg", "--ev=-3")
    result = aerial(*night, "--moon-elevation", "40deg", "--moon-phase", "full")
    assert result.exit_code == 0
    assert "warning" not in result.stderr
    lit = pixels("out.exr")
    far = np.array(lit - done(*night))[-1, :, :3]
    assert 0.01 < far.min() < far.max() < 0.5


def test_what_the_moon_needs_is_told(scene):
    for given, problem in (
        (("--moon", "include"), "include needs --time or --moon-elevation"),
        (("--moon-phase", "full"), "needs --moon-elevation"),
        (("--moon-elevation", "95deg"), "--moon-elevation"),
    ):
        result = aerial(*given)
        assert result.exit_code == 2
        assert problem in " ".join(result.stderr.split())
    assert "out.exr" not in listing(scene)
