"""Targets, charts, and the names and spaces of cubemaps, on the command line."""

import json
import math

import numpy as np
import pytest

from skybake.angles import direction_from_angles
from skybake.formats.reader import ImageFile
from skybake.image.target import TARGETS
from skybake.projection.of_file import file_canvas
from tests.baking.maps import pixels
from tests.cli.runs import invoke, listing
from tests.cli.test_faults import check_fault

CUBE = "--projection cubemap --size 16"

USAGE = """
--target maya                            => '--target': 'maya' is not one of 'blender',
--target unreal -o a.exr                 => --target unreal: needs an output .hdr, got '.exr'
--target openexr -o a.hdr                => --target openexr: needs an output .exr, got '.hdr'
--target blender --projection cubemap    => --projection: must be equirect for the target blender
--target usd --projection fisheye        => --projection: must be equirect for the target usd
--target three --cube-space flip-x       => --cube-space: needs --projection cubemap
--target unity --projection cubemap --cube-space world => --cube-space: must be flip-z for the
--target mitsuba --equirect-rows centres => --equirect-rows: must be poles for the target mitsuba
--target three --projection cubemap -o a.ktx2 => --target three: needs an output .hdr or .exr
--target three --sun-soft                => --sun-soft: needs --sun-disc include with --target three
--target unreal --pixel half             => --pixel: needs an .exr, .ktx2 or .dds
--face-names posx                        => --face-names: needs --projection cubemap
--projection cubemap --face-names top    => --face-names: must be px, posx, +X, right or six
--projection cubemap --cube-layout cross --face-names posx => --face-names: must belong to the cube
--projection cubemap --cube-space flip-y => '--cube-space': 'flip-y' is not one of 'world',
--projection cubemap --cube-layout exr --cube-space flip-z => --cube-space: must be world for the
"""


@pytest.mark.parametrize("command", ["render", "chart"])
@pytest.mark.parametrize("line", USAGE.strip().splitlines())
def test_what_contradicts_a_target_is_one_line_of_wrong_usage(tmp_path, monkeypatch, line, command):
    monkeypatch.chdir(tmp_path)
    arguments, message = (part.strip() for part in line.split("=>"))
    check_fault(invoke(command, *arguments.split()), 2, message)
    assert listing(tmp_path) == []


def direction_of(chart):
    zenith, bearing = np.broadcast_arrays(*chart.angles(0, chart.height))
    return direction_from_angles(bearing, math.pi / 2.0 - zenith)


@pytest.mark.parametrize("space", ["world", "flip-x", "flip-z"])
@pytest.mark.parametrize(
    ("options", "count"),
    [
        ("--face-names posx -o a.exr", 6),
        ("--face-names right -o bright_{face}_16.exr", 6),
        ("--face-names rt,lf,up,dn,ft,bk -o {face}.exr", 6),
        ("--cube-layout vertical-cross -o a.exr", 1),
        ("--cube-layout row -o a.exr", 1),
    ],
)
def test_files_say_where_their_pixels_look(tmp_path, monkeypatch, space, options, count):
    monkeypatch.chdir(tmp_path)
    command = f"chart --directions --pixel float {CUBE} --cube-space {space} {options} -q"
    assert invoke(*command.split()).exit_code == 0
    files = sorted(tmp_path.iterdir())
    assert len(files) == count
    for file in files:
        image = ImageFile(file)
        canvas = file_canvas(image.attributes, file.stem, image.width, image.height)
        for part in canvas.parts:
            here = pixels(file)[part.row :, part.column :][: part.chart.height, : part.chart.width]
            here = here[::-1, ::-1] if part.flip == "both" else here
            np.testing.assert_allclose(2.0 * here - 1.0, direction_of(part.chart), atol=1e-6)


def test_a_cubemap_of_a_sky_is_mirrored_in_its_space(tmp_path, monkeypatch):
    """A face with x negated is the one opposite, mirrored left to right; the sun on it, too."""
    monkeypatch.chdir(tmp_path)
    shared = f"{CUBE} --sun 20deg --sun-azimuth 100deg --method hillaire --pixel float -q"
    assert invoke("render", *shared.split(), "-o", "a.exr").exit_code == 0
    flipped = "--cube-space flip-x --face-names +X -o b.exr"
    assert invoke("render", *shared.split(), *flipped.split()).exit_code == 0
    partners = {"+X": "nx", "-X": "px", "+Y": "py", "-Y": "ny", "+Z": "pz", "-Z": "nz"}
    assert pixels("a_px.exr").max() > 100.0 * pixels("a_py.exr").max()
    for name, partner in partners.items():
        mirrored = pixels(f"a_{partner}.exr")[:, ::-1]
        np.testing.assert_allclose(pixels(f"b_{name}.exr"), mirrored, rtol=1e-4)


