"""``--stars`` and ``--lst``."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

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
    # Of it 2e-5 lx are those of Jupiter, at opposition with V -2.7.
    assert told["star_illuminance_lux"] == pytest.approx(6.9e-5, rel=0.1)
    assert tags["skybake:starIlluminance"] == pytest.approx(told["star_illuminance_lux"])
    assert (told["pixel"], told["white_luminance_cd_m2"]) == ("half", pytest.approx(0.15))
    assert pixels.max() > 0.0
    night = told["night"]
    assert night["sky_illuminance_lux"] == pytest.approx(told["sky_illuminance_lux"], rel=1e-3)
    assert tags["skybake:nightZenithLuminance"] == pytest.approx(night["zenith_luminance_cd_m2"])
    assert 21.0 < night["zenith_mag_arcsec2"] < 22.0
    rotation = np.reshape(night["celestial_rotation"], (3, 3))
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    # The north pole of the stars is as high as the latitude, in the north.
    assert rotation[:, 2] == pytest.approx(
        (0.0, np.sin(np.radians(31)), -np.cos(np.radians(31))), abs=5e-3
    )
    np.testing.assert_allclose(
        np.ravel(tags["skybake:celestialRotation"]), rotation.ravel(), atol=1e-6
    )
    assert invoke("check", "a.exr").exit_code == 0


def test_stars_stand_the_same_by_their_sidereal_time(folder):
    # In Greenwich it is 2h 40min then, and 35 deg east is 2h 20min more.
    told = render(*NIGHT, "-o", "a.exr")
    _, tags = read_image(Path("a.exr"))
    sidereal = json.loads(tags["skybake:recipe"])["map"]["sidereal_time_deg"]
    again = ("--lat", "31", "--lst", f"{sidereal}deg", "--sun", "-50", "--method", "hillaire")
    by_hand = render(*again, "-o", "b.exr")
    assert sidereal / 15.0 == pytest.approx(5.0, abs=0.05)
    # Without a date there are no planets.
    assert by_hand["star_illuminance_lux"] == pytest.approx(4.7e-5, rel=0.1)
    assert told["star_illuminance_lux"] - by_hand["star_illuminance_lux"] == pytest.approx(
        2e-5, rel=0.2
    )


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


def test_a_scale_that_is_given_is_kept(folder):
    for given, white in ((("--units", "ev15"), 39321.6), (("--ev", "0"), 1.2)):
        told = render(*NIGHT, *given, "-o", "a.exr")
        assert told["white_luminance_cd_m2"] == pytest.approx(white)
    plain = render("--sun", "-50", "--method", "hillaire", "-o", "b.exr")
    assert plain["white_luminance_cd_m2"] == pytest.approx(39321.6)
    assert plain["night"] is None


def test_the_summary_says_the_scale_and_the_light_of_a_night(folder):
    result = invoke("render", *SMALL, *NIGHT, "-o", "a.exr")
    assert "1.0 = 0.15 cd/m2 (EV -3, of a night)" in result.stdout
    assert "mag/arcsec2" in result.stdout


def test_a_picture_for_the_eye_is_bluer_and_the_map_is_the_same(folder):
    pictures = []
    for vision in ("camera", "eye"):
        render(
            *NIGHT, "--preview", f"{vision}.png", "--preview-vision", vision, "-o", f"{vision}.exr"
        )
        with Image.open(f"{vision}.png") as picture:
            pictures.append(np.asarray(picture, float).reshape(-1, 3).mean(axis=0))
            texts = picture.text
    (red, _, blue), (eye_red, _, eye_blue) = pictures
    assert red > blue
    assert eye_red < eye_blue
    assert texts["skybake:vision"] == "eye"
    assert Path("camera.exr").read_bytes() == Path("eye.exr").read_bytes()
    assert invoke("preview", "camera.exr", "-o", "again.png", "--vision", "eye").exit_code == 0
    with Image.open("again.png") as again:
        mean = np.asarray(again, float).reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(mean, pictures[1], atol=3.0)


def test_cities_brighten_the_zenith_to_what_is_asked_for(folder):
    world = ("--preset", "earth-hillaire2020", *NIGHT, "--airglow", "0", "--zodiacal", "0")
    by = {
        level: render(*world, "--light-pollution", level, "-o", "a.exr")["night"]
        for level in ("off", "2mcd", "2mcd,90deg")
    }
    dark, lit, toward = (each["zenith_luminance_cd_m2"] for each in by.values())
    assert lit - dark == pytest.approx(2e-3)
    assert toward == pytest.approx(lit)


def test_lighting_maps_have_the_light_of_the_night(folder):
    arguments = (*NIGHT, "--parts", "diffuse", "--diffuse-size", "8")
    for name, more in (("night", ()), ("black", ("--night", "off"))):
        result = invoke("ibl", *arguments, *more, "--format", "exr", "-q", "-o", name)
        assert result.exit_code == 0, result.output
    up, black = (read_image(next(Path().glob(f"{each}*py*.exr"))) for each in ("night", "black"))
    white = up[1]["whiteLuminance"]
    assert white == pytest.approx(0.15)
    # A millilux over pi.
    luminance = np.pi * white * (up[0].reshape(-1, 3).mean(axis=0) @ (0.2126, 0.7152, 0.0722))
    assert 0.5e-3 < luminance < 1.4e-3
    assert black[0].max() * black[1]["whiteLuminance"] < 1e-6


def test_a_sky_of_stars_alone_is_dark_between_them(folder):
    render(*NIGHT, "--stars", "only", "--size", "256x128", "-o", "a.exr")
    pixels = read_image(Path("a.exr"))[0]
    assert (pixels[66:] == 0.0).all()
    assert 0.2 < (pixels[:64] > 0.0).any(axis=-1).mean() < 0.99


def test_parts_of_a_map_with_stars_add_up(folder):
    render(*NIGHT, "--layers", "--pixel", "float", "-o", "a.exr")
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
        (("--light-pollution", "1mcd"), "--light-pollution: needs --time or --lst"),
        ((*NIGHT, "--light-pollution", "22mag"), "must be from 13mag to below 22mag"),
        ((*NIGHT, "--light-pollution", "bright"), "must be off or such as 20mag or 1.5mcd,90deg"),
        ((*NIGHT, "--light-pollution", "5000mcd"), "--light-pollution: must be from 0 to 1000mcd"),
        ((*NIGHT, "--light-pollution", "1mcd,north"), "'--light-pollution': must be an angle such"),
        ((*NIGHT, "--preview-vision", "eye"), "--preview-vision: needs --preview"),
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
