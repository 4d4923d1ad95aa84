"""Help is quick, complete and true."""

import json
import re
from pathlib import Path

import click
import pytest

import skybake
from skybake.aerial import bake, source
from skybake.aerial.depth import BACKGROUNDS
from skybake.cli import main
from skybake.colour.camera import CAMERA_WHITES
from skybake.colour.exposure import UNITS
from skybake.colour.space import COLOUR_SPACES
from skybake.commands.options import choices
from skybake.commands.render import render
from skybake.formats.preview import VIEWS
from skybake.image import settings
from skybake.image.aim import AIMS
from skybake.image.moonlight import MOONS
from skybake.image.picture_settings import SHOWN
from skybake.image.target import TARGETS
from skybake.preset import preset_names
from skybake.projection import PROJECTIONS
from skybake.projection.camera_file import UNITS as UNITS_OF_CAMERAS
from skybake.projection.cubemap import LAYOUTS, SPACES
from skybake.projection.equirect import ROWS
from skybake.sky.sky import METHODS
from tests.cli.runs import invoke, run

DOCUMENT = Path(__file__).parents[2] / "docs" / "cli.md"
HEAVY = {"numpy", "numba", "OpenImageIO", "scipy", "colour", "llvmlite", "ephem"}

AFTER = """
import json, sys
from skybake.cli import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    print(json.dumps([end.code, sorted(sys.modules)]))
"""


def _commands(group, path=()):
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        if isinstance(command, click.Group):
            yield from _commands(command, (*path, name))
        else:
            yield (*path, name), command


COMMANDS = list(_commands(main))


@pytest.mark.parametrize(
    "arguments",
    [
        ("--help",),
        ("--version",),
        ("render", "--help"),
        ("preview", "--help"),
        ("sequence", "--help"),
        ("sequence", "--sun", "30deg"),
        ("sequence", "--frames", "3-1"),
        ("sequence", "--frames", "1-3", "--lat", "48"),
        ("sequence", "--frames", "1-3", "-o", "sky.jpg"),
        ("presets", "list"),
        ("presets", "show", "mars"),
        ("render", "--size", "64x"),
        ("render", "--sun", "95deg"),
        ("render", "--colorspace", "srgb"),
    ],
)
def test_help_presets_and_usage_faults_load_nothing_heavy(arguments):
    _, output, errors = run(*arguments, code=AFTER)
    _, modules = json.loads(output.splitlines()[-1])
    assert not HEAVY & set(modules), errors


def test_a_command_loads_no_other(tmp_path):
    """Nor what compiles, where its kernels are on disk already."""
    arguments = ("render", "--size", "64x32", "-q", "-o", str(tmp_path / "sky.exr"))
    for _ in range(2):
        _, output, _ = run(*arguments, code=AFTER)
    modules = json.loads(output.splitlines()[-1])[1]
    assert not {"numba", "scipy", "colour", "ephem"} & set(modules)
    commands = {name.removeprefix("skybake.commands.") for name in modules}
    assert not {"sequence", "presets", "preview", "probe", "cache", "chart", "targets"} & commands
    # Nor what maps without a target need nothing of.
    assert "skybake.image.target" not in modules


def test_choices_are_those_of_the_engine():
    assert tuple(PROJECTIONS) == choices.PROJECTIONS
    fields = {
        "equirect_rows": "rows",
        "cube_layout": "layout",
        "cube_space": "space",
        "face_names": "face_names",
        "fov": "fov",
        "look": "azimuth",
    }
    for option, having in choices.PROJECTIONS_WITH.items():
        names = (kind.name for kind in PROJECTIONS.values() if hasattr(kind, fields[option]))
        assert tuple(names) == having
    assert choices.CUBE_LAYOUTS == LAYOUTS
    assert tuple(SPACES) == choices.CUBE_SPACES
    assert tuple(TARGETS) == choices.TARGETS
    assert choices.EQUIRECT_ROWS == ROWS
    assert tuple(COLOUR_SPACES) == choices.COLOUR_SPACES
    assert choices.UNITS == UNITS
    assert choices.PIXELS == settings.PIXELS
    assert choices.SUN_DISCS == settings.SUN_DISCS
    assert choices.METHODS == METHODS
    assert choices.CAMERA_WHITES == CAMERA_WHITES
    assert choices.SHOWN == SHOWN
    assert choices.VIEWS == VIEWS
    assert choices.AIMS == AIMS
    assert choices.AERIAL_METHODS == bake.METHODS
    assert choices.DEPTH_KINDS == source.DEPTH_KINDS
    assert set(choices.MOONS_IN_AIR) < set(MOONS)
    assert choices.SKIES_BEHIND == bake.SKIES
    assert tuple(BACKGROUNDS) == choices.DEPTH_BACKGROUNDS
    assert set(choices.CAMERA_UNITS) == set(UNITS_OF_CAMERAS)


