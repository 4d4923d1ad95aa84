"""``skybake presets``, and changing a world from the command line."""

import json
from pathlib import Path

import OpenImageIO
import pytest

from skybake.formats.reader import read_attributes
from skybake.preset import load_preset, preset_names
from tests.cli.runs import SMALL, invoke, listing, run
from tests.cli.test_faults import check_fault
from tests.cli.test_help import COMMANDS


def test_every_preset_is_sound():
    for name in preset_names():
        result = invoke("presets", "check", name)
        assert (result.exit_code, result.stderr) == (0, "")


def test_check_tells_all_faults_each_in_a_line_with_its_place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("own.toml").write_text(
        'extends = "earth"\nground.albedo = 2\nstar.distance_au = -1\nplanet.colour = "red"\n'
    )
    result = invoke("presets", "check", "own.toml", "--set", "ozone.column_du=many")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.splitlines() == [
        "skybake: own.toml: planet: unknown key 'colour'; known keys: atmosphere_top_km, radius_km",
        "skybake: own.toml: star.distance_au: must be at least 0.001, got -1",
        "skybake: own.toml: ground.albedo: must be at most 1, got 2",
        "skybake: --set: constituents.ozone.column_du: must be a number, got 'many'",
    ]


def test_check_tells_faults_that_only_the_optics_find():
    profile = 'aerosol.profile={ kind = "tent", center_km = 90.05, half_width_km = 0.001 }'
    result = invoke("presets", "check", "earth", "--set", profile)
    check_fault(result, 1, "earth: constituents.aerosol.profile: must be thicker than 0.2 km")


def test_a_phase_table_that_is_normalised_is_noted_in_one_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("grains.csv").write_text("angle_deg,550\n0,0.08\n180,0.08\n", encoding="utf-8")
    Path("own.toml").write_text(
        'extends = "earth"\n'
        'constituents.aerosol.phase = { kind = "tabulated", table = "grains.csv" }\n'
    )
    status, output, errors = run(
        *("presets", "check", "own.toml", "--turbidity", "2"), cwd=tmp_path
    )
    assert status == 0
    assert "turbidity: 2 at 550 nm" in output
    assert errors == (
        "skybake: warning: own.toml: constituents.aerosol.phase.table: integrates to 1.0053 over "
        "the sphere at 550 nm and is normalised to 1\n"
    )


def test_check_tells_where_the_data_are_weak():
    result = invoke("presets", "check", "earth", "--set", "data_quality=Guessed, all of it.")
    assert result.stdout.splitlines()[-1] == "data quality: Guessed, all of it."


def test_the_short_options_set_what_they_say():
    changed = invoke(
        *("presets", "show", "earth", "--ozone", "320DU", "--ground-albedo", "mars_arabia"),
        *("--set", "aerosol.optical_depth=0.3"),
    ).stdout
    assert "column_du = 320.0 # --ozone\n" in changed
    assert 'albedo = "mars_arabia" # --ground-albedo\n' in changed
    assert "optical_depth = 0.3 # --set\n" in changed
    assert "albedo = 0.8 #" in invoke("presets", "show", "earth", "--ground-albedo", "0.8").stdout


@pytest.mark.parametrize(
    ("option", "line"),
    [(("--visibility", "20km"), "visibility: 20 km"), (("--turbidity", "3.5"), "turbidity: 3.5 ")],
)
def test_visibility_and_turbidity_are_met(option, line):
    output = invoke("presets", "check", "earth", *option, "--ozone", "90000").stdout
    assert any(one.startswith(line) for one in output.splitlines())


@pytest.mark.parametrize(("path", "command"), COMMANDS)
def test_every_command_that_takes_a_preset_can_change_it(path, command):
    names = {parameter.name for parameter in command.params}
    by_name = {("presets", name) for name in ("show", "check", "plot")} | {("clouds", "tile")}
    # The studio's page changes the world that it opens with.
    takes = path != ("studio",) and ("preset" in names or path in by_name)
    changes = {"changes", "visibility", "turbidity", "ozone", "ground_albedo"}
    assert names & changes == (changes if takes else set())


def test_a_probe_sees_the_changed_world(tmp_path):
    (tmp_path / "up.csv").write_text("view_zenith_deg,relative_azimuth_deg\n0,0\n")
    arguments = ("probe", "--method", "hillaire", "--wavelengths", "550", "--per-irradiance")
    grey, snow = (
        float(
            invoke(*arguments, "--directions", tmp_path / "up.csv", "--ground-albedo", albedo)
            .stdout.splitlines()[1]
            .split(",")[2]
        )
        for albedo in ("0", "0.9")
    )
    assert 1.1 < snow / grey < 2.0


