"""What a render writes and tells."""

import json
import math
from pathlib import Path

import OpenImageIO
import pytest

from skybake.baking import bake
from skybake.formats.reader import read_attributes, read_image
from skybake.image.settings import map_settings
from tests.cli.runs import SMALL, invoke, listing


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def render(*arguments):
    """Render quietly with --json and return the object."""
    result = invoke("render", *arguments, "--json", "--quiet")
    assert result.exit_code == 0, result.output
    assert result.stderr == ""
    assert result.stdout.count("\n") == 1
    return json.loads(result.stdout)


def test_json_says_what_was_baked(folder):
    told = render(*SMALL, "--sun", "30deg", "--sun-azimuth", "90deg", "-o", "a.exr")
    baked = bake("earth", "b.exr", map_settings(size=64, sun_azimuth=math.pi / 2))
    assert told["files"] == ["a.exr"]
    assert told["preset"] == "earth"
    assert told["sun_direction"] == pytest.approx([math.sqrt(0.75), 0.5, 0.0], abs=1e-12)
    assert told["direct_illuminance_lux"] == baked.direct_illuminance
    assert told["direct_normal_illuminance_lux"] == baked.direct_normal_illuminance
    assert told["sky_illuminance_lux"] == baked.sky_illuminance
    assert told["white_luminance_cd_m2"] == pytest.approx(1.2 * 2**15)
    assert (told["projection"], told["colorspace"]) == ("equirect", "lin_rec709")
    assert told["pixel"] == "half"
    assert told["clamped"] == 0
    assert (told["preview"], told["preview_ev"], told["preview_white"]) == (None, None, None)
    assert 0.0 < told["seconds"] < 300.0
    assert told["sun_distance_au"] == 1.0
    assert told["sun_angular_diameter_deg"] == pytest.approx(0.5329, abs=1e-4)
    assert told["warnings"] == []
    assert told["from_below_lux"] is None
    assert (told["sun_azimuth_deg"], told["sun_elevation_deg"]) == (90.0, 30.0)
    assert told["sun_colour"] == pytest.approx(baked.sun_colour, rel=1e-9)
    assert 4500.0 < told["sun_colour_temperature_k"] < 5200.0
    strength = baked.direct_normal_illuminance / baked.white_luminance
    expected = [strength * component for component in baked.sun_colour]
    assert told["sun_irradiance"] == pytest.approx(expected, rel=1e-9)
    assert (told["sun_disc"], told["lights"]) == ("include", [])
    assert (told["target"], told["target_sun_direction"]) == (None, None)
    assert [told[key] for key in ("star_illuminance_lux", "eclipse", "night", "moon")] == [None] * 4
    assert len(told) == 34


def test_the_suggested_exposure_is_that_of_a_preview():
    told = render(*SMALL, "--sun", "5deg", "-o", "a.exr", "--preview", "a.png")
    assert told["exposure_ev"] == told["preview_ev"]


def test_lights_beside_a_map_leave_the_disc_out_of_it(folder):
    names = ("a.light.json", "a.usda", "a.py")
    files = [part for name in names for part in ("--lights", name)]
    result = invoke("render", *SMALL, "-o", "a.exr", *files)
    assert result.exit_code == 0
    assert "the map leaves out the sun's disc, which is a light of its own" in result.stderr
    assert result.stdout.splitlines()[:4] == ["a.exr", *names]
    render(*SMALL, "-o", "b.exr", "--sun-disc", "exclude")
    assert Path("a.exr").read_bytes() == Path("b.exr").read_bytes()
    assert listing(folder) == sorted(["a.exr", "b.exr", *names])


def test_lights_beside_a_map_that_is_to_hold_the_disc_are_the_sky_alone():
    told = render(*SMALL, "-o", "a.exr", "--sun-disc", "include", "--lights", "a.json")
    assert told["sun_disc"] == "include"
    assert json.loads(Path("a.json").read_text())["sun"]["is_in_map"] is True
    render(*SMALL, "-o", "b.exr")
    assert Path("a.exr").read_bytes() == Path("b.exr").read_bytes()


