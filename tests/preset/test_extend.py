"""Presets that extend others, and values that are laid over them."""

import hashlib
import json
from pathlib import Path

import pytest

from skybake.errors import PresetError
from skybake.preset import (
    Aerosol,
    CornetteShanksPhase,
    ExponentialProfile,
    HenyeyGreensteinPhase,
    Override,
    load_preset,
    preset_names,
    resolved_text,
)
from tests.preset.files import MINIMAL


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / f"{name}.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def fault(path, overrides=()):
    with pytest.raises(PresetError) as caught:
        load_preset(path, overrides)
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


def by_name(planet):
    return {one.name: one for one in planet.constituents}


def test_what_is_not_given_is_that_of_the_extended_preset(tmp_path):
    path = write(tmp_path, "own", 'extends = "earth"\nground.albedo = 0.5\n')
    own, earth = load_preset(path), load_preset("earth")
    assert own.name == "own"
    assert (own.title, own.radius) == (earth.title, earth.radius)
    assert own.constituents == earth.constituents
    assert own.ground.albedo.values == (0.5,)


def test_tables_are_merged_key_by_key_and_keep_their_order(tmp_path):
    table = "[constituents.aerosol]\noptical_depth = 0.3\nprofile.scale_height_km = 1"
    text = f'extends = "earth"\n{table}'
    own, earth = (load_preset(one) for one in (write(tmp_path, "own", text), "earth"))
    assert list(by_name(own)) == list(by_name(earth))
    mine, theirs = by_name(own)["aerosol"], by_name(earth)["aerosol"]
    assert (mine.optical_depth, theirs.optical_depth) == (0.3, 0.1)
    assert mine.profile == ExponentialProfile(1.0)
    assert mine.phase == theirs.phase
    assert own.recipe["constituents"]["aerosol"]["profile"] == {
        "kind": "exponential",
        "scale_height_km": 1,
    }


def test_a_table_of_another_kind_replaces_the_former_whole(tmp_path):
    path = write(
        tmp_path,
        "own",
        'extends = "earth"\n'
        'constituents.aerosol.phase = { kind = "cornette-shanks", asymmetry = 0.6 }\n'
        'constituents.air = { kind = "coefficients", scattering_per_km = 0.01, '
        'profile = { kind = "exponential", scale_height_km = 8 }, phase = { kind = "rayleigh" } }',
    )
    own = by_name(load_preset(path))
    assert isinstance(own["aerosol"].phase, CornetteShanksPhase)
    assert own["air"].scattering.values == (0.01,)


def test_a_composition_replaces_the_former_whole():
    air = load_preset("earth", {"air.composition": {"co2": 1.0}}).constituents[0]
    assert air.composition == (("co2", 1.0),)


def test_one_part_of_a_composition_can_be_set():
    gas = load_preset("mars", {"gas.composition.co2": 0.955}).constituents[0]
    assert gas.composition == (("co2", 0.955), ("n2", 0.020), ("ar", 0.021))


def test_the_later_of_two_keys_that_exclude_each_other_holds():
    aerosol = load_preset("earth", {"aerosol.angstrom_exponent": 1.4}).constituents[2]
    assert aerosol.extinction_spectrum == 1.4
    spectrum = "opac_continental_average"
    both = {"aerosol.angstrom_exponent": 1.4, "aerosol.relative_extinction": spectrum}
    aerosol = load_preset("earth", both).constituents[2]
    original = load_preset("earth").constituents[2]
    assert aerosol.extinction_spectrum.values == original.extinction_spectrum.values


def test_none_takes_away_a_constituent_or_a_key(tmp_path):
    text = 'extends = "earth"\nconstituents.ozone = "none"\nstar.limb_darkening_u = "none"'
    own = load_preset(write(tmp_path, "own", text))
    assert list(by_name(own)) == ["air", "aerosol"]
    assert own.star.limb_darkening_u.values == (0.0,)
    assert "ozone" not in own.recipe["constituents"]


def test_none_for_what_is_not_there_is_refused_with_what_is(tmp_path):
    path = write(tmp_path, "own", 'extends = "earth"\nconstituents.smoke = "none"')
    known = "'none' must remove one of air, ozone, aerosol"
    assert fault(path) == f"{path}: constituents.smoke: {known}"