def test_visibility_counts_on_what_was_set_before():
    thin = ("--set", "aerosol.profile.scale_height_km=1", "--set", "aerosol.angstrom_exponent=0")
    output = invoke("presets", "check", "earth", "--visibility", "10km", *thin).stdout
    assert "visibility: 10 km" in output
    (line,) = (line for line in output.splitlines() if line.startswith("aerosol "))
    blue, green, red = map(float, line.split()[1:4])
    assert blue == green == red == pytest.approx(3.912 / 10 - 0.0117, abs=2e-3)


FORM = "'--set': must have the form KEY=VALUE, such as aerosol.optical_depth=0.3"


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (
            "--set x",
            2,
            f"{FORM}, got 'x'",
        ),
        (
            "--set =3",
            2,
            f"{FORM}, got '=3'",
        ),
        (
            "--set a=",
            2,
            f"{FORM}, got 'a='",
        ),
        ("--visibility 20deg", 2, "'--visibility': must be a length such as 2km"),
        ("--visibility 0", 2, "'--visibility': must be greater than 0m, got 0"),
        ("--turbidity 0.9", 2, "'--turbidity': must be a number of at least 1, which is pure gas"),
        ("--turbidity inf", 2, "'--turbidity': must be a number of at least 1, which is pure gas"),
        ("--visibility 20km --turbidity 2", 2, "--turbidity: cannot be combined with --visibility"),
        ("--ozone 3km", 2, "'--ozone': must be a column of gas such as 320DU (units: DU; a bare"),
        ("--ozone -1", 2, "'--ozone': must be at least 0DU, got -1"),
        ("--set aerosol.optical_depht=1", 1, "'optical_depht', nearest: optical_depth, "),
        ("--set arosol.optical_depth=1", 1, "unknown key; nearest: aerosol.optical_depth, "),
        ("--set aerosol.optical_depth=1,5", 1, "optical_depth: must be a number, got '1,5'"),
        ("--set aerosol.optical_depth=nan", 1, "must be at least 0, got nan"),
        ("--ground-albedo moss", 1, "--ground-albedo: ground.albedo: unknown table 'moss'; tables"),
        ("--ground-albedo 1.5", 1, "--ground-albedo: ground.albedo: must be at most 1, got 1.5"),
        ("--preset mars --ozone 300", 1, "--ozone: needs an absorber of the name ozone, mars has"),
        ("--visibility 400km", 1, "--visibility: must be at most 334.9 km"),
        ("--visibility 1m", 1, "--visibility: constituents.aerosol.optical_depth: must be at most"),
        (
            "--preset earth-hillaire2020 --turbidity 2",
            1,
            "--turbidity: needs a constituent of kind",
        ),
    ],
)
def test_a_change_that_cannot_be_is_one_line_and_no_file(
    tmp_path, monkeypatch, arguments, status, message
):
    monkeypatch.chdir(tmp_path)
    check_fault(invoke("render", *SMALL, *arguments.split()), status, message)
    assert listing(tmp_path) == []


def test_a_new_world_is_that_which_it_extends_until_it_is_changed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for base in preset_names():
        name = f"my-{base}"
        assert invoke("presets", "new", name, "--from", base).stdout == f"{name}.toml\n"
        own = load_preset(f"{name}.toml").recipe
        assert own.pop("title") == f"{name}, after {base}"
        theirs = load_preset(base).recipe
        assert own | {"title": theirs["title"]} == theirs


def test_a_key_of_a_new_world_is_changed_by_taking_its_hash_away(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    invoke("presets", "new", "own")
    text = Path("own.toml").read_text("utf-8")
    Path("own.toml").write_text(text.replace("# optical_depth = 0.1", "optical_depth = 0.4"))
    assert load_preset("own.toml").recipe["constituents"]["aerosol"]["optical_depth"] == 0.4


def test_a_constituent_of_a_new_world_is_taken_away_as_its_comments_say(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    invoke("presets", "new", "own")
    head, *tables = Path("own.toml").read_text("utf-8").split("\n[")
    assert 'write above the first table: constituents.NAME = "none"' in head
    kept = [table for table in tables if not table.startswith("constituents.ozone]")]
    assert len(kept) == len(tables) - 1
    Path("own.toml").write_text("\n[".join([f'{head}constituents.ozone = "none"\n', *kept]))
    names = [one.name for one in load_preset("own.toml").constituents]
    assert names == ["air", "aerosol"]


def test_a_new_world_may_extend_a_file_and_is_moved_without_losing_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    invoke("presets", "new", "base", "--from", "mars")
    assert invoke("presets", "new", "own", "--from", "base.toml").exit_code == 0
    (tmp_path / "sub").mkdir()
    Path("own.toml").rename("sub/own.toml")
    assert load_preset("sub/own.toml").radius == load_preset("mars").radius


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("own",), "own.toml: exists already"),
        (("own.toml",), "own.toml: exists already"),
        (("a/b",), "name: must consist of letters, digits, _ and -, got 'a/b'"),
        (("x" * 300,), "File name too long"),
        (("a", "--from", "erth"), "unknown preset 'erth'; known presets: earth, "),
        (("a", "--from", "own.toml"), "own.toml: not valid TOML"),
    ],
)
def test_a_new_world_never_takes_a_place_nor_a_faulty_base(
    tmp_path, monkeypatch, arguments, message
):
    monkeypatch.chdir(tmp_path)
    Path("own.toml").write_text("mine", encoding="utf-8")
    check_fault(invoke("presets", "new", *arguments), 1, message)
    assert listing(tmp_path) == ["own.toml"]
    assert Path("own.toml").read_text("utf-8") == "mine"


