"""Every fault of a user is one line on stderr with the place, the rule and the value."""

import os
from pathlib import Path

import pytest

from skybake.preset import preset_text
from tests.cli.runs import AS_A_USER, SMALL, invoke, listing, run

USAGE = """
--sun 95deg                       => '--sun': must be from -90deg to 90deg, got 95deg
--sun -90.1                       => '--sun': must be from -90deg to 90deg, got -90.1
--sun nan                         => '--sun': must be an angle such as 5deg
--sun inf                         => '--sun': must be an angle such as 5deg
--sun 5km                         => '--sun': must be an angle such as 5deg
--sun-azimuth south               => '--sun-azimuth': must be an angle such as 5deg
--altitude -1m                    => '--altitude': must be at least 0m, which is the ground, got -1
--altitude 400                    => '--altitude': needs a unit, such as 400m or 400km (units: m, km
--altitude 400M                   => '--altitude': must be a length such as 2km
-o sky.png                        => got '.png'; a picture to look at is written by --preview
--altitude 2deg                   => '--altitude': must be a length such as 2km
--altitude 1e400m                 => '--altitude': must be a length such as 2km
--size 0x0                        => --size: must be from 4 to 65536, got 0
--size 0                          => --size: must be from 4 to 65536, got 0
--size 64x64                      => --size: width must be twice the height, got 64x64
--size 2x1                        => --size: must be from 4 to 65536, got 2
--size 131074x65537               => --size: must be from 4 to 65536, got 131074
--size -64x-32                    => '--size': must be such as 4096x2048, or 1024 for a
--size 64x32x3                    => '--size': must be such as 4096x2048, or 1024 for a
--size 64.5x32                    => '--size': must be such as 4096x2048, or 1024 for a
--projection cubemap --size 64x32 => --size: a cubemap needs the edge of a face, got 64x32
--projection lambert              => '--projection': 'lambert' is not one of 'equirect', 'cubemap',
--fov 40deg                       => --fov: needs --projection fisheye or perspective
--look 180,0                      => --look: needs --projection fisheye or perspective
--projection fisheye --fov 300deg => --fov: must be greater than 0deg and at most 270deg
--cube-layout cross               => --cube-layout: needs --projection cubemap
--cube-layout star                => '--cube-layout': 'star' is not one of 'faces', 'cross',
--projection angular --size 64x32 => --size: an angular map is square, got 64x32
--projection octahedral --size 1  => --size: must be from 2 to 65536, got 1
--equirect-rows edges             => '--equirect-rows': 'edges' is not one of 'centres', 'poles'.
--projection angular --equirect-rows poles => --equirect-rows: needs --projection equirect
--projection angular --look 0,0   => --look: needs --projection fisheye or perspective
--rotate north                    => '--rotate': must be an angle such as 5deg
--projection fisheye --rotate 9   => --rotate: cannot be combined with --projection fisheye, which
--sun-size 0deg                   => '--sun-size': must be greater than 0deg and at most 20deg, got
--sun-size 21                     => '--sun-size': must be greater than 0deg and at most 20deg, got
--sun-strength 0                  => '--sun-strength': must be a number greater than 0 and at most
--sun-strength nan                => '--sun-strength': must be a number greater than 0 and at most
--sun-soft --sun-disc exclude     => --sun-soft: cannot be combined with --sun-disc exclude
--sun-size 2 --sun-disc exclude   => --sun-size: cannot be combined with --sun-disc exclude
--omit-exposure                   => --omit-exposure: needs an .hdr output
--colorspace srgb                 => '--colorspace': 'srgb' is not one of 'lin_rec709', 'acescg',
--units lux                       => '--units': 'lux' is not one of 'ev15', 'nits'.
--units nits --ev 3               => --units: cannot be combined with --ev
--ev 41                           => --ev: must be within -30 to 40, got 41
--ev nan                          => --ev: must be within -30 to 40, got nan
--ev bright                       => '--ev': 'bright' is not a valid float.
--pixel int                       => '--pixel': 'int' is not one of 'auto', 'half', 'float',
--compression lzma                => --compression: must be one of none, rle, zips, zip, piz,
--compression zip:12              => --compression: level of zip must be a whole number within 1 to
--sun-disc yes                    => '--sun-disc': 'yes' is not one of 'include', 'exclude', 'only',
--method magic                    => '--method': 'magic' is not one of 'full', 'scalar', 'hillaire',
-o a.jpg                          => a.jpg: suffix must be .exr or .hdr or .ktx2 or .dds, got
-o a                              => a: suffix must be .exr or .hdr or .ktx2 or .dds, got ''
-o a.hdr --pixel half             => --pixel: needs an .exr, .ktx2 or .dds output
-o a.hdr --compression zip        => --compression: needs an .exr or .ktx2 output
--preview a.jpg                   => '--preview': a.jpg: suffix must be .png, got '.jpg'
--preview --preview-ev bright     => '--preview-ev': must be auto or a number from -30 to 40
--preview-ev 3                    => --preview-ev: needs --preview
--view aces1                      => --view: needs --preview
--preview --view film             => '--view': 'film' is not one of 'aces1', 'aces2'.
--white-balance auto              => --white-balance: needs --preview
--preview --white-balance warm    => '--white-balance': must be auto, none or a temperature from 10
--preview --white-balance 900K    => '--white-balance': must be auto, none or a temperature from 10
--preview --white-balance nan     => '--white-balance': must be auto, none or a temperature from 10
--shot 180,0,50                   => --shot: needs --preview
--preview --shot 180,0            => '--shot': must be AZIMUTH,ELEVATION,FOV such as 180,10,50, got
--preview --shot 180,0,50,1       => '--shot': must be AZIMUTH,ELEVATION,FOV such as 180,10,50, got
--preview --shot 180,95,50        => '--shot': must be from -90deg to 90deg, got 95
--preview --shot 180,0,0          => '--shot': must be greater than 0deg, got 0
--preview --shot 180,0,171        => '--shot': must have a field of view of at most 170deg, got 171
--preview --shot 180,0,50m        => '--shot': must be an angle such as 5deg
--clouds tile:cloud.npz           => '--clouds': tile:cloud.npz: a tile must be written as tile=
--clouds cloud.npz,base=1km       => '--clouds': cloud.npz: a tile must be written as tile=cloud.npz
--clouds cumulus:9okta            => '--clouds': cumulus:9okta: cover must be a share such as 0.4,
--clouds cumulus:0.4,bass=1km     => '--clouds': bass=1km: unknown key 'bass', nearest: base; known
--colour acescg                   => No such option
spare                             => Got unexpected extra argument (spare)
--sun                             => Option '--sun' requires an argument.
"""


