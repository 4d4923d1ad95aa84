"""What `skybake check` finds in maps, and what it does not."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from skybake.projection.cubemap import FACES
from tests.cli.runs import SMALL, invoke
from tests.formats.maps import sky, write_map

CUBE = tuple(f"cube_{face}.exr" for face in FACES)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """An equirect map, one of a Radiance picture, one of parts, and a cube."""
    folder, before = tmp_path_factory.mktemp("maps"), Path.cwd()
    os.chdir(folder)
    for name, arguments in {
        "map.exr": SMALL,
        "map.hdr": SMALL,
        "parts.exr": (*SMALL, "--layers", "--sun-disc", "separate"),
        "cross.exr": ("--projection", "cubemap", "--cube-layout", "cross", "--size", "16"),
        "cube.exr": ("--projection", "cubemap", "--size", "16"),
    }.items():
        result = invoke(
            *("render", "--method", "hillaire", "--sun", "20deg", "--sun-azimuth", "120deg"),
            *(*arguments, "-o", name, "--quiet"),
        )
        assert result.exit_code == 0, result.output
    os.chdir(before)
    return folder


def check(*paths):
    """Findings by their checks, of all files and cubes, and the exit status."""
    result = invoke("check", *paths, "--json")
    assert result.stderr == ""
    told = json.loads(result.stdout)
    found = {
        one["check"]: (one["is_wrong"], one["text"])
        for each in told["checked"]
        for one in each["findings"]
    }
    wrong = any(is_wrong for is_wrong, _ in found.values())
    assert told["is_wrong"] == wrong
    assert result.exit_code == int(wrong)
    return found


def changed(source, target, change, **attributes):
    """Copy a map with other pixels and attributes, which keeps all that it states."""
    given = OpenImageIO.ImageInput.open(str(source))
    spec, pixels = given.spec(), given.read_image(0, 0, 0, 3, "float")
    given.close()
    pixels = np.array(change(np.array(pixels)), np.float32)
    spec.width = spec.full_width = pixels.shape[1]
    spec.height = spec.full_height = pixels.shape[0]
    for key, (kind, value) in attributes.items():
        spec.attribute(key, kind, value)
    out = OpenImageIO.ImageOutput.create(str(target))
    assert out.open(str(target), spec), out.geterror()
    assert out.write_image(pixels), out.geterror()
    out.close()
    return target


def same(pixels):
    return pixels


def put(value, row=5, column=7):
    def change(pixels):
        pixels[row, column, 1] = value
        return pixels

    return change


@pytest.mark.parametrize("name", ["map.exr", "map.hdr", "parts.exr", "cross.exr"])
def test_maps_of_this_program_are_fine(folder, name):
    assert check(folder / name) == {}
    assert invoke("check", folder / name).stdout == f"{folder / name}: fine\n"


def test_the_faces_of_a_cube_are_fine_together(folder):
    assert check(*(folder / name for name in CUBE)) == {}


@pytest.mark.parametrize(
    ("value", "name", "text"),
    [
        (np.nan, "nan", "1 value NaN, the first in row 5, column 7"),
        (np.inf, "infinity", "1 value infinite, the first in row 5, column 7"),
        (-0.5, "luminance", "1 pixels of negative luminance, the first in row 5, column 7"),
    ],
)
def test_a_value_that_breaks_renderers_is_found_with_its_place(folder, tmp_path, value, name, text):
    path = changed(folder / "map.exr", tmp_path / "a.exr", put(value))

    assert check(path)[name] == (True, text)


def test_negative_colours_of_positive_luminance_are_only_noted(folder, tmp_path):
    def change(pixels):
        pixels[3, 3] = (-0.001, 0.2, 0.3)
        return pixels

    found = check(changed(folder / "map.exr", tmp_path / "a.exr", change))
    assert found == {
        "negative": (False, "1 value negative, the least -0.001: colours out of gamut")
    }


def test_a_sun_that_was_cut_off_at_the_largest_half_is_found(folder, tmp_path):
    def change(pixels):
        pixels[4:6, 4:6] = 65504.0
        return pixels

    found = check(changed(folder / "map.exr", tmp_path / "a.exr", change))
    assert found["half"] == (True, "12 values at 65504, as of a sun that was cut off")


def test_values_beyond_half_are_noted(tmp_path):
    rows = sky()
    rows[3, 3] = 1e6
    write_map(tmp_path / "a.exr", rows, pixel="float", envmap="latlong")

    assert check(tmp_path / "a.exr")["half"][0] is False


def test_a_bright_value_in_dwa_is_found(tmp_path):
    source = tmp_path / "a.exr"
    rows = sky()
    rows[:8, :8] = 61000.0
    write_map(source, rows, compression="dwaa:45", envmap="latlong")
    level = {"openexr:dwaCompressionLevel": ("float", 135.0), "compression": ("string", "dwaa:135")}
    path = changed(source, tmp_path / "b.exr", same, **level)

    is_wrong, text = check(path)["dwa"]
    assert is_wrong
    assert text.endswith("above 51000, up to which dwaa:135 is safe from infinity")


def test_a_map_that_was_rolled_in_part_does_not_wrap(folder, tmp_path):
    def change(pixels):
        pixels[:, 32:] = pixels[:, 32:][:, ::-1]
        return pixels

    found = check(changed(folder / "map.exr", tmp_path / "a.exr", change))
    assert found["wrap"][0] is True


def test_a_map_that_lost_its_rows_at_the_pole_is_found(folder, tmp_path):
    def change(pixels):
        pixels[0] = pixels[12]
        return pixels

    found = check(changed(folder / "map.exr", tmp_path / "a.exr", change))
    is_wrong, text = found["pole"]
    assert is_wrong
    assert "the first row" in text


def test_a_face_that_is_mirrored_does_not_meet_its_neighbours(folder, tmp_path):
    for name in CUBE:
        shutil.copy(folder / name, tmp_path / name)
    changed(folder / CUBE[4], tmp_path / CUBE[4], lambda pixels: pixels[::-1])
    result = invoke("check", *(tmp_path / name for name in CUBE), "--quiet")

    assert result.exit_code == 1
    assert f"{tmp_path / CUBE[0]} and the other faces: wrong: cube-edges: the face toward +Z" in (
        result.stdout
    )


@pytest.mark.parametrize(
    ("attributes", "name", "text"),
    [
        (
            {"chromaticities": ("float[8]", (0.7, 0.3, 0.17, 0.8, 0.13, 0.05, 0.3127, 0.329))},
            "colour",
            "colorInteropID is lin_rec709_scene, but chromaticities are others, by up to 0.2",
        ),
        ({"whiteLuminance": ("float", -1.0)}, "whiteLuminance", "not a positive number: -1.0"),
        (
            {"skybake:sunDirection": ("vector", (0.0, 1.0, 1.0))},
            "sunDirection",
            "not a unit vector: its length is 1.414",
        ),
    ],
)
def test_tags_that_contradict_each_other_are_found(folder, tmp_path, attributes, name, text):
    path = changed(folder / "map.exr", tmp_path / "a.exr", same, **attributes)

    assert check(path)[name] == (True, text)


def test_an_environment_of_another_shape_is_found(tmp_path):
    write_map(tmp_path / "a.exr", sky(100, 64), envmap="latlong")

    text = "latlong, which is 2:1, but the size is 100x64"
    assert check(tmp_path / "a.exr")["envmap"] == (True, text)


def test_light_that_was_lost_or_moved_is_found(folder, tmp_path):
    darker = check(changed(folder / "map.exr", tmp_path / "a.exr", lambda pixels: 0.9 * pixels))
    turned = check(
        changed(folder / "map.exr", tmp_path / "b.exr", lambda pixels: np.roll(pixels, 16, 1))
    )
    mirrored = check(changed(folder / "map.exr", tmp_path / "c.exr", lambda p: p[:, ::-1]))

    assert darker.keys() == {"illuminance"}
    assert turned == {"sun": (True, turned["sun"][1])}
    assert "deg from skybake:sunDirection" in turned["sun"][1]
    assert mirrored.keys() == {"sun"}


def test_a_map_of_another_program_has_notes_but_no_faults(tmp_path):
    spec = OpenImageIO.ImageSpec(64, 32, 3, "half")
    out = OpenImageIO.ImageOutput.create(str(tmp_path / "a.exr"))
    out.open(str(tmp_path / "a.exr"), spec)
    out.write_image(np.full((32, 64, 3), 0.25, np.float32))
    out.close()

    assert check(tmp_path / "a.exr") == {
        "colour": (False, "neither colorInteropID nor chromaticities: programs take Rec. 709"),
        "envmap": (False, "absent: programs tell an equirect map by it"),
        "whiteLuminance": (False, "absent: the luminance of 1.0 is not known"),
    }


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("missing.exr", "must be an image file, got nothing"),
        ("a.png", "suffix must be .exr or .hdr, got '.png'"),
        ("broken.exr", "must be an image, got"),
    ],
)
def test_a_file_that_cannot_be_read_is_a_fault_and_others_are_checked(folder, tmp_path, name, text):
    path = tmp_path / name
    if name == "broken.exr":
        path.write_bytes(b"nothing")
    result = invoke("check", path, folder / "map.exr")

    assert result.exit_code == 1
    first, second = result.stdout.splitlines()
    assert first.startswith(f"{path}: wrong: file: {text}")
    assert second == f"{folder / 'map.exr'}: fine"
