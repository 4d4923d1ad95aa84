import hashlib
import json
import math
import shutil
from pathlib import Path

import pytest

from skybake.errors import PresetError
from skybake.preset import (
    Aerosol,
    Coefficients,
    Gas,
    TabulatedPhase,
    TabulatedProfile,
    load_preset,
    preset_names,
    preset_text,
)

MINIMAL = """
title = "A ball in thin haze"
[planet]
radius_km = 1000.0
atmosphere_top_km = 50.0
[star]
radius_km = 700000.0
distance_au = 1.0
irradiance_w_m2_nm = 1.5
[ground]
albedo = 0.2
[constituents.haze]
kind = "aerosol"
optical_depth = 0.3
optical_depth_wavelength_nm = 550.0
angstrom_exponent = 1.3
single_scattering_albedo = 0.9
profile = { kind = "exponential", scale_height_km = 5.0 }
phase = { kind = "henyey-greenstein", asymmetry = 0.7 }
"""


def write(folder: Path, old: str = "", new: str = "", text: str = MINIMAL) -> Path:
    assert old in text
    path = folder / "ball.toml"
    path.write_text(text.replace(old, new, 1) if old else text + new, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", preset_names())
def test_every_preset_loads_and_says_what_it_is(name):
    planet = load_preset(name)
    assert planet.name == name
    assert planet.title
    assert planet.constituents


def test_the_recipe_of_every_preset_is_its_toml_and_survives_json():
    for name in preset_names():
        planet = load_preset(name)
        assert json.loads(json.dumps(planet.recipe)) == planet.recipe
        assert planet.recipe["planet"]["radius_km"] == planet.radius


def test_a_preset_of_skybake_can_be_copied_and_loads_the_same_from_the_users_folder(tmp_path):
    path = tmp_path / "earth.toml"
    path.write_text(preset_text("earth"), encoding="utf-8")
    copy, original = load_preset(path), load_preset("earth")
    assert copy.radius == original.radius
    assert [c.name for c in copy.constituents] == ["air", "ozone", "aerosol"]
    assert copy.recipe == original.recipe


def test_a_text_with_the_ending_toml_is_a_path(tmp_path, monkeypatch):
    write(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert load_preset("ball.toml") == load_preset("./ball.toml")
    assert load_preset("ball.toml").name == "ball"


def test_a_minimal_preset_gets_a_uniform_disc_and_spectral_rendering(tmp_path):
    planet = load_preset(write(tmp_path))
    assert planet.rendering == "spectral"
    assert planet.wavelengths is None
    assert planet.star.limb_darkening_u.values == (0.0,)


def test_angular_radius_of_the_sun_is_16_arcmin_from_earth_and_two_thirds_from_mars():
    # Sixteen arcminutes: 959.63 arcsec, Auwers (1891), still the value of almanacs.
    earth, mars = load_preset("earth").star, load_preset("mars").star
    assert math.degrees(earth.angular_radius) * 3600 == pytest.approx(959.63, rel=1e-3)
    assert mars.angular_radius == pytest.approx(earth.angular_radius / 1.5237, rel=1e-5)
    assert mars.dilution == pytest.approx(1.5237**-2, rel=1e-12)


def test_hillaires_earth_keeps_the_order_of_its_wavelengths_for_red_green_and_blue():
    planet = load_preset("earth-hillaire2020")
    assert planet.rendering == "rgb"
    assert planet.wavelengths == (680.0, 550.0, 440.0)


def test_a_gas_that_follows_a_table_is_dense_as_given_at_the_ground():
    air = load_preset("earth").constituents[0]
    assert isinstance(air, Gas)
    assert isinstance(air.profile, TabulatedProfile)
    assert air.profile.density[0] == 1.0


def test_an_inline_spectrum_may_run_either_way(tmp_path):
    inline = "albedo = { wavelength_nm = [700.0, 400.0], values = [0.7, 0.4] }"
    albedo = load_preset(write(tmp_path, "albedo = 0.2", inline)).ground.albedo
    assert albedo.wavelength == (400.0, 700.0)
    assert albedo.values == (0.4, 0.7)


def test_coefficients_that_do_not_scatter_need_no_phase_function(tmp_path):
    more = """
[constituents.smoke]
kind = "coefficients"
absorption_per_km = 0.1
profile = { kind = "tent", center_km = 5.0, half_width_km = 2.0 }
"""
    smoke = load_preset(write(tmp_path, new=more)).constituents[1]
    assert isinstance(smoke, Coefficients)
    assert smoke.scattering.values == (0.0,)


def test_tables_of_the_user_are_found_beside_the_preset_and_named_by_digest(tmp_path):
    (tmp_path / "albedo").mkdir()
    sand = tmp_path / "albedo" / "sand.csv"
    sand.write_text("\ufeff# seen\nwavelength_nm,albedo\n400,0.2\n800,0.5\n", encoding="utf-8")
    grains = tmp_path / "grains.csv"
    grains.write_text("angle_deg,550\n0,1\n90,0.04\n180,0.05\n", encoding="utf-8")
    path = write(tmp_path, "albedo = 0.2", 'albedo = "albedo/sand.csv"')
    text = path.read_text(encoding="utf-8")
    old = '{ kind = "henyey-greenstein", asymmetry = 0.7 }'
    planet = load_preset(
        write(tmp_path, old, '{ kind = "tabulated", table = "grains.csv" }', text=text)
    )
    assert planet.ground.albedo.values == (0.2, 0.5)
    haze = planet.constituents[0]
    assert isinstance(haze, Aerosol)
    assert isinstance(haze.phase, TabulatedPhase)
    assert haze.phase.wavelength == ()
    assert planet.recipe["files"] == {
        "albedo/sand.csv": hashlib.sha256(sand.read_bytes()).hexdigest(),
        "grains.csv": hashlib.sha256(grains.read_bytes()).hexdigest(),
    }


PHASE = '{ kind = "henyey-greenstein", asymmetry = 0.7 }'
GAS = """
[constituents.gas]
kind = "gas"
pressure_pa = 610.0
temperature_k = 210.0
composition = { co2 = 1.0 }
profile = { kind = "exponential", scale_height_km = 11.0 }
"""


def listed_faults() -> list[list[str]]:
    lines = (Path(__file__).parent / "faults.txt").read_text(encoding="utf-8").splitlines()
    return [
        [part.replace("\\n", "\n").replace("\\\n", "\\n").strip(" ") for part in line.split("=>")]
        for line in lines
        if not line.startswith("#")
    ]


def message_about(path: Path) -> str:
    with pytest.raises(PresetError) as caught:
        load_preset(path)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    assert message.startswith(f"{path}: ")
    return message.removeprefix(f"{path}: ")


@pytest.mark.parametrize(("old", "new", "message"), listed_faults())
def test_a_broken_rule_is_named_in_one_line_with_its_place(tmp_path, old, new, message):
    assert message_about(write(tmp_path, old, new)).startswith(message)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "co2 = 1.0",
            "co2 = 0.5",
            "composition: mole fractions must add up to 1 within 0.01, got 0.5",
        ),
        (
            "co2 = 1.0",
            "xenon = 1",
            "composition: unknown key 'xenon'; known keys: ar, ch4, co2, dry_air, h2, he, n2",
        ),
        ("210.0", "0", "temperature_k: must be at least 1, got 0"),
        ("610.0", "-1", "pressure_pa: must be at least 0, got -1"),
    ],
)
def test_a_broken_rule_of_gases_is_named_in_one_line_with_its_place(tmp_path, old, new, message):
    path = write(tmp_path, new=GAS.replace(old, new))
    assert message_about(path) == f"constituents.gas.{message}"


