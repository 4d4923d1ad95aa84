"""Maps that are written anew, read by this and by other programs."""

import json
import math
import subprocess

import numpy as np
import OpenImageIO
import pytest

from skybake.colour.space import find_colour_space, rgb_from_xyz
from skybake.environment.load import load_environment
from skybake.formats.reader import read_attributes, read_image
from tests.cli.runs import invoke, listing, run
from tests.environment.maps import brightest, energy
from tests.formats.maps import program, sky, write_map

AZIMUTH, ELEVATION = 2.0, 0.7
SUN = np.array(
    [
        math.cos(ELEVATION) * math.sin(AZIMUTH),
        math.sin(ELEVATION),
        -math.cos(ELEVATION) * math.cos(AZIMUTH),
    ]
)


@pytest.fixture(scope="module")
def map_of_earth(tmp_path_factory):
    path = tmp_path_factory.mktemp("convert") / "sky.exr"
    status, _, errors = run(
        *("render", "--size", "256", "--sun", f"{ELEVATION}rad", "--pixel", "float"),
        *("--sun-azimuth", f"{AZIMUTH}rad", "-o", path, "-q"),
    )
    assert (status, errors) == (0, "")
    return path


def convert(source, target, *options):
    result = invoke("convert", source, target, *options, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


WAYS = {
    "faces": ("a.exr", "--projection", "cubemap", "--size", "128"),
    "cross": ("a.exr", "--projection", "cubemap", "--cube-layout", "cross"),
    "upright": ("a.hdr", "--projection", "cubemap", "--cube-layout", "vertical-cross"),
    "row": ("a.hdr", "--projection", "cubemap", "--cube-layout", "row", "--size", "64"),
    "column": ("a.exr", "--projection", "cubemap", "--cube-layout", "column"),
    "OpenEXR's cube": ("a.exr", "--projection", "cubemap", "--cube-layout", "exr"),
    "mirrored cube": ("a.exr", "--projection", "cubemap", "--cube-space", "flip-z"),
    "octahedral": ("a.exr", "--projection", "octahedral"),
    "angular": ("a.exr", "--projection", "angular"),
    "turned": ("a.exr", "--rotate", "77deg", "--size", "700"),
    "small": ("a.exr", "--size", "64x32", "--equirect-rows", "poles"),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_layout_keeps_light_and_directions_there_and_back(map_of_earth, folder, way):
    name, *options = WAYS[way]
    there = convert(map_of_earth, name, *options)
    back = convert(there["files"][-1], "back.exr", "--projection", "equirect", "--rotate", "0")
    before = load_environment(map_of_earth)
    for path in (there["files"][0], back["files"][0]):
        environment = load_environment(path)
        tolerance = 1e-2 if ".hdr" in name else 1e-3
        np.testing.assert_allclose(energy(environment), energy(before), rtol=tolerance)
    assert brightest(load_environment("back.exr")) @ SUN > math.cos(0.1)


def test_metadata_stay_and_turn_with_the_map(map_of_earth, folder):
    convert(map_of_earth, "a.exr", "--rotate", "90deg", "--projection", "octahedral")
    convert("a.exr", "b.hdr", "--projection", "equirect", "--units", "nits")
    before, turned, again = map(read_attributes, (map_of_earth, folder / "a.exr", folder / "b.hdr"))
    x, y, z = before["skybake:sunDirection"]
    np.testing.assert_allclose(turned["skybake:sunDirection"], (z, y, -x), atol=1e-6)
    np.testing.assert_allclose(
        [float(one) for one in again["skybake:sunDirection"].split()], (z, y, -x), atol=1e-6
    )
    assert turned["skybake:skyIlluminance"] == before["skybake:skyIlluminance"]
    assert "skybake:recipeHash" in before
    assert "skybake:recipeHash" not in turned
    recipe, own = (json.loads(one["skybake:recipe"]) for one in (turned, before))
    assert recipe["preset"] == own["preset"]
    assert recipe["map"]["projection"] == "octahedral"
    assert recipe["map"]["rotate_deg"] == pytest.approx(90.0)
    assert recipe["map"]["sun_elevation_deg"] == own["map"]["sun_elevation_deg"]
    assert recipe["converted_from"]["projection"] == "equirect"
    assert again["whiteLuminance"] == pytest.approx(1.0)


def test_space_and_scale_change_the_numbers_and_not_the_light(map_of_earth, folder):
    convert(map_of_earth, "a.exr", "--colorspace", "acescg", "--ev", "10", "--pixel", "float")
    pixels, attributes = read_image(folder / "a.exr")
    old, tags = read_image(map_of_earth)
    to_acescg, to_rec709 = (
        rgb_from_xyz(find_colour_space(name)) for name in ("acescg", "lin_rec709")
    )
    expected = old @ (to_acescg @ np.linalg.inv(to_rec709)).T * 2.0**5
    np.testing.assert_allclose(pixels, expected, rtol=1e-5, atol=1e-5)
    assert attributes["colorInteropID"] == "lin_ap1_scene"
    assert attributes["whiteLuminance"] == pytest.approx(tags["whiteLuminance"] / 2.0**5)


def test_a_picture_to_look_at_is_written_by_another_command(map_of_earth, folder):
    refused = invoke("convert", map_of_earth, "a.png")
    assert refused.exit_code == 2
    assert refused.stderr.endswith("a picture to look at is written by skybake preview\n")
    assert not (folder / "a.png").exists()


def test_what_is_not_to_change_does_not(map_of_earth, folder):
    convert(map_of_earth, "a.exr", "--pixel", "float")
    np.testing.assert_array_equal(read_image(folder / "a.exr")[0], read_image(map_of_earth)[0])


def test_a_map_of_unknown_scale_stays_so_unless_it_is_told(folder):
    write_map("a.exr", sky(32, 16), white_luminance=None)
    convert("a.exr", "b.exr", "--rotate", "10")
    assert "whiteLuminance" not in read_attributes(folder / "b.exr")
    refused = invoke("convert", "a.exr", "c.exr", "--units", "nits")
    assert refused.exit_code == 2
    assert "--units: IN does not say what 1.0 stands for" in refused.stderr
    convert("a.exr", "c.exr", "--units", "nits", "--input-ev", "0", "--pixel", "float")
    np.testing.assert_allclose(read_image(folder / "c.exr")[0], 1.2 * sky(32, 16), rtol=1e-3)
    assert listing(folder) == ["a.exr", "b.exr", "c.exr"]


def test_a_cube_for_engines_holds_the_light_with_its_smaller_copies(map_of_earth, folder):
    made = convert(
        *(map_of_earth, "a.ktx2", "--projection", "cubemap", "--size", "64", "--mips"),
        *("--pixel", "float"),
    )
    assert made["files"] == ["a.ktx2"]
    content = (folder / "a.ktx2").read_bytes()
    assert content[:7] == b"\xabKTX 20"
    edge, levels = (int.from_bytes(content[at : at + 4], "little") for at in (20, 40))
    assert (edge, levels) == (64, 7)


def direction_map(folder):
    """A map whose pixels hold the direction that they look in, from 0 to 1."""
    width, height = 512, 256
    theta = math.pi * (np.arange(height) + 0.5)[:, None] / height
    phi = 2.0 * math.pi * (np.arange(width) + 0.5) / width
    x, y, z = np.sin(theta) * np.sin(phi), np.cos(theta) + 0 * phi, -np.sin(theta) * np.cos(phi)
    write_map(folder / "d.exr", np.stack([x, y, z], -1).astype(np.float32) * 0.5 + 0.5)
    return folder / "d.exr"


def test_cmgen_makes_the_same_faces_of_our_map(folder):
    cmgen = program("cmgen")
    direction_map(folder)
    convert("d.exr", "ours_{face}.exr", "--projection", "cubemap", "--size", "64")
    convert("d.exr", "d.hdr")
    subprocess.run(
        [cmgen, "-q", "-s", "64", "-f", "exr", "--extract=theirs", "--extract-blur=0", "d.hdr"],
        check=True,
        capture_output=True,
    )
    for face in ("px", "nx", "py", "ny", "pz", "nz"):
        (theirs,) = folder.glob(f"theirs/**/*{face}.exr")
        found, _ = read_image(theirs)
        np.testing.assert_allclose(
            read_image(folder / f"ours_{face}.exr")[0], found, atol=0.02, err_msg=face
        )


def test_exrenvmap_makes_the_same_cube_of_our_map(folder):
    exrenvmap = program("exrenvmap")
    direction_map(folder)
    convert("d.exr", "ours.exr", "--projection", "cubemap", "--size", "64", "--cube-layout", "exr")
    convert("d.exr", "lat.exr", "--equirect-rows", "poles", "--pixel", "half")
    subprocess.run(
        [exrenvmap, "-c", "-w", "64", "lat.exr", "theirs.exr"], check=True, capture_output=True
    )
    theirs = OpenImageIO.ImageBuf("theirs.exr").get_pixels(OpenImageIO.FLOAT)[..., :3]
    # OpenEXR has the outermost texels on the edges, half a texel from ours.
    np.testing.assert_allclose(read_image(folder / "ours.exr")[0], theirs, atol=0.03)


BAD = [
    (("sky.exr", "a.png"), 2, "must be"),
    (("sky.exr", "a.exr", "--size", "30x20"), 2, "--size: width must be twice the height"),
    (("sky.exr", "a.exr", "--look", "1,2"), 2, "--look: needs --projection fisheye or perspective"),
    (("sky.exr", "a.dds"), 1, "a.dds: must be of a cubemap in faces"),
    (("sky.exr", "a.hdr", "--pixel", "half"), 2, "--pixel: needs an .exr, .ktx2 or .dds output"),
    (("sky.exr", "a.exr", "--pixel", "rgb9e5"), 1, "a.exr: pixel rgb9e5 must be in .ktx2"),
    (("sky.exr", "no/a.exr"), 1, "no/a.exr: folder must exist"),
    (("no.exr", "a.exr"), 1, "no.exr: must be an image file, got nothing"),
    (("odd.exr", "a.exr"), 1, "odd.exr: shape must be 2:1"),
    (("sky.exr", "a.exr", "--input-projection", "angular"), 1, "sky.exr: shape must be that of"),
    (("sky.exr", "a.exr", "--input-fov", "90"), 2, "--input-fov: needs --input-projection fish"),
    (("sky.exr", "a.exr", "--compression", "best"), 1, "compression"),
    (
        ("sky.exr", "a.exr", "--projection", "perspective", "--rotate", "1"),
        2,
        "--rotate: cannot be combined with --projection perspective",
    ),
]


@pytest.mark.parametrize(("arguments", "status", "problem"), BAD)
def test_what_cannot_be_converted_is_one_line_and_no_file(folder, arguments, status, problem):
    write_map("sky.exr", sky(32, 16))
    write_map("odd.exr", sky(31, 16))
    result = invoke("convert", *arguments)
    assert result.exit_code == status, result.output
    assert problem in result.stderr
    assert result.stderr.count("\n") == 1
    assert listing(folder) == ["odd.exr", "sky.exr"]


def test_a_part_of_the_sky_leaves_the_rest_black_and_says_so(map_of_earth, folder):
    convert(map_of_earth, "dome.exr", "--projection", "fisheye", "--size", "128")
    made = convert("dome.exr", "sky.exr", "--projection", "equirect")
    (warning,) = made["warnings"]
    assert warning == "50% of all directions are black, which the fisheye map does not show"


def test_the_summary_says_what_was_made(map_of_earth, folder):
    result = invoke("convert", map_of_earth, "a.exr", "--size", "64")
    assert result.stdout == "a.exr\nequirect 64x32, lin_rec709, 1.0 = 39321.6 cd/m2; half\n"
    assert invoke("convert", map_of_earth, "a.exr", "-q").output == ""


def test_python_converts_as_the_command_does(map_of_earth, folder):
    import skybake

    made = skybake.convert(map_of_earth, "a.exr", skybake.Cubemap(32, "cross"))
    convert(
        map_of_earth, "b.exr", "--projection", "cubemap", "--size", "32", "--cube-layout", "cross"
    )
    assert made.files[0].read_bytes() == (folder / "b.exr").read_bytes()