def test_a_file_may_extend_one_that_extends_another(tmp_path):
    write(
        tmp_path, "a", 'extends = "mars"\nconstituents.dust.optical_depth = 2\nground.albedo = 0.1'
    )
    write(tmp_path, "b", 'extends = "a.toml"\nground.albedo = 0.2')
    own = load_preset(write(tmp_path, "sub/c", 'extends = "../b.toml"\ntitle = "C"'))
    assert (own.name, own.title, own.ground.albedo.values) == ("c", "C", (0.2,))
    assert by_name(own)["dust"].optical_depth == 2.0


def test_a_preset_that_leads_back_to_itself_is_refused_with_the_chain(tmp_path):
    for name, base in ("ab", "bc", "cb"):
        write(tmp_path, name, f'extends = "{base}.toml"')
    a, b, c = (tmp_path / f"{name}.toml" for name in "abc")
    chain = f"got {a} -> {b} -> {c} -> {b}"
    assert fault(a) == f"{c}: extends: must not form a cycle, {chain}"
    own = write(tmp_path, "d", 'extends = "./d.toml"')
    assert "must not form a cycle" in fault(own)


@pytest.mark.parametrize(
    ("base", "message"),
    [
        ('"erth"', f"unknown preset 'erth'; known presets: {', '.join(preset_names())}; "),
        ('"erth.toml"', "'erth.toml': cannot be read: No such file or directory"),
        ('"a\\u0000.toml"', "cannot be read: embedded null byte"),
        ("3", "must be a preset's name or a file, got 3"),
    ],
)
def test_what_cannot_be_extended_is_refused_with_what_can(tmp_path, base, message):
    path = write(tmp_path, "own", f"extends = {base}")
    assert fault(path).startswith(f"{path}: extends: ")
    assert message in fault(path)


def test_a_fault_in_the_extended_file_is_named_as_its_own(tmp_path):
    base = write(tmp_path, "base", "title = ")
    assert fault(write(tmp_path, "own", 'extends = "base.toml"')).startswith(f"{base}: not valid")
    base = write(tmp_path, "base", MINIMAL.replace("0.7", "1.7"))
    own = write(tmp_path, "own", 'extends = "base.toml"\nground.albedo = 0.5')
    assert fault(own) == f"{base}: constituents.haze.phase.asymmetry: must be at most 0.9, got 1.7"


def test_a_fault_is_named_where_the_faulty_value_was_written(tmp_path):
    base = write(tmp_path, "base", MINIMAL)
    own = write(tmp_path, "own", 'extends = "base.toml"\nconstituents.haze.optical_depth = -1')
    rule = "constituents.haze.optical_depth: must be at least 0, got -1"
    assert fault(own) == f"{own}: {rule}"
    assert fault(base, {"haze.optical_depth": -1}) == f"overrides: {rule}"
    assert fault(base, [Override("haze.optical_depth", -1, "--set")]) == f"--set: {rule}"


def test_two_values_that_do_not_go_together_are_named_both():
    message = fault("earth", [Override("planet.atmosphere_top_km", 300, "--set")])
    assert message.startswith("earth.toml: constituents.air.profile: must cover 0 to 300 km ")
    assert "(see --set: planet.atmosphere_top_km)" in message
    message = fault("earth", [Override("star.distance_au", 0.001, "--set")])
    assert message.startswith(
        "earth.toml: star.radius_km: must be less than the distance, 149598 km"
    )
    assert message.endswith("(see --set: star.distance_au)")


def test_tables_are_found_beside_the_file_that_names_them(tmp_path):
    (tmp_path / "base").mkdir()
    sand = tmp_path / "base" / "sand.csv"
    sand.write_text("wavelength_nm,albedo\n380,0.2\n800,0.5\n", encoding="utf-8")
    write(tmp_path, "base/base", MINIMAL.replace("albedo = 0.2", 'albedo = "sand.csv"'))
    own = load_preset(write(tmp_path, "own", 'extends = "base/base.toml"'))
    assert own.ground.albedo.values == (0.2, 0.5)
    digest = hashlib.sha256(sand.read_bytes()).hexdigest()
    assert own.recipe["ground"]["albedo"] == str(sand.resolve())
    assert own.recipe["files"] == {str(sand.resolve()): digest}


