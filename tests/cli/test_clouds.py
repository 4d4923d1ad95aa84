"""Clouds from the command line."""

import json

import numpy as np
import pytest

from skybake.commands.options import values
from skybake.commands.options.clouds import absolute_layer, clouds_layer
from skybake.image.settings import CLOUD_QUALITIES, Clouds, MapSettings, map_settings
from skybake.preset import load_preset
from tests.cli.runs import invoke

TABLES = {
    "cumulus": {"kind": "cumulus"},
    "cumulus:0.4": {"kind": "cumulus", "cover": 0.4},
    "cumulus : 3/8": {"kind": "cumulus", "cover": "3/8"},
    "stratus:8okta,base=600m,tau=20,seed=3": {
        "kind": "stratus",
        "cover": "8okta",
        "base_km": 0.6,
        "optical_depth": 20.0,
        "seed": 3,
    },
    "altocumulus,depth=200m,size=0.5km,cover=40%": {
        "kind": "altocumulus",
        "depth_km": 0.2,
        "size_km": 0.5,
        "cover": "40%",
    },
    "stratocumulus, lwp=0.1kg/m2, reff=10um": {
        "kind": "stratocumulus",
        "liquid_water_path_g_m2": 100.0,
        "effective_radius_um": 10.0,
    },
    "cirrus,phase=ice,wind=8m/s@270deg": {
        "kind": "cirrus",
        "phase": "ice",
        "wind_m_s": [8.0, 270.0],
    },
    "tile=a b/cloud.npz,base=1km,interpolation=linear,origin=1km:-500m": {
        "tile": "a b/cloud.npz",
        "base_km": 1.0,
        "interpolation": "linear",
        "origin_km": [1.0, -0.5],
    },
    "none": "none",
}


@pytest.mark.parametrize(("text", "table"), TABLES.items())
def test_a_layer_is_a_table_of_a_preset(text, table):
    assert clouds_layer(text) == table


@pytest.mark.parametrize("speed", ["36km/h", "10m/s", "10", "19.438444924406048kn"])
def test_the_wind_has_a_unit(speed):
    table = clouds_layer(f"cirrus,wind={speed}@1rad")
    assert table["wind_m_s"] == pytest.approx([10.0, np.degrees(1.0)])


FAULTS = {
    "cumulu:0.4": "cumulu:0.4: kind must be one of stratus, stratocumulus, cumulus, ",
    "": "'': kind must be one of stratus, stratocumulus, cumulus, altocumulus, cirrus, got ''",
    "cumulus:1.4": "cumulus:1.4: cover must be at most 1, got 1.4",
    "cumulus:nan": "cumulus:nan: cover must be at least 0, got nan",
    "cumulus:much": "cumulus:much: cover must be a share such as 0.4, '3okta' or '3/8', got 'much'",
    "cumulus:9okta": "cumulus:9okta: cover must be a share such as 0.4, ",
    "cumulus:0.4,cover=0.3": "cover=0.3: cover is given twice",
    "cumulus,base=-5m": "base=-5m: base_km must be at least 0, got -0.005",
    "cumulus,base=5": "base=5: needs a unit, such as 5m or 5km (units: m, km, ft, mi), got '5'",
    "cumulus,depth=-1m": "depth=-1m: depth_km must be at least 0.001, got -0.001",
    "cumulus,tau=301": "tau=301: optical_depth must give an optical depth of at most 300, the",
    "cumulus,tau=x": "tau=x: must be a number, got 'x'",
    "cumulus,lwp=9kg/m2": "lwp=9kg/m2: liquid_water_path_g_m2 must give an optical depth of at",
    "cumulus,lwp=9kg": "lwp=9kg: must be a mass over an area such as 100g/m2 (units: g/m2, kg/m2; ",
    "cumulus,lwp=9,tau=3": "'cumulus,lwp=9,tau=3': must give either optical_depth or liquid_water",
    "cirrus,lwp=9": "lwp=9: liquid_water_path_g_m2 needs droplets: phase = 'water', or effective",
    "cumulus,reff=30um": "reff=30um: effective_radius_um must be at most 20, got 30.0",
    "cumulus,reff=10m/s": "reff=10m/s: must be a size such as 10um (units: um, mm; a bare number",
    "cumulus,phase=fog": "phase=fog: phase must be one of water, ice, co2_ice, or a table, got",
    "cumulus,seed=1.5": "seed=1.5: must be a whole number, got '1.5'",
    "cumulus,seed=-1": "seed=-1: seed must be a whole number from 0 to 4294967295, got -1",
    "cumulus,wind=8m/s": "wind=8m/s: must be a speed and where it comes from, such as 8m/s@270deg",
    "cumulus,wind=8kg@3": "wind=8kg@3: must be a speed such as 8m/s (units: m/s, km/h, kn, mph; ",
    "cumulus,wind=8m/s@x": "wind=8m/s@x: must be an angle such as 5deg",
    "cumulus,colur=red": "colur=red: unknown key 'colur', nearest: cover; known keys: base, ",
    "cumulus,base": "'cumulus,base': 'base' must have the form KEY=VALUE",
    "cumulus,": "'cumulus,': '' must have the form KEY=VALUE",
    "cumulus,interpolation=linear": "'cumulus,interpolation=linear': unknown key 'interpolation'",
    "tile=a.npz": "'tile=a.npz': base_km must be given",
    "tile=a.npz,base=1km,cover=1": "'tile=a.npz,base=1km,cover=1': unknown key 'cover'",
    "tile=a.npz,base=1km,origin=3km": "origin=3km: must be lengths to the east and the north, such",
}


