"""What is said of maps that lose light or are not what was meant."""

import json
import math
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from skybake.baking.losses import HalfLoss
from skybake.errors import OutputError
from skybake.formats.reader import read_image
from tests.cli.runs import SMALL, invoke, listing

pytestmark = pytest.mark.usefixtures("folder")


def render(*arguments):
    result = invoke("render", *SMALL, "-q", "--json", "-o", "a.exr", *arguments)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    lines = [f"skybake: warning: {text}" for text in told["warnings"]]
    assert result.stderr.splitlines() == lines
    return told["warnings"]


def stored(name):
    """Pixel type of a file."""
    return str(OpenImageIO.ImageInput.open(name).spec().format)


@pytest.mark.parametrize("exponents", [(-30, 0), (-26, -10), (-24, -16), (-14, 10)])
def test_coarse_values_are_counted_as_numpy_rounds_them(exponents):
    values = np.exp2(np.random.default_rng(1).uniform(*exponents, (8, 100, 3))).astype(np.float32)
    values[0] = 0.0
    loss = HalfLoss()
    loss.add(values)
    lit = values[1:].astype(float)
    halves = lit.astype(np.float16).astype(float)
    assert loss.lit == lit.size
    assert loss.zero == np.count_nonzero(halves == 0.0)
    # Every value that is off by more than 1 % is counted; a coarse one may be hit by luck.
    off = np.abs(halves - lit) > 0.01 * lit
    coarse = lit < 2.0**-25 / 0.01
    assert np.all(coarse[off])
    assert loss.coarse == np.count_nonzero(coarse)


def test_a_few_dark_values_are_warned_of_and_many_are_refused():
    for dark, outcome in ((0, None), (1, "half floats hold the darkest values with errors")):
        loss = HalfLoss()
        loss.add(np.array([1e-7] * dark + [1.0] * 100, np.float32))
        found = loss.warning(Path("a.exr"))
        assert found is None if outcome is None else found.startswith(outcome)
    loss.add(np.full(200, 1e-9, np.float32))
    with pytest.raises(OutputError, match=r"a\.exr: half floats must hold most values within 1%"):
        loss.warning(Path("a.exr"))


@pytest.mark.parametrize("sun", ["-10", "-12", "-18"])
def test_half_is_refused_in_twilight_and_no_file_is_left(sun):
    result = invoke("render", *SMALL, "-q", "--pixel", "half", f"--sun={sun}", "-o", "a.exr")
    assert (result.exit_code, result.stdout) == (1, "")
    assert "half floats must hold most values within 1%, got" in result.stderr
    assert listing(Path()) == []
    render(f"--sun={sun}")


def test_half_that_holds_the_light_is_not_warned_of():
    assert render("--pixel", "half") == []
    assert render("--pixel", "half", "--sun=-10", "--ev", "0") == []


def test_a_disc_that_gives_no_light_is_told():
    (warning,) = render("--sun=-5", "--sun-disc", "only")
    assert warning.startswith("the map is black: no light of the sun's disc")
    assert read_image(Path("a.exr"))[0].max() == 0.0
    assert render("--sun=5", "--sun-disc", "only") == []


@pytest.mark.parametrize(
    ("arguments", "is_lost"),
    [
        (("--units", "nits"), True),
        (("--units", "nits", "--sun-disc", "exclude"), False),
        ((), False),
    ],
)
def test_a_disc_that_programs_lose_from_a_radiance_picture_is_told(arguments, is_lost):
    result = invoke("render", "--size", "64x32", "-q", "--json", "-o", "a.hdr", *arguments)
    assert result.exit_code == 0
    assert read_image(Path("a.hdr"))[0].max() > 65504.0 or not is_lost
    assert ("values beyond 65504 are lost" in result.stderr) == is_lost


@pytest.mark.parametrize(
    ("visibility", "start"),
    [("5km", None), ("3km", "Hillaire's closure leaves the sky too dark, by a third and more")],
)
def test_hillaires_closure_is_warned_of_where_it_is_too_dark(visibility, start):
    found = render("--method", "hillaire", "--visibility", visibility)
    assert [one[: len(start or "")] for one in found] == ([] if start is None else [start])


def test_hillaires_closure_is_refused_where_hardly_any_light_is_left():
    for command in ("render", "probe"):
        result = invoke(command, "--method", "hillaire", "--visibility", "1km")
        assert result.exit_code == 1
        assert (
            "Hillaire's closure: optical depth of the atmosphere must be at most 3" in result.stderr
        )
        assert "--method hillaire" not in result.stderr
    assert listing(Path()) == []


def test_a_sequence_is_of_one_pixel_type_and_tells_which_frames_are_black():
    common = ("sequence", *SMALL, "-q", "--json", "--method", "hillaire", "--frames", "1-4")
    told = json.loads(invoke(*common, "--sun=-12..30", "-o", "a.#.exr").stdout)
    assert {stored(name) for name in told["files"]} == {"float"}
    alone = json.loads(invoke(*common, "--sun=20..30", "-o", "d.#.exr").stdout)
    assert {stored(name) for name in alone["files"]} == {"half"}
    part = json.loads(invoke(*common, "--sun=-12..30", "-o", "b.#.exr", "--only", "4").stdout)
    assert Path(part["files"][0]).read_bytes() == Path("a.0004.exr").read_bytes()
    black = json.loads(
        invoke(*common, "--sun=-12..30", "-o", "c.#.exr", "--sun-disc", "only").stdout
    )
    ((text, frames),) = black["warnings"].items()
    assert text.startswith("the map is black")
    assert frames == "1"


def test_the_numbers_of_a_recipe_are_as_they_were_typed():
    render("--sun", "30", "--sun-azimuth", "123.4", "--altitude", "2.3km")
    recipe = json.loads(read_image(Path("a.exr"))[1]["skybake:recipe"])["map"]
    assert recipe["sun_elevation_deg"] == 30.0
    assert recipe["sun_azimuth_deg"] == 123.4
    assert recipe["altitude_m"] == 2300.0
    assert math.isfinite(recipe["white_luminance_cd_m2"])