@pytest.mark.parametrize("name", ["earth", "mars", "earth-hillaire2020"])
def test_a_preset_is_drawn(tmp_path, name):
    path = tmp_path / f"{name}.png"
    result = invoke("presets", "plot", name, "-o", path)
    assert (result.exit_code, result.stdout) == (0, f"{path}\n")
    picture = OpenImageIO.ImageBuf(str(path))
    assert (picture.spec().width, picture.spec().height) == (1560, 528)
    stats = OpenImageIO.ImageBufAlgo.computePixelStats(picture)
    assert min(stats.avg[:3]) > 0.8
    assert max(stats.stddev[:3]) > 0.05


def test_layers_of_clouds_are_drawn(tmp_path):
    """As bands with their names, which an SVG holds as comments."""
    path = tmp_path / "clouds.svg"
    layers = ("--clouds", "cumulus:0.4", "--clouds", "cirrus,base=90km")
    assert invoke("presets", "plot", "earth", *layers, "-o", path).exit_code == 0
    text = path.read_text("utf-8")
    assert "<!-- clouds cumulus -->" in text
    assert "<!-- clouds cirrus -->" in text
    assert "<!-- 80 -->" in text


WITHOUT = """
import sys
sys.modules["matplotlib"] = None
from skybake.cli import main
main()
"""


def test_without_matplotlib_drawing_is_refused_in_one_line(tmp_path):
    status, output, errors = run("presets", "plot", "mars", code=WITHOUT, cwd=tmp_path)
    assert (status, output) == (1, "")
    assert errors == "skybake: plot: needs matplotlib; try pip install matplotlib\n"
    assert listing(tmp_path) == []


def test_a_picture_in_a_missing_folder_is_one_line_and_no_file(tmp_path):
    result = invoke("presets", "plot", "mars", "-o", tmp_path / "missing" / "a.png")
    check_fault(result, 1, "folder must exist")


WITHOUT_A_COMPILER = """
from skybake.cli import main
from skybake.jit.kernel import Kernel
del Kernel._compile
main()
"""


def test_changing_the_air_compiles_no_kernel(tmp_path):
    (tmp_path / "up.csv").write_text("view_zenith_deg,relative_azimuth_deg\n0,0\n")
    arguments = ("--directions", tmp_path / "up.csv", "--method", "scalar", "--wavelengths", "550")
    status, plain, errors = run("probe", *arguments)
    assert (status, errors) == (0, "")
    changes = ("--set", "aerosol.optical_depth=0.27", "--ozone", "261DU")
    status, changed, errors = run("probe", *arguments, *changes, code=WITHOUT_A_COMPILER)
    assert (status, errors) == (0, "")
    assert changed != plain


def test_what_was_set_stands_in_the_file(tmp_path):
    changes = ("--visibility", "20km", "--ozone", "250")
    target = tmp_path / "a.exr"
    assert invoke("render", *SMALL, "--method", "hillaire", *changes, "-o", target).exit_code == 0
    recipe = json.loads(read_attributes(target)["skybake:recipe"])["preset"]
    assert recipe["set"]["constituents.ozone.column_du"] == 250.0
    depth = recipe["set"]["constituents.aerosol.optical_depth"]
    assert recipe["constituents"]["aerosol"]["optical_depth"] == depth
    assert 0.2 < depth < 0.4


def test_a_presets_file_may_end_in_capitals(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("X.TOML").write_text('extends = "mars"\n', encoding="utf-8")
    result = invoke("presets", "check", "X.TOML")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("X: Mars")