def test_size_and_strength_of_the_disc_are_those_of_the_light():
    options = ("--sun-size", "4deg", "--sun-strength", "0.5", "--lights", "a.json")
    told = render(*SMALL, *options, "-o", "a.exr")
    sun = json.loads(Path("a.json").read_text())["sun"]
    assert sun["angular_diameter_deg"] == told["sun_angular_diameter_deg"] == pytest.approx(4.0)
    full = render(*SMALL, "-o", "b.exr")
    half = 0.5 * full["direct_normal_illuminance_lux"]
    assert sun["illuminance_lux"] == pytest.approx(half, rel=1e-6)


def test_a_map_that_a_file_of_lights_cannot_refer_to_leaves_nothing(folder):
    cube = ("--projection", "cubemap", "--size", "16")
    result = invoke("render", *cube, "-o", "a.exr", "--lights", "a.usda")
    assert result.exit_code == 1
    assert result.stderr.endswith("needs maps of the projection equirect, got cubemap\n")
    result = invoke("render", *SMALL, "-o", "a.exr", "--lights", "a.usdc")
    assert result.exit_code == 2
    assert "--lights" in result.stderr
    assert listing(folder) == []


def test_the_file_carries_what_json_says():
    told = render(*SMALL, "--sun", "0.1rad", "--units", "nits", "--preset", "mars", "-o", "a.exr")
    _, attributes = read_image(Path("a.exr"))
    for key, name in {
        "sun_direction": "sunDirection",
        "direct_illuminance_lux": "directIlluminance",
        "direct_normal_illuminance_lux": "directNormalIlluminance",
        "sky_illuminance_lux": "skyIlluminance",
    }.items():
        assert attributes[f"skybake:{name}"] == pytest.approx(told[key], rel=1e-6, abs=1e-7)
    assert attributes["whiteLuminance"] == told["white_luminance_cd_m2"] == 1.0
    assert attributes["skybake:preset"] == told["preset"] == "mars"
    recipe = json.loads(attributes["skybake:recipe"])
    assert recipe["map"]["sun_elevation_deg"] == pytest.approx(math.degrees(0.1))
    assert recipe["preset"]["planet"]["radius_km"] == 3389.5


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ((), "earth_sun30.00deg_equirect.exr"),
        (("--sun", "-4deg"), "earth_sun-04.00deg_equirect.exr"),
        (("--sun=-4",), "earth_sun-04.00deg_equirect.exr"),
        (("--sun", "5400arcmin"), "earth_sun90.00deg_equirect.exr"),
        (("--altitude", "30000ft"), "earth_sun30.00deg_9144m_equirect.exr"),
        (("--preset", "mars", "--altitude", "2km"), "mars_sun30.00deg_2000m_equirect.exr"),
        (
            (
                *("--ground-albedo", "snow", "--sun-azimuth", "450", "--sun-disc", "exclude"),
                *("--method", "hillaire"),
            ),
            "earth_ground.albedo=snow_sun30.00deg_az090.00deg_hillaire_nodisc_equirect.exr",
        ),
    ],
)
def test_the_default_name_says_what_it_is_and_lies_in_the_current_folder(folder, arguments, name):
    assert render(*SMALL, *arguments)["files"] == [name]
    assert listing(folder) == [name]


def test_a_preset_of_ones_own_gives_its_name(folder):
    Path("dusty.toml").write_text(invoke("presets", "show", "mars").stdout, encoding="utf-8")
    told = render(*SMALL, "--preset", "dusty.toml", "--sun", "5")
    assert told["preset"] == "dusty"
    assert listing(folder) == ["dusty.toml", "dusty_sun05.00deg_equirect.exr"]


FACES = ["px", "nx", "py", "ny", "pz", "nz"]


