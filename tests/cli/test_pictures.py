"""Options of pictures, as users type them."""

import json
import math
import re
from contextlib import chdir
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from skybake.formats.reader import read_attributes
from tests.cli.runs import SMALL, invoke, listing

WEST = ("--shot", "270,10,60deg")


def done(*arguments):
    """Exit status and what is printed."""
    result = invoke(*arguments)
    return result.exit_code, result.stdout, result.stderr


def render(target, *arguments):
    """Render, which must say nothing; returns the bytes of the map."""
    assert done("render", *arguments, "-o", target, "--quiet") == (0, "", "")
    return target.read_bytes()


def codes(path):
    picture = OpenImageIO.ImageBuf(str(path))
    assert not picture.has_error
    return picture.get_pixels(OpenImageIO.FLOAT)


@pytest.mark.usefixtures("folder")
def test_a_picture_changes_nothing_of_its_map(tmp_path):
    arguments = (*SMALL, "--preset", "mars", "--sun", "3deg")
    plain = render(tmp_path / "a.exr", *arguments)
    options = ("--preview", "--white-balance", "auto", *WEST, "--view", "aces2")

    assert render(tmp_path / "a.exr", *arguments, *options) == plain
    assert codes(tmp_path / "a.png").shape == (576, 1024, 3)


@pytest.mark.usefixtures("folder")
def test_render_and_preview_tell_the_exposure_and_the_white(tmp_path):
    arguments = ("--preset", "mars", "--sun", "20deg", "--size", "256x128", "-o", "a.exr")
    status, output, _ = done("render", *arguments, "--preview")
    assert status == 0
    line = output.splitlines()[1]
    status, later, _ = done("preview", "a.exr", "-o", "a.png")
    assert status == 0
    pattern = r"a\.png  exposed for EV ([\d.]+), white is xy ([\d.]+) ([\d.]+)"
    at_once, afterwards = (re.fullmatch(pattern, text.strip()) for text in (line, later))
    ev, x, y = map(float, at_once.groups())
    assert tuple(map(float, afterwards.groups())) == (
        pytest.approx(ev, abs=0.03),
        pytest.approx(x, abs=2e-3),
        pytest.approx(y, abs=2e-3),
    )
    assert ev == pytest.approx(12.0, abs=0.3)
    status, output, _ = done("render", *arguments, "--preview", "--json")
    told = json.loads(output)
    assert [f"{one:.4f}" for one in told["preview_white"]] == line.split()[-2:]


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("shot", "shown"),
    [("180,-90,40", "ground"), ("180,90,40", "sky"), ("3.14159rad,-1.5707rad,40", "ground")],
)
def test_a_shot_looks_where_it_is_told_in_render_and_in_preview(tmp_path, shot, shown):
    arguments = (*SMALL, "--sun", "30deg", "--preview", "at_once.png", "--shot", shot)
    render(tmp_path / "a.exr", *arguments)
    later = done("preview", "a.exr", "-o", "later.png", "--shot", shot, "-q")
    assert later == (0, "", "")
    for name in ("at_once.png", "later.png"):
        red, green, blue = np.median(codes(tmp_path / name), axis=(0, 1))
        assert (blue > green > red) if shown == "sky" else (green > blue)


def test_a_shot_of_a_picture_of_unknown_layout_is_one_line_and_no_file(folder):
    header = OpenImageIO.ImageSpec(30, 20, 3, "half")
    output = OpenImageIO.ImageOutput.create("exr")
    assert output.open("a.exr", header)
    assert output.write_image(np.ones((20, 30, 3), np.float32))
    assert output.close()
    result = invoke("preview", "a.exr", *WEST)
    assert (result.exit_code, result.stderr) == (
        1,
        "skybake: a.exr: shot: must be of a map whose layout is known, got a picture of 30x20\n",
    )
    assert listing(folder) == ["a.exr"]


@pytest.mark.parametrize(
    "recipe",
    ["[]", "{", '{"map": 3}', '{"map": {"projection": 3}}', '{"map": {"projection": "equirect"}}'],
)
def test_a_recipe_that_does_not_fit_is_no_traceback(folder, recipe):
    """The last one is of a picture that is no such map."""
    header = OpenImageIO.ImageSpec(30, 20, 3, "half")
    header["skybake:recipe"] = recipe
    output = OpenImageIO.ImageOutput.create("exr")
    assert output.open("a.exr", header)
    assert output.write_image(np.ones((20, 30, 3), np.float32))
    assert output.close()
    assert invoke("preview", "a.exr", "--white-balance", "auto").exit_code == 0
    assert invoke("preview", "a.exr", *WEST).exit_code == 1