def test_a_gas_that_is_absent_at_the_ground_is_refused(tmp_path):
    profile = '{ kind = "tabulated", altitude_km = [0, 5, 50], density = [0, 1, 0] }'
    gas = GAS.replace('{ kind = "exponential", scale_height_km = 11.0 }', profile)
    message = message_about(write(tmp_path, new=gas))
    assert message == "constituents.gas.profile: must have gas at the ground"


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (f"0x{'f' * 9000}", "star.distance_au: must be at most 100000, got an integer of "),
        ("9" * 5000, "not valid TOML: "),
        ("[" * 99_999, "not valid TOML: "),
        (f'"{"x" * 500}"', f"star.distance_au: must be a number, got '{'x' * 59}..."),
    ],
)
def test_a_value_of_absurd_size_is_refused_in_one_line(tmp_path, value, message):
    path = write(tmp_path, "distance_au = 1.0", f"distance_au = {value}")
    assert message_about(path).startswith(message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "must have a line of column names and a line of numbers"),
        ("wavelength_nm,albedo\n", "must have a line of column names and a line of numbers"),
        ("wavelength_nm,albedo\n400,x\n", "a line must be 2 finite numbers, got '400,x'"),
        ("wavelength_nm,albedo\n400\n", "a line must be 2 finite numbers, got '400'"),
        ("wavelength_nm,albedo\n400,nan\n", "a line must be 2 finite numbers, got '400,nan'"),
        ("albedo,albedo\n400,1\n", "column names must differ, got 'albedo,albedo'"),
        ("nm,albedo\n400,1\n", "must have columns wavelength_nm and albedo, got nm, albedo"),
        ("wavelength_nm,albedo\n400,2\n", "ground.albedo: must be at most 1, got 2.0"),
        ("wavelength_nm,albedo\n400,0.1\n400,0.2\n", "wavelengths must differ from each other"),
    ],
)
def test_a_broken_table_of_the_user_is_named_in_one_line(tmp_path, text, message):
    (tmp_path / "sand.csv").write_text(text, encoding="utf-8")
    path = write(tmp_path, "albedo = 0.2", 'albedo = "sand.csv"')
    assert message_about(path).startswith("ground.albedo: ")
    assert message_about(path).endswith(message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("angle_deg,550\n0,1\n90,1\n", "column angle_deg must run from 0 to 180"),
        ("angle_deg,550\n0,1\n90,1\n80,1\n180,1\n", "angle_deg must ascend"),
        ("angle_deg,550\n0,1\n180,0\n", "values must be greater than 0"),
        (
            "angle_deg,green\n0,1\n180,1\n",
            "columns must be named by their wavelength in nm, got 'green'",
        ),
        ("angle_deg\n0\n180\n", "must have a column of values beside angle_deg"),
        ("angle_deg,550,550.0\n0,1,1\n180,1,1\n", "wavelengths must differ from each other"),
    ],
)
def test_a_broken_phase_table_of_the_user_is_named_in_one_line(tmp_path, text, message):
    (tmp_path / "grains.csv").write_text(text, encoding="utf-8")
    path = write(tmp_path, PHASE, '{ kind = "tabulated", table = "grains.csv" }')
    assert message_about(path) == f"constituents.haze.phase.table: {message}"