def test_a_map_for_a_program_states_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = invoke(
        "render", *["--target", "unreal", "--size", "64", "--method", "hillaire", "--json", "-q"]
    )
    printed = json.loads(result.stdout)
    (file,) = listing(tmp_path)
    assert file == "earth_sun30.00deg_rot180deg_hillaire_nodisc_nits_unreal_equirect.hdr"
    assert printed["target"] == "unreal"
    assert printed["target_sun_direction"] == pytest.approx([0.0, math.sqrt(0.75), 0.5])
    attributes = ImageFile(tmp_path / file).attributes
    assert attributes["skybake:target"] == "unreal"
    stated = [float(number) for number in attributes["skybake:targetSunDirection"].split()]
    assert stated == pytest.approx(printed["target_sun_direction"], abs=1e-6)
    assert json.loads(attributes["skybake:recipe"])["map"]["target"] == "unreal"
    assert b"EXPOSURE=" not in (tmp_path / file).read_bytes()
    assert float(attributes["whiteLuminance"]) == 1.0


def test_the_summary_tells_where_the_sun_is_in_the_program(tmp_path):
    arguments = "--target blender --sun 0deg --sun-azimuth 90deg --size 16"
    result = invoke("chart", *arguments.split(), "-o", tmp_path / "a.exr")
    assert result.stdout.splitlines()[1] == (
        "blender: +X is east, +Y north, +Z up; toward the sun (1.0000, 0.0000, 0.0000)"
    )


def test_frames_of_a_sequence_have_the_format_of_the_target():
    arguments = "--target unreal --frames 1-2 --size 64 --dry-run --json"
    plan = json.loads(invoke("sequence", *arguments.split()).stdout)
    assert [frame["file"] for frame in plan["frames"]] == ["earth.0001.hdr", "earth.0002.hdr"]
    assert {frame["target"] for frame in plan["frames"]} == {"unreal"}


def test_a_chart_has_letters_where_the_program_has_its_axes(tmp_path):
    """White ink on dark paper, which the colours of directions nowhere are."""
    for name, axis_bearing in (("plain", 0.0), ("turned", 0.25)):
        options = f"--size 512 --rotate {360.0 * axis_bearing}deg --pixel float -q".split()
        invoke("chart", *options, "-o", tmp_path / f"{name}.exr")
    plain, turned = (pixels(tmp_path / f"{name}.exr") for name in ("plain", "turned"))
    # Points of the compass turn with the sky, and axes stay with the map.
    compass, axes = np.s_[103:124], np.s_[135:150]
    np.testing.assert_allclose(np.roll(plain, -128, axis=1)[compass], turned[compass], atol=0.05)
    assert np.abs(np.roll(plain, -128, axis=1)[axes] - turned[axes]).max() > 0.5
    ink = (plain > 0.95).all(axis=-1)
    assert (ink[axes] == (turned > 0.95).all(axis=-1)[axes]).mean() > 0.99


def test_a_chart_is_as_bright_as_a_sky_in_any_unit(tmp_path):
    for units, brightest in (("ev15", 1.0), ("nits", 1.2 * 2**15)):
        path = tmp_path / f"{units}.exr"
        invoke("chart", *f"--directions --size 64 --units {units} -q".split(), "-o", path)
        assert pixels(path).max() == pytest.approx(brightest, rel=2e-3)


def test_targets_are_listed_and_shown_with_reasons():
    lines = invoke("targets").stdout.splitlines()
    assert [line.split()[0] for line in lines] == list(TARGETS)
    shown = invoke("targets", "unreal").stdout
    assert "--rotate 180deg" in shown
    assert "Unreal imports a 2:1 .hdr" in shown
    assert max(map(len, shown.splitlines())) <= 130
    assert json.loads(invoke("targets", "three", "--json").stdout)["cube_space"] == "flip-x"
    assert [one["name"] for one in json.loads(invoke("targets", "--json").stdout)] == list(TARGETS)
    check_fault(invoke("targets", "maya"), 2, "'maya' is not one of")
