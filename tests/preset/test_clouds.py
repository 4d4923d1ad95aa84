"""Layers of clouds in presets."""

import math
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from skybake.errors import PresetError, PresetWarning
from skybake.optics.changes import PresetChanges
from skybake.preset import (
    DoubleHenyeyGreensteinPhase,
    HenyeyGreensteinPhase,
    TabulatedPhase,
    load_preset,
    preset_template,
    resolved_text,
)
from skybake.preset.cloud_kinds import DEFAULTS
from skybake.preset.clouds_model import KINDS
from tests.preset.files import CUMULUS, message_about, only_layer, write


def test_a_world_without_the_table_has_no_clouds_and_a_recipe_as_ever(tmp_path):
    planet = load_preset(write(tmp_path))
    assert planet.clouds == ()
    assert "clouds" not in planet.recipe


def test_a_world_without_clouds_imports_nothing_of_them():
    code = (
        "import sys; from skybake.preset import load_preset; load_preset('earth');"
        "sys.exit(bool({'skybake.preset.clouds', 'zipfile'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("kind", KINDS[:-1])
def test_what_is_not_given_is_usual_for_the_kind(tmp_path, kind):
    usual = DEFAULTS[kind]
    found = only_layer(tmp_path, text=CUMULUS.replace("cumulus", kind))
    assert (found.name, found.kind, found.tile) == ("low", kind, None)
    assert (found.base, found.depth, found.size) == (usual.base, usual.depth, usual.size)
    assert (found.cover, found.optical_depth) == (usual.cover, usual.optical_depth)
    assert found.wind_speed == pytest.approx(usual.wind * 1e-3)
    assert found.wind_from == pytest.approx(1.5 * math.pi)
    assert isinstance(found.phase, TabulatedPhase)


def test_all_that_is_given_is_in_the_layer(tmp_path):
    found = only_layer(
        tmp_path,
        "base_km = 2\ndepth_km = 0.5\nsize_km = 3\ncover = 0.25\noptical_depth = 7\n"
        "seed = 11\nwind_m_s = [10.0, -90.0]",
    )
    assert (found.base, found.depth, found.size, found.cover) == (2.0, 0.5, 3.0, 0.25)
    assert (found.optical_depth, found.seed) == (7.0, 11)
    assert found.wind_speed == 0.01
    assert found.wind_from == pytest.approx(1.5 * math.pi)


@pytest.mark.parametrize(
    ("cover", "share"),
    [
        *(('"3okta"', 3 / 8), ('"8 oktas"', 1.0), ('"3/8"', 3 / 8), ('"40%"', 0.4)),
        *(('"0.2"', 0.2), ("0", 0.0), ("1", 1.0), ('"0okta"', 0.0)),
    ],
)
def test_cover_is_a_share_or_oktas(tmp_path, cover, share):
    assert only_layer(tmp_path, f"cover = {cover}").cover == pytest.approx(share)


def test_oktas_are_no_file_for_the_recipe(tmp_path):
    planet = load_preset(write(tmp_path, new=f'{CUMULUS}cover = "3/8"\n'))
    assert planet.recipe["clouds"]["low"]["cover"] == "3/8"
    assert "files" not in planet.recipe


def test_the_optical_depth_follows_from_water_and_droplets(tmp_path):
    found = only_layer(tmp_path, "liquid_water_path_g_m2 = 100\neffective_radius_um = 7.5")
    assert found.optical_depth == pytest.approx(1.5 * 0.1 / (1000 * 7.5e-6))


def test_a_table_as_of_a_constituent_is_a_phase_function_that_may_be_sharper(tmp_path):
    sharp = 'phase = { kind = "henyey-greenstein", asymmetry = 0.95 }'
    phase = only_layer(tmp_path, sharp).phase
    assert isinstance(phase, HenyeyGreensteinPhase)
    assert phase.asymmetry.values == (0.95,)
    double = (
        'phase = { kind = "double-henyey-greenstein", first_asymmetry = 0.9, '
        "second_asymmetry = -0.2, first_fraction = 0.8 }"
    )
    assert isinstance(only_layer(tmp_path, double).phase, DoubleHenyeyGreensteinPhase)
    message = message_about(write(tmp_path, new=f"{CUMULUS}{sharp.replace('0.95', '0.96')}\n"))
    assert message == "clouds.low.phase.asymmetry: must be at most 0.95, got 0.96"


FAULTS = [
    ("cover = 1.2", "cover: must be at most 1, got 1.2"),
    ("cover = -0.1", "cover: must be at least 0, got -0.1"),
    ("cover = nan", "cover: must be at least 0, got nan"),
    ('cover = "nan"', "cover: must be from 0 to 1, or 8okta, got 'nan'"),
    ('cover = "9okta"', "cover: must be a share such as 0.4, '3okta' or '3/8', got '9okta'"),
    ('cover = "140%"', "cover: must be from 0 to 1, or 8okta, got '140%'"),
    ("cover = true", "cover: must be a number, got True"),
    ("base_km = -0.1", "base_km: must be at least 0, got -0.1"),
    ("depth_km = -1", "depth_km: must be at least 0.001, got -1"),
    ("depth_km = 0", "depth_km: must be at least 0.001, got 0"),
    ("size_km = 0", "size_km: must be at least 0.01, got 0"),
    ("base_km = 49.5", "base_km: the clouds must end below the atmosphere's top at 50 km, got "),
    (
        "optical_depth = 301",
        "optical_depth: must give an optical depth of at most 300, the limit of the transport "
        "through clouds, got 301",
    ),
    (
        "liquid_water_path_g_m2 = 4000",
        "liquid_water_path_g_m2: must give an optical depth of at most 300, the limit of the "
        "transport through clouds, got 600",
    ),
    ("optical_depth = -1", "optical_depth: must be at least 0.001, got -1"),
    (
        "optical_depth = 3\nliquid_water_path_g_m2 = 50",
        ": must give either optical_depth or liquid_water_path_g_m2",
    ),
    (
        'phase = "ice"\nliquid_water_path_g_m2 = 50',
        "liquid_water_path_g_m2: needs droplets: phase = 'water', or effective_radius_um beside",
    ),
    ("effective_radius_um = 4", "effective_radius_um: must be at least 5, got 4"),
    ("effective_radius_um = 21", "effective_radius_um: must be at most 20, got 21"),
    ('phase = "fog"', "phase: must be one of water, ice, co2_ice, or a table, got 'fog'"),
    ("phase = 3", "phase: must be one of water, ice, co2_ice, or a table, got 3"),
    ("phase = [1]", "phase: must be one of water, ice, co2_ice, or a table, got [1]"),
    ('phase = { kind = "mie" }', "phase.kind: must be one of rayleigh, "),
    ("seed = -1", "seed: must be a whole number from 0 to 4294967295, got -1"),
    ("seed = 1.5", "seed: must be a whole number from 0 to 4294967295, got 1.5"),
    ("seed = true", "seed: must be a whole number from 0 to 4294967295, got True"),
    ("wind_m_s = 8", "wind_m_s: must be an array of numbers, got 8"),
    ("wind_m_s = [8]", "wind_m_s: must be two numbers, got 1"),
    ("wind_m_s = [-8, 0]", "wind_m_s: must be from 0 to 1000, got -8"),
    ("wind_m_s = [8, 400]", "wind_m_s: must be from -360 to 360, got 400"),
    ("covr = 0.3", ": unknown key 'covr', nearest: cover; known keys: base_km, cover, "),
    ('phase = "ice"\neffective_radius_um = 9', ": unknown key 'effective_radius_um'; known keys: "),
    ('tile = "a.npz"', ": must give either kind or tile"),
]


@pytest.mark.parametrize(("lines", "message"), FAULTS)
def test_a_broken_rule_is_named_in_one_line_with_its_place(tmp_path, lines, message):
    dot = "" if message.startswith(":") else "."
    found = message_about(write(tmp_path, new=f"{CUMULUS}{lines}\n"))
    assert found.startswith(f"clouds.low{dot}{message}")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("clouds = 3", "clouds: must be a table, got 3"),
        ("[clouds]\nlow = 3", "clouds.low: must be a table, got 3"),
        ('[clouds."a b"]\nkind = "stratus"', "clouds: names must consist of letters"),
        ("[clouds.low]\ncover = 0.3", "clouds.low: must give either kind or tile"),
        (
            '[clouds.low]\nkind = "fog"',
            "clouds.low.kind: must be one of stratus, stratocumulus, cumulus, altocumulus, cirrus",
        ),
        ('[clouds.low]\nkind = "tile"', "clouds.low.kind: must be one of stratus, "),
        (
            "".join(f'[clouds.c{i}]\nkind = "cirrus"\nbase_km = {2 * i}\n' for i in range(9)),
            "clouds: must be at most 8 layers, got 9",
        ),
    ],
)
def test_a_broken_table_is_named_in_one_line_with_its_place(tmp_path, text, message):
    path = write(tmp_path, old='title = "A ball', new=f'{text}\ntitle = "A ball')
    if text.startswith("["):
        path = write(tmp_path, new=f"\n{text}\n")
    assert message_about(path).startswith(message)


