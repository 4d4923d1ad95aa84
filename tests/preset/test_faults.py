import shutil
from pathlib import Path

import pytest

from skybake.errors import PresetError
from skybake.preset import (
    load_preset,
    preset_names,
)
from tests.preset.files import GAS, MINIMAL, PHASE, message_about, write


def listed_faults() -> list[list[str]]:
    lines = (Path(__file__).parent / "faults.txt").read_text(encoding="utf-8").splitlines()
    return [
        [part.replace("\\n", "\n").replace("\\\n", "\\n").strip(" ") for part in line.split("=>")]
        for line in lines
        if not line.startswith("#")
    ]


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
            "composition: unknown key 'xenon'; known keys: ar, ",
        ),
        ("210.0", "0", "temperature_k: must be at least 1, got 0"),
        ("610.0", "-1", "pressure_pa: must be at least 0, got -1"),
    ],
)
def test_a_broken_rule_of_gases_is_named_in_one_line_with_its_place(tmp_path, old, new, message):
    path = write(tmp_path, new=GAS.replace(old, new))
    assert message_about(path).startswith(f"constituents.gas.{message}")


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
        ("wavelength_nm,albedo\n400,0.1\n400,0.2\n", "must ascend, got 400 nm after 400 nm"),
        ("wavelength_nm,albedo\n380,0.1\n700,0.2\n", "must cover 380 to 720 nm, got 380 to 700 nm"),
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
    with pytest.raises(PresetError, match="constituents: must be at most 16, got 17"):
        load_preset(write(tmp_path, new=more))


def test_what_is_no_text_file_is_refused_in_one_line(tmp_path):
    latin = tmp_path / "latin.toml"
    latin.write_bytes(b'title = "M\xe4rz"')
    with pytest.raises(PresetError, match=r"latin\.toml: must be UTF-8 text$"):
        load_preset(latin)
    with pytest.raises(PresetError, match=r"must be a regular file, got a folder$"):
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
    with pytest.raises(PresetError, match=r"^ball\.toml: title: must be a line of text, got 3 "):
        load_preset("ball")
    shutil.rmtree(package)


def test_all_faults_of_a_preset_are_told_at_once(tmp_path):
    text = MINIMAL.replace("radius_km = 1000.0", "radius_km = -1").replace("0.2", "1.5")
    text = text.replace("0.9", "1.1").replace("5.0", "0").replace("asymmetry", "symmetry")
    path = write(tmp_path, text=text + "colour = 1\n")
    with pytest.raises(PresetError) as caught:
        load_preset(path)
    assert [fault.removeprefix(f"{path}: ").partition(":")[0] for fault in caught.value.faults] == [
        "planet.radius_km",
        "ground.albedo",
        "constituents.haze.profile.scale_height_km",
        "constituents.haze.single_scattering_albedo",
        "constituents.haze.phase.asymmetry",
        "constituents.haze.phase",
        "constituents.haze",
    ]
    assert str(caught.value).endswith("(and 6 more, see 'skybake presets check')")
    assert len(str(caught.value).splitlines()) == 1