@pytest.mark.parametrize(
    ("arguments", "names", "size"),
    [
        (("-o", "a.exr"), [f"a_{face}.exr" for face in FACES], (16, 16)),
        (("-o", "{face}.hdr"), [f"{face}.hdr" for face in FACES], (16, 16)),
        (("-o", "a.exr", "--cube-layout", "cross"), ["a.exr"], (64, 48)),
        (("-o", "a.hdr", "--cube-layout", "cross"), ["a.hdr"], (64, 48)),
        (("-o", "a.exr", "--cube-layout", "vertical-cross"), ["a.exr"], (48, 64)),
        (("-o", "a.exr", "--cube-layout", "exr"), ["a.exr"], (16, 96)),
    ],
)
def test_a_cubemap_is_six_files_a_cross_or_a_column(folder, arguments, names, size):
    told = render("--projection", "cubemap", "--size", 16, *arguments)
    assert told["files"] == names
    assert listing(folder) == sorted(names)
    for name in names:
        spec = OpenImageIO.ImageInput.open(name).spec()
        assert (spec.width, spec.height) == size
    assert told["pixel"] == ("half" if names[0].endswith(".exr") else "rgbe")


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (("-o", "a.exr", "--preview"), "a.png"),
        (("-o", "a.exr", "--preview", "b.png"), "b.png"),
        (("--preview", "--sun", "-4deg"), "earth_sun-04.00deg_equirect.png"),
        (
            ("--preview", "--projection", "cubemap", "--size", "16", "-o", "{face}.exr"),
            "preview.png",
        ),
    ],
)
def test_a_preview_lies_beside_the_map_unless_it_has_a_name(folder, arguments, name):
    size = () if "--size" in arguments else SMALL
    told = render(*size, *arguments)
    assert told["preview"] == name
    assert name in listing(folder)
    assert Path(name).read_bytes()[:4] == b"\x89PNG"


def test_a_preview_takes_the_exposure_that_is_asked_for():
    told = render(*SMALL, "-o", "a.exr", "--preview", "--preview-ev", "11.5", "--view", "aces1")
    assert told["preview_ev"] == 11.5
    found = render(*SMALL, "-o", "a.exr", "--preview", "b.png", "--preview-ev", "auto")
    assert 10.0 < found["preview_ev"] < 16.0
    assert Path("a.png").read_bytes() != Path("b.png").read_bytes()


def test_a_map_is_shown_later_as_it_would_have_been_at_once():
    told = render(*SMALL, "-o", "a.exr", "--pixel", "float", "--preview", "at_once.png")
    result = invoke("preview", "a.exr", "-o", "later.png", "--ev", told["preview_ev"])
    assert result.exit_code == 0, result.output
    assert result.stdout == f"later.png  exposed for EV {told['preview_ev']:.2f}\n"
    at_once, later = (
        OpenImageIO.ImageBuf(name).get_pixels(OpenImageIO.FLOAT)
        for name in ("at_once.png", "later.png")
    )
    # Dithered eight bits of the same floats.
    assert abs(at_once - later).max() <= 1.01 / 255


def test_options_reach_the_map():
    told = render(
        *("--size", "64x32", "--colorspace", "xyz", "--ev", "3", "--pixel", "float"),
        *("--compression", "zip:9", "--sun-disc", "only", "--clamp-negative"),
        *("--equirect-rows", "poles", "--rotate", "20deg", "--sun-size", "1.5deg"),
        *("--sun-soft", "--sun-strength", "0.5"),
        *("--method", "march", "--altitude", "1km", "-o", "a.exr"),
    )
    recipe = json.loads(read_image(Path("a.exr"))[1]["skybake:recipe"])["map"]
    assert told["white_luminance_cd_m2"] == pytest.approx(9.6)
    assert recipe == {
        "sun_elevation_deg": pytest.approx(30.0),
        "sun_azimuth_deg": 180.0,
        "altitude_m": 1000.0,
        "projection": "equirect",
        "width": 64,
        "cube_layout": None,
        "equirect_rows": "poles",
        "rotate_deg": pytest.approx(20.0),
        "colorspace": "xyz",
        "white_luminance_cd_m2": pytest.approx(9.6),
        "pixel": "float",
        "compression": "zip:9",
        "sun_disc": "only",
        "sun_size_deg": pytest.approx(1.5),
        "sun_soft": True,
        "sun_strength": 0.5,
        "clamp_negative": True,
        "omit_exposure": False,
        "method": "march",
    }


