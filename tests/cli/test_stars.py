"""``--stars`` and ``--lst``."""

import json
from pathlib import Path

import numpy as np
import pytest

from skybake.formats.reader import ImageFile, read_image
from tests.cli.runs import SMALL, invoke, run

NIGHT = ("--lat", "31", "--lon", "35", "--time", "2026-01-15T19:00Z", "--method", "hillaire")

STARRY = """
import sys
from click.testing import CliRunner
from skybake.cli import main
assert CliRunner().invoke(main, sys.argv[1:]).exit_code == 0
rooms = ("skybake.night", "skybake.image.starry", "skybake.image.night_glow")
print([name for name in sys.modules if name.startswith(rooms)])
"""


def render(*arguments):
    result = invoke("render", *SMALL, "--json", "-q", *arguments)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_stars_are_there_at_a_time_and_tell_their_light(folder):
    told = render(*NIGHT, "-o", "a.exr")
    pixels, tags = read_image(Path("a.exr"))
    assert told["star_illuminance_lux"] == pytest.approx(4.3e-5, rel=0.2)
    assert tags["skybake:starIlluminance"] == pytest.approx(told["star_illuminance_lux"])
    assert told["pixel"] == "float"
    assert pixels.max() > 0.0
    assert invoke("check", "a.exr").exit_code == 0


def test_stars_stand_the_same_by_their_sidereal_time(folder):
    # In Greenwich it is 2h 40min then, and 35 deg east is 2h 20min more.
    told = render(*NIGHT, "-o", "a.exr")
    _, tags = read_image(Path("a.exr"))
    sidereal = json.loads(tags["skybake:recipe"])["map"]["sidereal_time_deg"]
    again = ("--lat", "31", "--lst", f"{sidereal}deg", "--sun", "-50", "--method", "hillaire")
    by_hand = render(*again, "-o", "b.exr")
    assert sidereal / 15.0 == pytest.approx(5.0, abs=0.05)
    assert by_hand["star_illuminance_lux"] == pytest.approx(told["star_illuminance_lux"], rel=0.02)


def test_stars_can_be_left_out(folder):
    assert render(*NIGHT, "--stars", "exclude", "-o", "a.exr")["star_illuminance_lux"] is None
    few = render(*NIGHT, "--stars", "2", "-o", "b.exr")["star_illuminance_lux"]
    assert 0.0 < few < 4e-5


def test_the_glow_of_the_night_is_scaled_or_left_out(folder):
    whole, doubled, off = (
        render(*NIGHT, *options, "-o", "a.exr")["sky_illuminance_lux"]
        for options in ((), ("--airglow", "2", "--zodiacal", "2"), ("--night", "off"))
    )
    assert 0.6e-3 < whole < 1.4e-3
    assert 1.6 < doubled / whole < 2.0
    assert off < 1e-8


def test_a_sky_of_stars_alone_is_dark_between_them(folder):
    render(*NIGHT, "--stars", "only", "--size", "256x128", "-o", "a.exr")
    pixels = read_image(Path("a.exr"))[0]
    assert (pixels[66:] == 0.0).all()
    assert 0.2 < (pixels[:64] > 0.0).any(axis=-1).mean() < 0.99


def test_parts_of_a_map_with_stars_add_up(folder):
    render(*NIGHT, "--layers", "-o", "a.exr")
    parts = {
        name: np.concatenate(list(ImageFile(Path("a.exr"), part=name).bands()))
        for name in ("beauty", "sky", "stars")
    }
    np.testing.assert_allclose(parts["sky"] + parts["stars"], parts["beauty"], rtol=1e-6, atol=0)


@pytest.mark.parametrize(
    "arguments",
    [
        ("--sun", "30deg"),
        ("--sun", "-30deg"),
        (*NIGHT[:4], "--time", "2026-01-15T10:00Z", "--moon", "exclude"),
    ],
)
def test_without_stars_nothing_of_them_is_imported(folder, arguments):
    status, output, errors = run(
        "render", *SMALL, *arguments, "-q", "-o", "a.exr", code=STARRY, cwd=folder
    )
    assert (status, errors) == (0, "")
    assert output == "[]\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--stars", "only"), "--stars: needs --time or --lst"),
        (
            ("--stars", "bright", "--lst", "5h"),
            "'--stars': must be include, exclude, only or a mag",
        ),
        (("--stars", "9", "--lst", "5h", "--lat", "3"), "--stars: magnitude must be from -1.44"),
        (("--lst", "5h"), "--lst: needs --lat"),
        (("--night", "off"), "--night: needs --time or --lst"),
        (("--airglow", "2"), "--airglow: needs --time or --lst"),
        ((*NIGHT, "--airglow", "-1"), "--airglow: must be from 0 to 100, got -1"),
        ((*NIGHT, "--zodiacal", "much"), "'--zodiacal': must be a number such as 1.5, got 'much'"),
        ((*NIGHT, "--night", "off", "--stars", "only"), "--stars: cannot be combined with --night"),
        (("--lst", "25h", "--lat", "3"), "'--lst': must be from 0h to 24h, got 25h"),
        (("--lst", "soon", "--lat", "3"), "'--lst': must be an angle such as 5deg"),
        ((*NIGHT, "--lst", "5h"), "--lst: cannot be combined with --time"),
        (("--lat", "5"), "--lat: needs --time"),
        (("--layers", *NIGHT, "--stars", "only"), "layers must be of a map with the sky"),
    ],
)
def test_what_cannot_be_shown_is_one_line(folder, arguments, message):
    result = invoke("render", *SMALL, *arguments, "-q", "-o", "a.exr")
    assert result.exit_code in (1, 2)
    assert result.stderr.count("\n") == 1
    assert message in result.stderr
    assert not list(folder.iterdir())