def test_tables_that_are_set_are_found_from_the_current_folder(tmp_path, monkeypatch):
    sand = tmp_path / "sand.csv"
    sand.write_text("wavelength_nm,albedo\n380,0.2\n800,0.5\n", encoding="utf-8")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    planet = load_preset("earth", {"ground.albedo": "../sand.csv"})
    assert planet.ground.albedo.values == (0.2, 0.5)
    assert planet.recipe["ground"]["albedo"] == str(sand.resolve())


def test_tables_elsewhere_are_read_by_their_absolute_path_only(tmp_path):
    sand = tmp_path / "sand.csv"
    sand.write_text("wavelength_nm,albedo\n380,0.2\n800,0.5\n", encoding="utf-8")
    text = 'extends = "earth"\nground.albedo = "{}"'
    assert load_preset(write(tmp_path, "in/own", text.format(sand))).ground.albedo.values[0] == 0.2
    path = write(tmp_path, "in/own", text.format("../sand.csv"))
    assert "must be in the preset's folder or an absolute path" in fault(path)


def test_overrides_are_laid_by_dotted_keys_with_or_without_the_prefix_of_constituents():
    changed = {"aerosol.optical_depth": 0.3, "constituents.ozone.column_du": 250}
    planet = load_preset("earth", {**changed, "ground.albedo": "mars_arabia", "title": "Mine"})
    aerosol = by_name(planet)["aerosol"]
    assert isinstance(aerosol, Aerosol)
    assert aerosol.optical_depth == 0.3
    assert planet.recipe["constituents"]["ozone"]["column_du"] == 250
    assert planet.title == "Mine"
    assert json.loads(json.dumps(planet.recipe))["set"] == {
        "constituents.aerosol.optical_depth": 0.3,
        "constituents.ozone.column_du": 250,
        "ground.albedo": "mars_arabia",
        "title": "Mine",
    }
    assert "set" not in load_preset("earth").recipe


def test_a_constituent_can_be_set_whole():
    smoke = {
        "kind": "coefficients",
        "absorption_per_km": 0.1,
        "profile": {"kind": "exponential", "scale_height_km": 1.0},
    }
    planet = load_preset("earth", {"constituents.smoke": smoke, "smoke.absorption_per_km": 0.2})
    assert by_name(planet)["smoke"].absorption.values == (0.2,)
    assert isinstance(by_name(planet)["smoke"].phase, HenyeyGreensteinPhase)
    assert smoke["absorption_per_km"] == 0.1


@pytest.mark.parametrize(
    ("key", "message"),
    [
        (
            "arosol.optical_depth",
            "'arosol.optical_depth': unknown key; nearest: aerosol.optical_depth",
        ),
        ("aersol", "'aersol': unknown key; nearest: aerosol"),
        ("x", "'x': unknown key; keys start with: air, ozone, aerosol, title, data_quality, "),
        ("", "'': unknown key; keys start with: "),
        ("ground.al bedo", "'ground.al bedo': unknown key; nearest: ground.albedo"),
        ("constituents.aersol.kin", "unknown key; nearest: aerosol.kind"),
        (
            "aerosol.optcal_depth",
            "constituents.aerosol: unknown key 'optcal_depth', nearest: optical_depth, ",
        ),
        ("planet.radius", "planet: unknown key 'radius', nearest: radius_km; known keys: "),
        ("ground.albedo.x", "ground.albedo.wavelength_nm: must be given"),
        ("ground." + "a." * 5000 + "a", "ground.a: tables must be nested at most 8 deep"),
    ],
)
def test_an_unknown_key_of_an_override_is_refused_with_the_nearest(key, message):
    assert message in fault("earth", {key: 0.3})


@pytest.mark.parametrize("name", preset_names())
def test_a_resolved_preset_makes_the_same_planet(tmp_path, name):
    path = write(tmp_path, name, resolved_text(name))
    own, original = load_preset(path), load_preset(name)
    assert own.recipe == original.recipe
    assert [one.name for one in own.constituents] == [one.name for one in original.constituents]


def test_a_resolved_preset_says_where_each_value_is_from(tmp_path):
    path = write(tmp_path, "own", 'extends = "earth"\nground.albedo = 0.5')
    lines = resolved_text(path, [Override("ozone.column_du", 250, "--set")]).splitlines()
    assert "albedo = 0.5" in lines
    assert "column_du = 250 # --set" in lines
    assert "pressure_pa = 101325.0 # earth.toml" in lines
    assert not any(line.startswith("extends") for line in lines)