@pytest.mark.parametrize(("text", "message"), FAULTS.items())
def test_a_bad_layer_is_wrong_usage_in_one_line_that_names_the_part(text, message):
    result = invoke("presets", "check", "earth", "--clouds", text)
    assert result.exit_code == 2
    (line,) = result.stderr.splitlines()
    assert line.startswith(f"skybake: Invalid value for '--clouds': {message}")


def test_a_layer_that_does_not_fit_the_world_is_an_error_of_the_preset():
    result = invoke("presets", "check", "earth", "--clouds", "cumulus,base=200km")
    assert result.exit_code == 1
    assert result.stderr.startswith(
        "skybake: --clouds: clouds.cumulus.base_km: the clouds must end below the atmosphere's top"
    )


def test_a_tile_that_is_not_there_is_an_error_in_one_line():
    result = invoke("presets", "check", "earth", "--clouds", "tile=nix.npz,base=1km")
    assert result.exit_code == 1
    assert result.stderr == (
        "skybake: --clouds: clouds.tile.tile: 'nix.npz': cannot be read: "
        "No such file or directory\n"
    )


def test_layers_are_shown_with_what_set_changes_of_them():
    layers = ("--clouds", "cumulus:0.4", "--clouds", "cirrus")
    shown = invoke("presets", "show", "earth", *layers, "--set", "clouds.cirrus.cover=2/8")
    assert shown.exit_code == 0, shown.output
    assert '[clouds.cumulus]\nkind = "cumulus" # --clouds\ncover = 0.4 # --clouds' in shown.stdout
    assert 'kind = "cirrus" # --clouds\ncover = "2/8" # --set' in shown.stdout


def test_none_removes_the_layers_of_the_preset_and_is_nothing_without_any():
    shown = invoke("presets", "show", "earth-fair", "--clouds", "none", "--clouds", "stratus")
    assert "[clouds.low]" not in shown.stdout
    assert "[clouds.stratus]" in shown.stdout
    check = invoke("presets", "check", "earth", "--clouds", "none")
    assert (check.exit_code, check.output) == (0, invoke("presets", "check", "earth").output)