@pytest.mark.usefixtures("folder")
def test_sheets_and_animations_take_shots_and_white_balances(tmp_path):
    arguments = ("--preset", "mars", "--sun", "3..20deg", "--frames", "1-2", *SMALL, "-q")
    pictures = ("--contact-sheet", "sheet.png", "--animate", "a.webp", "--preview")
    found = {}
    for name, options in (("plain", ("--white-balance", "none")), ("shot", WEST)):
        (tmp_path / name).mkdir()
        with chdir(name):
            assert done("sequence", *arguments, *pictures, *options) == (0, "", "")
        found[name] = {
            file: codes(tmp_path / name / file) for file in ("sheet.png", "a.webp", "mars.0001.png")
        }
    assert found["shot"]["a.webp"].shape[:2] == (288, 512)
    assert found["shot"]["mars.0001.png"].shape[:2] == (576, 1024)
    assert found["plain"]["a.webp"].shape[:2] == (256, 512)
    # Without the balance the sky of Mars is brown.
    redness = {
        name: np.median(shown["mars.0001.png"][..., 0] - shown["mars.0001.png"][..., 2])
        for name, shown in found.items()
    }
    assert redness["plain"] > redness["shot"] + 0.05
    texts = read_attributes(tmp_path / "shot" / "mars.0001.png")
    assert (texts["skybake:whiteBalance"], texts["skybake:shot"]) == ("auto", "270,10,60")


def tiles(path):
    """Mean of each tile of a sheet of two, one above the other or side by side."""
    sheet = codes(path)
    tall = sheet.shape[0] > sheet.shape[1]
    return [half.max(axis=-1).mean() for half in np.array_split(sheet, 2, axis=0 if tall else 1)]


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("options", "is_adapted"),
    [
        ((), True),
        (("--preview-ev", "adapt"), True),
        (("--preview-ev", "auto"), False),
        (("--preview-ev", "13"), False),
        (("--exposure-curve", "ev.csv"), False),
    ],
)
def test_the_tiles_of_a_sheet_are_exposed_each_for_itself_by_default(tmp_path, options, is_adapted):
    (tmp_path / "ev.csv").write_text("frame,ev\n1,13\n")
    arguments = ("--sun", "-6..60deg", "--frames", "1-2", "--shot", "0,60,60", *SMALL, "-q")
    arguments += ("--contact-sheet", "s.png", "-o", "a.#.exr")
    assert done("sequence", *arguments, *options) == (0, "", "")
    dark, bright = tiles(tmp_path / "s.png")

    assert (dark > 0.5 * bright) == is_adapted


@pytest.mark.usefixtures("folder")
def test_a_sheet_that_adapts_leaves_the_exposure_of_previews_as_it_is(tmp_path):
    arguments = ("sequence", "--sun", "-6..60deg", "--frames", "1-2", *SMALL, "-q", "--preview")
    assert done(*arguments) == (0, "", "")
    before = [path.read_bytes() for path in sorted(tmp_path.glob("*.png"))]
    assert done(*arguments, "--contact-sheet", "s.png") == (0, "", "")

    assert [path.read_bytes() for path in sorted(tmp_path.glob("earth*.png"))] == before
    evs = {read_attributes(path)["skybake:exposureValue"] for path in tmp_path.glob("earth*.png")}
    assert len(evs) == 1


def test_an_emitted_command_keeps_how_previews_look(folder):
    result = invoke(
        *("sequence", "--sun", "30", "--frames", "1-2", "--preview", "--emit-commands"),
        *("--white-balance", "5500K", "--shot", "180,10,50"),
    )
    (line,) = result.stdout.splitlines()
    assert " --white-balance=5500K --shot=180,10,50" in line
    assert listing(folder) == []


def test_python_takes_the_same_settings(folder):
    result = invoke("render", *SMALL, "-o", "a.exr", "--preview", *WEST)
    assert result.exit_code == 0
    import skybake

    west = skybake.Perspective(1024, 576, math.radians(60.0), 1.5 * math.pi, math.radians(10.0))
    settings = skybake.map_settings(size=64)
    picture = skybake.PictureSettings(shot=west)
    skybake.bake("earth", "b.exr", settings, preview="b.png", picture=picture)
    assert (Path("a.png").read_bytes(), folder) == (Path("b.png").read_bytes(), folder)