def test_defaults_are_those_of_the_engine():
    context = render.make_context("render", [])
    given = {key: value for key, value in context.params.items() if value is not None}
    made = settings.MapSettings()
    engine = vars(made.lighting) | vars(made.encoding) | {"altitude": made.view.altitude}
    engine["projection"] = made.view.projection.name
    shared = given.keys() & engine.keys()
    assert {key: given[key] for key in shared} == {key: engine[key] for key in shared}
    assert len(shared) == 10
    shown = {p.name: p.show_default for p in render.params if isinstance(p.show_default, str)}
    for key in engine.keys() & shown.keys():
        value = engine[key]
        if value is not None:
            assert shown[key] == (f"{value:g}" if isinstance(value, float) else value)


@pytest.mark.parametrize(("path", "command"), COMMANDS)
def test_every_option_is_documented_and_every_documented_option_exists(path, command):
    _, heading, rest = DOCUMENT.read_text("utf-8").partition(f"## skybake {' '.join(path)}\n")
    assert heading
    section = rest.partition("\n## ")[0]
    rows = {}
    for line in re.findall(r"^\| `(?:-\w, )?(--.*) \|$", section, re.MULTILINE):
        name, *cells = re.split(r" *(?<!\\)\| *", line)
        rows[re.split("[ `]", name)[0]] = cells
    options = [option for option in command.params if isinstance(option, click.Option)]
    assert set(rows) == {option.opts[-1] for option in options}
    for option in options:
        default, meaning = rows[option.opts[-1]]
        shown = option.show_default if isinstance(option.show_default, str) else option.default
        if isinstance(shown, str) and " " not in shown:
            assert default == f"`{shown}`"
        for choice in getattr(option.type, "choices", ()):
            assert f"`{choice}`" in meaning


SHORT = {"--output": "-o", "--quiet": "-q"}


@pytest.mark.parametrize(("path", "command"), COMMANDS)
def test_output_and_quiet_have_the_same_short_form_everywhere(path, command):
    section = DOCUMENT.read_text("utf-8").partition(f"## skybake {' '.join(path)}\n")[2]
    section = section.partition("\n## ")[0]
    for option in command.params:
        if option.opts[-1] in SHORT:
            short = SHORT[option.opts[-1]]
            assert option.opts == [short, option.opts[-1]]
            assert f"| `{short}, {option.opts[-1]}" in section


@pytest.mark.parametrize(("path", "command"), [((), main), *COMMANDS])
def test_every_command_and_option_has_a_help(path, command):
    result = invoke(*path, "--help")
    assert result.exit_code == 0
    assert command.help
    assert all(len(line) <= 100 for line in result.output.splitlines())
    assert all(p.help for p in command.params if isinstance(p, click.Option))


def test_the_version_is_that_of_the_package():
    assert invoke("--version").stdout == f"skybake {skybake.__version__}\n"


def test_without_a_command_help_is_shown_as_wrong_usage():
    result = invoke()
    assert result.exit_code == 2
    assert "Usage: skybake" in result.stderr


def test_the_presets_are_listed_with_their_titles():
    lines = invoke("presets", "list").stdout.splitlines()
    assert [line.split()[0] for line in lines] == preset_names()
    assert lines[0].endswith("Earth: clear continental air over grassland")


def test_a_shown_preset_is_its_file():
    shown = invoke("presets", "show", "mars").stdout
    assert shown.startswith("title = ")
    assert "[constituents.dust]" in shown


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_shells_get_their_completion(shell):
    status, output, _ = run(env={"_SKYBAKE_COMPLETE": f"{shell}_source"})
    assert status == 0
    assert "_SKYBAKE_COMPLETE" in output