@pytest.mark.parametrize("command", ["render", "probe", ("sequence", "--frames", "1-2")])
@pytest.mark.parametrize(
    ("option", "value"), [("--cloud-time", "3min"), ("--clouds-quality", "draft")]
)
def test_settings_of_clouds_are_refused_without_clouds(command, option, value):
    words = (command,) if isinstance(command, str) else command
    result = invoke(*words, option, value)
    assert result.exit_code == 2
    assert result.stderr == (
        f"skybake: {option}: needs clouds, and the preset has none: add a layer with --clouds\n"
    )


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("--cloud-time", "-3s", "must be a duration such as 10min"),
        ("--cloud-time", "3", "must be a duration such as 10min"),
        ("--clouds-quality", "best", "'best' is not one of 'draft', 'normal', 'high'"),
    ],
)
def test_a_bad_setting_of_clouds_is_wrong_usage(option, value, message):
    result = invoke("render", "--clouds", "cumulus", option, value)
    assert result.exit_code == 2
    assert f"'{option}'" in result.stderr
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1


def planned(*arguments):
    result = invoke("sequence", *arguments, "--dry-run", "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)["frames"]


def test_a_sequence_lets_clouds_drift_over_a_range_of_time():
    frames = planned("--clouds", "cumulus", "--cloud-time", "0s..1min", "--frames", "1-4")
    assert [frame["cloud_time_s"] for frame in frames] == pytest.approx([0, 20, 40, 60])
    assert {frame["clouds_quality"] for frame in frames} == {"normal"}


def test_with_times_clouds_drift_since_the_first_frame():
    place = ("--lat", "48.9", "--lon", "2.3", "--from", "2026-06-21T10:00Z")
    times = (*place, "--to", "2026-06-21T10:10Z", "--every", "5min")
    frames = planned("--clouds", "cumulus", *times)
    assert [frame["cloud_time_s"] for frame in frames] == [0.0, 300.0, 600.0]
    still = planned("--clouds", "cumulus", *times, "--cloud-time", "7s")
    assert [frame["cloud_time_s"] for frame in still] == [7.0, 7.0, 7.0]
    assert "cloud_time_s" not in planned(*times)[0]


def test_cover_may_change_over_a_sequence():
    change = ("--set", "clouds.cumulus.cover=0.1..0.5")
    frames = planned("--clouds", "cumulus", *change, "--frames", "1-3")
    covers = [frame["set"]["clouds.cumulus.cover"] for frame in frames]
    assert covers == pytest.approx([0.1, 0.3, 0.5])


def test_commands_for_other_machines_name_tiles_by_absolute_paths(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savez("cloud.npz", extinction_per_km=np.zeros((2, 2, 2)), spacing_km=np.ones(3))
    layers = ("--clouds", "tile=cloud.npz,base=1km", "--clouds", "cirrus:3/8")
    change = ("--set", "clouds.cirrus.cover=2/8", "--cloud-time", "0s..1min")
    result = invoke("sequence", *layers, *change, "--frames", "1-2", "--emit-commands")
    assert result.exit_code == 0, result.output
    assert f"--clouds=tile={tmp_path}/cloud.npz,base=1km" in result.stdout
    assert "--clouds=cirrus:3/8" in result.stdout
    assert "--set=clouds.cirrus.cover=2/8" in result.stdout
    assert "--cloud-time=0s..1min" in result.stdout
    assert absolute_layer("cumulus:3/8,base=1km") == "cumulus:3/8,base=1km"


def test_qualities_are_those_of_the_engine():
    assert values.CLOUD_QUALITIES == CLOUD_QUALITIES


def test_the_recipe_has_settings_of_clouds_only_where_there_are_any():
    settings = MapSettings(clouds=Clouds(90.0, "high"))
    assert settings.recipe() == MapSettings().recipe()
    more = settings.recipe(has_clouds=True).items() - settings.recipe().items()
    assert more == {("cloud_time_s", 90.0), ("clouds_quality", "high")}
    assert map_settings(cloud_time=90.0, clouds_quality="high").clouds == settings.clouds


def test_the_name_of_a_map_tells_time_and_quality_of_its_clouds():
    from skybake.baking.paths import default_path

    settings = MapSettings(clouds=Clouds(90.0, "draft"))
    fair = load_preset("earth-fair")
    assert str(default_path(fair, settings)) == "earth-fair_sun30.00deg_t90s_draft_equirect.exr"
    assert str(default_path(load_preset("earth"), settings)) == "earth_sun30.00deg_equirect.exr"
