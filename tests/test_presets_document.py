"""What docs/presets.md says is so."""

import re
import shlex
from pathlib import Path

import pytest

from docs.make_presets import filled
from skybake.preset import load_preset
from skybake.preset.clouds_model import KINDS
from skybake.preset.constituents import _READERS, PROFILES
from skybake.preset.extend import TOP_KEYS
from skybake.preset.particles import PARTICLES
from skybake.preset.phases import PHASES
from tests.cli.runs import invoke, listing

TEXT = (Path(__file__).parents[1] / "docs" / "presets.md").read_text("utf-8")
WORLDS = re.findall(r"^```toml\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
COMMANDS = [
    line
    for block in re.findall(r"^```sh\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
    for line in block.splitlines()
]


def test_its_tables_are_those_that_are_generated_now():
    assert filled(TEXT) == TEXT


def test_a_world_in_ten_lines_is_checked_and_rendered(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert len(WORLDS[0].splitlines()) == 10
    Path("salt.toml").write_text(WORLDS[0], encoding="utf-8")
    checked = invoke("presets", "check", "salt.toml")
    assert checked.exit_code == 0, checked.output
    assert "aerosol" in checked.stdout
    assert "ozone" not in checked.stdout
    arguments = (
        "--preset",
        "salt.toml",
        "--size",
        "32x16",
        "--method",
        "hillaire",
        "-o",
        "salt.exr",
    )
    assert invoke("render", *arguments).exit_code == 0
    assert listing(tmp_path) == ["salt.exr", "salt.toml"]


def test_a_world_from_nothing_loads(tmp_path):
    (tmp_path / "own.toml").write_text(WORLDS[-1], encoding="utf-8")
    planet = load_preset(tmp_path / "own.toml")
    assert [one.name for one in planet.constituents] == ["air", "dust", "smoke"]
    assert planet.data_quality


def test_its_clouds_load(tmp_path):
    (tmp_path / "own.toml").write_text(WORLDS[1], encoding="utf-8")
    low, high = load_preset(tmp_path / "own.toml").clouds
    assert (low.kind, high.kind) == ("cumulus", "cirrus")
    assert low.cover == 3 / 8
    assert low.optical_depth == pytest.approx(3 * 0.12 / (2 * 1000 * 8e-6))


@pytest.mark.parametrize("command", COMMANDS)
def test_its_commands_run(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    skybake, *arguments = shlex.split(command)
    assert skybake == "skybake"
    quick = ("--method", "hillaire") if arguments[0] == "render" else ()
    result = invoke(*arguments, *quick)
    assert result.exit_code == 0, result.output


def test_every_key_and_kind_is_described():
    words = set(re.findall(r"`\"?([a-z0-9_-]+)", TEXT))
    words |= set(re.findall(r"kind = \"([a-z-]+)\"", TEXT))
    words |= {key.split(".")[0] for key in words}
    assert {*TOP_KEYS, "extends", *_READERS, *KINDS, *PARTICLES, *PROFILES, *PHASES} <= words