def test_all_faults_of_a_layer_are_reported_and_none_follows_from_another(tmp_path):
    path = write(tmp_path, new=f'{CUMULUS}cover = 2\nphase = "fog"\nliquid_water_path_g_m2 = 9\n')
    with pytest.raises(PresetError) as caught:
        load_preset(path)
    keys = [fault.split(": ")[1] for fault in caught.value.faults]
    assert keys == ["clouds.low.cover", "clouds.low.phase"]


def test_layers_that_overlap_are_taken_with_one_note():
    high, low = {"kind": "stratus", "base_km": 1.3}, {"kind": "cumulus", "base_km": 1.2}
    with pytest.warns(PresetWarning, match=r"clouds\.a: begins at 1\.3 km, within ") as notes:
        planet = load_preset("earth", {"clouds.a": high, "clouds.b": low})
    assert len(notes) == 1
    assert [one.name for one in planet.clouds] == ["a", "b"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_preset("earth", {"clouds.a": high | {"base_km": 2.1}, "clouds.b": low})


def test_a_preset_changes_and_removes_layers_of_the_one_that_it_extends(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text(
        'extends = "earth-fair"\n[clouds.low]\ncover = 0.1\n[clouds.high]\nkind = "cirrus"\n'
    )
    low, high = load_preset(path).clouds
    assert (low.cover, low.base, high.kind) == (0.1, 1.2, "cirrus")
    path.write_text('extends = "earth-fair"\nclouds.low = "none"\n')
    assert load_preset(path).clouds == ()


def test_water_takes_the_place_of_an_inherited_optical_depth():
    changed = {"clouds.low.liquid_water_path_g_m2": 80}
    (low,) = load_preset("earth-fair", changed).clouds
    assert low.optical_depth == pytest.approx(1.5 * 0.08 / (1000 * 8e-6))


def test_another_kind_takes_the_place_of_the_whole_layer(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text('extends = "earth-fair"\n[clouds.low]\nkind = "stratus"\n')
    (low,) = load_preset(path).clouds
    assert (low.kind, low.base) == ("stratus", 0.6)


def test_a_layer_may_be_named_tile(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text('extends = "earth-fair"\n[clouds.tile]\nkind = "cirrus"\n')
    assert [one.name for one in load_preset(path).clouds] == ["low", "tile"]


def test_a_key_of_a_layer_that_is_not_there_is_refused():
    with pytest.raises(PresetError, match=r"'clouds\.lwo\.cover': unknown key; nearest: clouds"):
        load_preset("earth-fair", {"clouds.lwo.cover": 0.3})


def test_layers_that_are_added_are_named_after_their_kind_and_change_nothing_else():
    changes = PresetChanges(
        (("clouds.cirrus-2.cover", 0.1),), clouds=({"kind": "cirrus"}, {"kind": "cirrus"})
    )
    with pytest.warns(PresetWarning, match="begins at"):
        planet = changes.load("earth")
    assert [(one.name, one.cover) for one in planet.clouds] == [("cirrus", 0.4), ("cirrus-2", 0.1)]
    assert planet.constituents == load_preset("earth").constituents


def test_a_world_may_be_cleared_of_clouds_whether_it_has_any_or_not():
    clear = PresetChanges(keep_clouds=False)
    assert clear.load("earth-fair").clouds == ()
    earth = clear.load("earth")
    assert earth.recipe == load_preset("earth").recipe
    other = PresetChanges(keep_clouds=False, clouds=({"kind": "cirrus"},)).load("earth-fair")
    assert [one.name for one in other.clouds] == ["cirrus"]


def test_what_is_resolved_loads_as_the_same_world(tmp_path):
    path = tmp_path / "earth-fair.toml"
    path.write_text(resolved_text("earth-fair"), encoding="utf-8")
    assert "[clouds.low]" in path.read_text("utf-8")
    copy, original = load_preset(path), load_preset("earth-fair")
    assert copy.recipe == original.recipe
    assert copy.clouds[0].phase.values == original.clouds[0].phase.values


def test_a_template_lists_the_layers():
    assert '[clouds.low]\n# kind = "cumulus"' in preset_template("own", "earth-fair")


def test_a_preset_that_covers_more_than_the_droplets_tables_is_refused(tmp_path):
    more = "wavelengths_nm = [340, 550, 680]\ntitle"
    path = write(tmp_path, old="title", new=more)
    path.write_text(path.read_text("utf-8") + CUMULUS, "utf-8")
    assert message_about(path) == ("clouds.low.phase: must cover 340 to 680 nm, got 360 to 830 nm")


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("earth-fair", "cumulus"),
        ("earth-broken", "stratocumulus"),
        ("earth-overcast", "stratus"),
        ("earth-cirrus", "cirrus"),
        ("mars-ice-clouds", "cirrus"),
    ],
)
def test_cloudy_presets_have_the_air_of_what_they_extend(name, kind):
    planet = load_preset(name)
    assert [one.kind for one in planet.clouds] == [kind]
    base = "mars-clear" if name.startswith("mars") else "earth"
    assert planet.constituents == load_preset(base).constituents
    assert Path(f"{planet.name}.toml").stem == name
