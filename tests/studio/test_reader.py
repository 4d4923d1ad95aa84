"""Knobs are the options of ``skybake render``, read by its own command line."""

from copy import copy
from pathlib import Path

import click
import pytest

from skybake.commands.options.described import LEFT_OUT, long_name
from skybake.commands.render import render
from skybake.commands.render_reader import RenderReader
from skybake.errors import SkybakeError
from skybake.studio.state import State, state_from_json
from tests.cli.runs import invoke


@pytest.fixture
def reader(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return RenderReader(tmp_path)


def options_of(described):
    return {one["name"]: one for group in described["groups"] for one in group["options"]}


def test_every_option_of_a_map_is_a_knob(reader):
    names = {long_name(one) for one in render.params if one.name not in LEFT_OUT}
    assert set(options_of(reader.described())) == names
    assert {"sun", "preset", "altitude", "clouds", "white-balance", "projection"} <= names


def test_an_option_that_is_added_to_the_command_line_is_a_knob(tmp_path):
    added = click.Option(["--sparkle"], type=click.Choice(["much", "little"]), help="Sparkle.")
    command = copy(render)
    command.params = [*render.params, added]
    described = RenderReader(tmp_path, command=command).described()
    assert described["groups"][-1]["title"] == "Other"
    option = options_of(described)["sparkle"]
    assert option["kind"] == "choice"
    assert option["choices"] == ["much", "little"]
    assert option["help"] == "Sparkle."


def test_knobs_say_unit_range_and_default(reader):
    options = options_of(reader.described())
    sun, altitude, quality = (options[name] for name in ("sun", "altitude", "clouds-quality"))
    assert (sun["kind"], sun["unit"], sun["min"], sun["max"]) == ("angle", "deg", -90.0, 90.0)
    assert (sun["default"], sun["default_text"]) == (30.0, "30deg")
    assert (altitude["unit"], altitude["scale"]) == ("km", "log")
    assert quality["choices"] == ["draft", "normal", "high"]
    assert all(option["help"] for option in options.values())
    assert {option["live"] for option in options.values()} == {
        *("solve", "trace", "clouds", "fold", "file")
    }


@pytest.mark.parametrize(
    ("options", "changes"),
    [
        ({"sun": "95deg"}, {}),
        ({"sun": "5 potatoes"}, {}),
        ({"altitude": "-1km"}, {}),
        ({"altitude": "5"}, {}),
        ({"projection": "mercator"}, {}),
        ({"lat": "48"}, {}),
        ({"time": "sunset", "lat": "48"}, {}),
        ({"clouds": ("cumulus:2",)}, {}),
        ({"clouds-quality": "high"}, {}),
        ({"ev": "5", "units": "nits"}, {}),
        ({"preset": "vulcan"}, {}),
        ({"preset": "mars", "ozone": "300DU"}, {}),
        ({"visibility": "5km", "turbidity": "3"}, {}),
        ({"white-balance": "hot"}, {}),
        ({}, {"aerosol.optical_dept": "1"}),
        ({}, {"aerosol.optical_depth": "-1"}),
        ({"size": "0x0"}, {}),
        ({"sun-strength": "0"}, {}),
        ({"stars": "many"}, {}),
    ],
)
def test_a_bad_value_has_the_message_of_the_command_line(reader, options, changes):
    state = State(options, changes)
    with pytest.raises(SkybakeError) as caught:
        reader.read(state)
    result = invoke(*reader.words(state)[1:], "-o", "never.exr")
    assert result.exit_code in {1, 2}
    assert result.stderr == f"skybake: {caught.value}\n"
    assert not list(Path().iterdir())


def test_an_error_names_its_knob(reader):
    for options in ({"sun": "95deg"}, {"lat": "48"}, {"projection": "mercator"}):
        with pytest.raises(SkybakeError) as caught:
            reader.read(State(options))
        assert caught.value.option == next(iter(options))


@pytest.mark.parametrize("text", ["5deg", "0.1rad", " 7 "])
def test_one_option_is_read_as_on_the_command_line(reader, text):
    degrees = {"5deg": 5.0, "0.1rad": 5.729577951308, " 7 ": 7.0}[text]
    assert reader.read_one("sun", text)["value"] == pytest.approx(degrees, rel=1e-12)
    with pytest.raises(SkybakeError, match="Invalid value for '--sun': must be from -90deg"):
        reader.read_one("sun", "95deg")


def test_words_come_in_the_order_of_the_help(reader):
    state = State({"sun": "5deg", "mips": True, "preset": "mars"}, {"dust.optical_depth": "2"})
    assert reader.words(state, "x.exr") == [
        *("skybake", "render", "--preset=mars", "--set=dust.optical_depth=2", "--sun=5deg"),
        *("--mips", "--output=x.exr"),
    ]


def test_a_look_asks_for_a_preview(reader):
    assert reader.words(State({"view": "aces2"}))[-1] == "--preview"
    assert reader.read(State({"view": "aces2", "preview-ev": "9"})).picture.fixed_ev == 9.0


@pytest.mark.parametrize(
    ("options", "changes"),
    [
        ({"preset": "../world.toml"}, {}),
        ({"preset": "/etc/world.toml"}, {}),
        ({"ground-albedo": "/etc/albedo.csv"}, {}),
        ({"ground-albedo": "../albedo.csv"}, {}),
        ({"camera": "/etc/camera.csv"}, {}),
        ({"camera": "../camera.csv"}, {}),
        ({"clouds": ("tile=/etc/cloud.npz",)}, {}),
        ({"clouds": ("tile=../cloud.npz,base=1km",)}, {}),
        ({"clouds": ("cumulus,phase=/etc/phase.csv",)}, {}),
        ({}, {"ground.albedo": '"/etc/albedo.csv"'}),
        ({}, {"ground.albedo": "../albedo.csv"}),
        ({}, {"clouds.low": '{ tile = "/etc/cloud.npz" }'}),
        ({}, {"aerosol.phase": '{ kind = "tabulated", table = "../x.csv" }'}),
    ],
)
def test_no_file_out_of_the_folder_is_read(reader, options, changes):
    with pytest.raises(SkybakeError, match="must be in the working folder"):
        reader.read(State(options, changes))


def test_no_symbolic_link_leads_out_of_the_folder(reader, tmp_path):
    outside = tmp_path.parent / "outside.toml"
    outside.write_text('extends = "mars"\n')
    Path("inside.toml").symlink_to(outside)
    with pytest.raises(SkybakeError, match="must be in the working folder"):
        reader.read(State({"preset": "inside.toml"}))


def test_a_preset_in_the_folder_is_read_anew_each_time(reader):
    own = Path("own.toml")
    depths = []
    for depth in (0.25, 0.75):
        own.write_text(f'extends = "mars"\n[constituents.dust]\noptical_depth = {depth}\n')
        planet = reader.read(State({"preset": "own.toml"})).planet
        depths.append(planet.recipe["constituents"]["dust"]["optical_depth"])
    assert depths == [0.25, 0.75]


def test_the_preset_of_the_command_line_may_be_anywhere(tmp_path, monkeypatch):
    own = tmp_path / "own.toml"
    own.write_text('extends = "mars"\n')
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert RenderReader(folder, str(own)).read(State({"preset": str(own)})).planet.name == "own"


@pytest.mark.parametrize(
    "value",
    [
        5,
        {"options": {"sun": 5}},
        {"options": {"sun": None}},
        {"options": {"sun": "x" * 5000}},
        {"options": {"sun": "5\0"}},
        {"options": [], "set": {}},
        {"options": {str(n): "x" for n in range(300)}},
        {"else": {}},
    ],
)
def test_what_is_no_state_is_refused(value):
    with pytest.raises(SkybakeError, match="must be"):
        state_from_json(value)