def test_more_constituents_than_kernels_hold_are_refused(tmp_path):
    more = "\n".join(GAS.replace("constituents.gas", f"constituents.gas{i}") for i in range(16))
    with pytest.raises(PresetError, match="constituents: must be 1 to 16, got 17"):
        load_preset(write(tmp_path, new=more))


def test_what_is_no_text_file_is_refused_in_one_line(tmp_path):
    latin = tmp_path / "latin.toml"
    latin.write_bytes(b'title = "M\xe4rz"')
    with pytest.raises(PresetError, match=r"latin\.toml: must be UTF-8 text$"):
        load_preset(latin)
    with pytest.raises(PresetError, match=r"cannot be read: Is a directory$"):
        load_preset(tmp_path)
    with pytest.raises(PresetError, match="cannot be read: embedded null byte"):
        load_preset("nul\0.toml")


def test_a_table_reference_that_no_path_can_hold_is_refused_in_one_line(tmp_path):
    path = write(tmp_path, "albedo = 0.2", 'albedo = "nul\\u0000.csv"')
    with pytest.raises(PresetError, match="cannot be read: embedded null byte"):
        load_preset(path)


def test_an_unknown_preset_lists_the_known_ones():
    with pytest.raises(PresetError) as caught:
        load_preset("erth")
    assert str(caught.value).startswith("unknown preset 'erth'; known presets: ")
    for name in preset_names():
        assert name in str(caught.value)


def test_a_fault_in_a_preset_of_skybake_is_named_without_its_folder(tmp_path, monkeypatch):
    package = tmp_path / "skybake"
    (package / "presets").mkdir(parents=True)
    (package / "presets" / "ball.toml").write_text("title = 3", encoding="utf-8")
    monkeypatch.setattr("skybake.preset.find._PACKAGE", package)
    with pytest.raises(PresetError, match=r"^ball\.toml: title: must be a line of text, got 3$"):
        load_preset("ball")
    shutil.rmtree(package)


def test_the_example_of_the_documentation_loads(tmp_path):
    document = Path(__file__).resolve().parents[2] / "docs" / "presets.md"
    example = document.read_text(encoding="utf-8").split("```toml\n")[1].split("```")[0]
    planet = load_preset(write(tmp_path, text=example))
    assert [constituent.name for constituent in planet.constituents] == ["air", "dust"]
