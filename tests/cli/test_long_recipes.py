"""Presets with much text in them, whose maps other programs must be able to open."""

import hashlib
import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from skybake.formats.reader import read_image
from skybake.image.recipe import LONGEST_RECIPE
from skybake.preset import load_preset
from tests.cli.runs import invoke
from tests.formats.maps import program

QUICK = ("--size", "32x16", "--method", "hillaire", "-q")


@pytest.fixture
def long(folder):
    """A preset whose ground has a spectrum of 400 numbers."""
    nodes = [300.0 + 1.5 * i for i in range(400)]
    values = [0.1 + 0.0001 * i for i in range(400)]
    path = folder / "long.toml"
    path.write_text(
        f'extends = "earth"\n[ground]\nwavelength_nm = {nodes}\nalbedo = {values}\n', "utf-8"
    )
    return path


@pytest.mark.parametrize("suffix", ["exr", "hdr"])
def test_a_long_preset_makes_a_map_that_is_read_shown_and_found_again(long, suffix):
    name = f"a.{suffix}"
    assert invoke("render", *QUICK, "--preset", long, "-o", name).exit_code == 0
    assert invoke("preview", name).exit_code == 0
    recipe = read_image(Path(name))[1]["skybake:recipe"]
    assert len(recipe) <= LONGEST_RECIPE
    whole = load_preset(long).recipe
    for key in ("wavelength_nm", "albedo"):
        whole["ground"][key] = digest(whole["ground"][key])
    assert json.loads(recipe)["preset"] == whole
    arguments = ("sequence", *QUICK, "--preset", long, "--frames", "1", "-o", f"b.#.{suffix}")
    assert invoke(*arguments).exit_code == 0
    result = invoke(*[one for one in arguments if one != "-q"], "--skip-existing")
    assert "0 frames baked, 1 skipped" in result.stdout
    manifest = json.loads(Path("b.sequence.json").read_text("utf-8"))
    assert len(manifest["recipe"]["preset"]["ground"]["albedo"]) == 400


def test_a_preset_that_is_long_without_its_lists_is_replaced_by_its_digest(folder):
    text = f'extends = "earth"\ntitle = "{"x" * 4000}"\n'
    Path("long.toml").write_text(text, "utf-8")
    assert invoke("render", *QUICK, "--preset", "long.toml", "-o", "a.hdr").exit_code == 0
    recipe = json.loads(read_image(Path("a.hdr"))[1]["skybake:recipe"])
    assert recipe["preset"] == digest(load_preset(Path("long.toml")).recipe)
    assert recipe["map"]["width"] == 32


def digest(value):
    text = json.dumps(value, sort_keys=True)
    return {"sha256": hashlib.sha256(text.encode()).hexdigest()}


def test_attributes_that_no_radiance_header_has_room_for_are_refused(folder):
    from skybake import bake, map_settings
    from skybake.errors import InputError

    settings = map_settings(size=8, method="hillaire")
    with pytest.raises(InputError, match=r"a.hdr: attributes must fit into 90 lines"):
        bake("earth", Path("a.hdr"), settings, attributes={"note": "x" * 8000})
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize(
    "options",
    [
        (),
        ("--preset", "earth-volcanic", "--pixel", "float", "--compression", "piz"),
        ("--preset", "mars", "--projection", "cubemap", "--cube-layout", "exr", "--size", "16"),
        (
            "--size",
            "16",
            "--lat",
            "48.86",
            "--lon",
            "2.35",
            "--time",
            "2026-06-21T12:00Z",
            "--projection",
            "angular",
        ),
    ],
)
def test_ffmpeg_sees_the_light_of_a_map(folder, options):
    assert invoke("render", *QUICK, *options, "-o", "a.exr").exit_code == 0
    assert brightest_by_ffmpeg("a.exr") > 50


def test_ffmpeg_sees_the_light_of_a_map_of_a_long_preset(long):
    assert invoke("render", *QUICK, "--preset", long, "-o", "a.exr").exit_code == 0
    assert brightest_by_ffmpeg("a.exr") > 50


def brightest_by_ffmpeg(file):
    command = (program("ffmpeg"), "-v", "error", "-i", file, "-f", "rawvideo")
    process = subprocess.run(
        [*command, "-pix_fmt", "rgb24", "-"], capture_output=True, check=True, timeout=60
    )
    return np.frombuffer(process.stdout, np.uint8).max()