def table(text):
    return [tuple(part.strip() for part in line.split("=>")) for line in text.strip().splitlines()]


def check_fault(result, status, message):
    assert result.exit_code == status, result.output
    assert result.stdout == ""
    assert result.stderr.startswith("skybake: ")
    assert result.stderr.count("\n") == 1
    assert message in result.stderr


@pytest.mark.parametrize(("arguments", "message"), table(USAGE))
def test_wrong_usage_is_one_line_exit_2_and_no_file(tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    check_fault(invoke("render", *arguments.split()), 2, message)
    assert listing(tmp_path) == []


def test_a_cube_in_one_exr_is_no_radiance_picture(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments = "--projection cubemap --size 16 --cube-layout exr -o a.hdr"
    check_fault(invoke("render", *arguments.split()), 2, "--cube-layout exr: needs an .exr output")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("rendr",), "No such command 'rendr'."),
        (("presets", "shw"), "No such command 'shw'."),
        (("presets", "show"), "Missing argument 'NAME|PATH'."),
        (("preview",), "Missing argument 'IN'."),
        (("preview", "a.exr", "-o", "a.jpg"), "a.jpg: suffix must be .png, got '.jpg'"),
        (("preview", "a.exr", "--ev", "x"), "must be auto or a number from -30 to 40, got 'x'"),
        (("preview", "a.exr", "--shot", "1,2"), "must be AZIMUTH,ELEVATION,FOV such as 180,10,50"),
        (("preview", "a.exr", "--white-balance", "x"), "must be auto, none or a temperature from"),
    ],
)
def test_wrong_usage_of_the_other_commands_is_exit_2(arguments, message):
    check_fault(invoke(*arguments), 2, message)


EARTH = preset_text("earth-hillaire2020")
PRESETS = """
albedo = => albedo = 1.5 #               => ground.albedo: must be at most 1, got 1.5
albedo = => albedo = -0.1 #              => ground.albedo: must be at least 0, got -0.1
albedo = => albedo = nan #               => ground.albedo: must be at least 0, got nan
albedo = => albdo =                      => ground.albedo: must be given
radius_km = => radius_km = -1 #          => planet.radius_km: must be at least 1, got -1
radius_km = => radius_km = inf #         => planet.radius_km: must be at most
[ground] => [ground]\\ncolour = 3         => ground: unknown key 'colour'; known keys: albedo
title = => title                         => not valid TOML: Expected '=' after a key in a key/value
"""


@pytest.mark.parametrize(("old", "new", "message"), table(PRESETS))
def test_a_faulty_preset_is_one_line_exit_1_and_no_file(tmp_path, monkeypatch, old, new, message):
    monkeypatch.chdir(tmp_path)
    assert old in EARTH
    Path("own.toml").write_text(EARTH.replace(old, new.replace("\\n", "\n"), 1), encoding="utf-8")
    result = invoke("render", *SMALL, "--quiet", "--preset", "own.toml")
    check_fault(result, 1, f"own.toml: {message}")
    assert listing(tmp_path) == ["own.toml"]