@pytest.mark.parametrize("projection", ["angular", "octahedral"])
def test_a_square_map_is_baked_shown_and_part_of_a_sequence(folder, projection):
    options = ("--projection", projection, "--size", 32, "--method", "hillaire")
    told = render(*options, "-o", "a.hdr", "--omit-exposure", "--preview")
    assert (told["projection"], told["preview"]) == (projection, "a.png")
    attributes = read_image(Path("a.hdr"))[1]
    assert attributes["whiteLuminance"] == pytest.approx(39321.6)
    assert "EXPOSURE" not in attributes
    assert invoke("preview", "a.hdr", "-o", "b.png").exit_code == 0
    made = ("sequence", *options, "--frames", "1-2", "--rotate", "90deg", "-o", "s.#.exr")
    assert invoke(*made, "--contact-sheet", "s.png").exit_code == 0
    assert "0 frames baked, 2 skipped" in invoke(*made, "--skip-existing").stdout
    assert "2 frames baked" in invoke(*made, "--sun-soft", "--skip-existing").stdout


def test_people_are_told_files_and_light_with_units():
    result = invoke("render", *SMALL, "-o", "a.exr", "--preview")
    told = render(*SMALL, "-o", "a.exr")
    file, picture, light = result.stdout.splitlines()
    assert file == "a.exr"
    assert picture.startswith("a.png  exposed for EV 1")
    assert light.startswith(f"sun {told['direct_illuminance_lux']:.5g} lx ")
    assert f"sky {told['sky_illuminance_lux']:.5g} lx" in light
    assert "1.0 = 39321.6 cd/m2" in light
    assert result.stderr == "skybake: baking a.exr\n"


def test_quiet_says_nothing_and_json_nothing_else():
    assert invoke("render", *SMALL, "-o", "a.exr", "--quiet").output == ""
    result = invoke("render", *SMALL, "-o", "a.exr", "--json")
    assert json.loads(result.stdout)["files"] == ["a.exr"]


def test_negative_values_that_a_radiance_picture_loses_are_counted():
    arguments = (*SMALL, "--sun", "-6deg", "--sun-disc", "exclude")
    told = render(*arguments, "-o", "a.hdr")
    whole = render(*arguments, "-o", "a.exr", "--pixel", "float")
    pixels, _ = read_image(Path("a.exr"))
    assert whole["clamped"] == 0
    assert told["clamped"] == (pixels < 0.0).sum()
    clamped = render(*arguments, "-o", "b.exr", "--clamp-negative")
    assert clamped["clamped"] == 0
    assert read_image(Path("b.exr"))[0].min() >= 0.0


def test_a_file_is_replaced(folder):
    render(*SMALL, "-o", "a.exr")
    before = Path("a.exr").read_bytes()
    render(*SMALL, "--sun", "60", "-o", "a.exr")
    assert Path("a.exr").read_bytes() != before
    assert listing(folder) == ["a.exr"]


def test_the_light_from_below_is_told_where_the_ground_is_not_shown(folder):
    result = invoke("render", *SMALL, "--below-horizon", "extend", "-o", "a.exr", "--json", "-q")
    by_map, by_ground = json.loads(result.stdout)["from_below_lux"]
    attributes = read_attributes(folder / "a.exr")
    assert attributes["skybake:illuminanceFromBelow"] == pytest.approx(by_map)
    assert attributes["skybake:groundIlluminanceFromBelow"] == pytest.approx(by_ground)
    assert json.loads(attributes["skybake:recipe"])["map"]["below_horizon"] == "extend"
    shown = invoke("render", *SMALL, "--below-horizon", "black", "-o", "b.exr")
    assert f" lx, instead of {by_ground:.5g} lx by the ground" in shown.stdout
    refused = invoke("render", *SMALL, "--below-horizon", "black", "--sun-disc", "only")
    assert refused.exit_code == 2
    assert "--below-horizon: cannot be combined with --sun-disc only" in refused.stderr