def test_malformed_toml_is_named_with_line_and_column(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("own.toml").write_text("[planet]\nradius_km 3\n", encoding="utf-8")
    result = invoke("render", *SMALL, "--quiet", "--preset", "own.toml")
    check_fault(result, 1, "own.toml: not valid TOML:")
    assert "(at line 2, column 11)" in result.stderr


@pytest.mark.parametrize("command", [("render", "--preset"), ("presets", "show")])
def test_an_unknown_preset_lists_the_known_ones(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    result = invoke(*command, "venus")
    check_fault(result, 1, "unknown preset 'venus'; known presets: earth, earth-broken, ")
    assert listing(tmp_path) == []


def test_a_missing_preset_file_is_named(tmp_path):
    result = invoke("render", "--preset", tmp_path / "own.toml")
    check_fault(result, 1, "own.toml: cannot be read: No such file or directory")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("-o", "missing/a.exr"), "missing/a.exr: folder must exist, got "),
        (("-o", "folder.exr"), "folder.exr: must be a file, got a folder"),
        (("--preview", "missing/a.png"), "missing/a.png: folder must exist, got "),
        (("--compression", "dwaa", "--units", "nits"), "must be at most"),
        (("--pixel", "half", "--units", "nits"), "in half with zip must be at most 65504, got"),
    ],
)
def test_a_map_that_cannot_be_written_is_one_line_exit_1_and_no_file(
    tmp_path, monkeypatch, arguments, message
):
    monkeypatch.chdir(tmp_path)
    Path("folder.exr").mkdir()
    check_fault(invoke("render", *SMALL, "--quiet", *arguments), 1, message)
    assert listing(tmp_path) == ["folder.exr"]


def test_targets_are_refused_before_anything_is_computed(tmp_path, monkeypatch):
    def never(*_):
        raise AssertionError

    monkeypatch.setattr("skybake.baking.write.Scene", never)
    result = invoke("render", *SMALL, "--quiet", "-o", tmp_path / "missing" / "a.exr")
    check_fault(result, 1, "folder must exist")


@pytest.mark.parametrize(
    ("content", "message"),
    [(None, "must be an image file, got nothing"), (b"no image", "must be an image, got")],
)
def test_a_preview_of_no_image_is_one_line_exit_1_and_no_file(tmp_path, content, message):
    source = tmp_path / "a.exr"
    if content:
        source.write_bytes(content)
    before = listing(tmp_path)
    check_fault(invoke("preview", source), 1, message)
    assert listing(tmp_path) == before


def test_an_unwritable_folder_is_one_line_exit_1_and_no_file(tmp_path):
    folder = tmp_path / "protected"
    folder.mkdir(mode=0o555)
    status, output, errors = run(
        *("render", *SMALL, "--quiet", "-o", "protected/a.exr"), wrapper=AS_A_USER, cwd=tmp_path
    )
    assert (status, output) == (1, "")
    assert errors == f"skybake: protected/a.exr: folder must be writable, got {folder}\n"
    assert listing(folder) == []


def test_a_cache_that_cannot_be_written_is_a_warning_of_one_line(tmp_path):
    (tmp_path / "file").touch()
    status, output, errors = run(
        *("render", *SMALL, "--quiet", "--altitude", "2km", "-o", tmp_path / "missing" / "a.exr"),
        env={"SKYBAKE_CACHE_DIR": str(tmp_path / "file")},
    )
    assert (status, output) == (1, "")
    warning, fault = errors.splitlines()
    assert warning.startswith(f"skybake: warning: {tmp_path / 'file'}")
    assert "kernel cache must be writable" in warning
    assert fault.startswith("skybake: ")


FULL = """
import resource, sys
limit = int(sys.argv.pop(1))
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
from skybake.cli import main
main()
"""


@pytest.mark.parametrize(
    ("limit", "arguments"),
    [
        (5000, ("--size", "64x32", "-o", "a.exr")),
        (5000, ("--size", "64x32", "-o", "a.hdr")),
        (5000, ("--size", "64x32", "-o", "a.exr", "--preview")),
        (9000, ("--projection", "cubemap", "--size", "64", "-o", "a.exr", "--preview")),
    ],
)
def test_a_full_disk_is_one_line_exit_1_and_no_file(tmp_path, limit, arguments):
    """Files beyond a limit cannot grow, as on a full disk; the limit falls amid the files."""
    invoke("render", *SMALL, "--quiet", "-o", tmp_path / "warm.exr")
    (tmp_path / "warm.exr").unlink()
    status, output, errors = run(*(limit, "render", "--quiet", *arguments), code=FULL, cwd=tmp_path)
    assert (status, output) == (1, ""), errors
    assert errors.startswith("skybake: a")
    assert "must be " in errors or "cannot be written completely" in errors
    assert errors.count("\n") == 1
    assert listing(tmp_path) == []


def test_a_full_file_system_leaves_nothing_of_a_cubemap(small_disk):
    status, output, errors = run(
        *("render", "--projection", "cubemap", "--size", "128", "--quiet", "-o", "a.exr"),
        cwd=small_disk,
    )
    assert (status, output) == (1, ""), errors
    assert "full disk" in errors or "No space left" in errors
    assert errors.count("\n") == 1
    assert listing(small_disk) == []


def test_a_reader_that_goes_away_is_no_traceback():
    read, write = os.pipe()
    os.close(read)
    status, _, errors = run("presets", "show", "mars", stdout=write)
    os.close(write)
    assert status == 1
    assert "Traceback" not in errors
