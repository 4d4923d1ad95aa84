"""``skybake cache``: what it shows, frees and compiles."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.aerial.pictures import beauty, write_exr
from tests.cli.runs import AS_A_USER, SMALL, run


@pytest.fixture
def cold(tmp_path):
    return {"SKYBAKE_CACHE_DIR": str(tmp_path / "cache")}


def info(environment):
    status, output, errors = run("cache", "info", "--json", env=environment)
    assert (status, errors) == (0, "")
    return json.loads(output)


def test_info_tells_what_each_version_has(tmp_path, cold):
    old = tmp_path / "cache" / "kernels-0123"
    (old / "atmospheres").mkdir(parents=True)
    (old / "a.kernel").write_bytes(bytes(1000))
    (old / "atmospheres" / "b.tables").write_bytes(bytes(2_000_000))
    (old / "atmospheres" / "clouds-c.tables").write_bytes(bytes(3_000_000))
    (old / "atmospheres" / "cloudlight-d.tables").write_bytes(bytes(4_000_000))
    _, text, _ = run("cache", "info", env=cold)
    (line,) = (line for line in text.splitlines() if line.startswith("kernels-0123: "))
    assert "1 kernels 0.0 MB, 1 atmospheres 2.0 MB, 1 tiles of clouds 3.0 MB, " in line
    assert line.endswith("light of 1 skies with clouds 4.0 MB")
    assert "(this version)" not in text
    found = info(cold)
    assert found["folder"] == str(tmp_path / "cache")
    (other,) = found["versions"]
    assert other == {
        "folder": str(old),
        "present": False,
        "kernels": 1,
        "kernel_bytes": 1000,
        "atmospheres": 1,
        "atmosphere_bytes": 2_000_000,
        "cloud_tiles": 1,
        "cloud_tile_bytes": 3_000_000,
        "cloud_lights": 1,
        "cloud_light_bytes": 4_000_000,
    }


def test_info_makes_no_folder(tmp_path, cold):
    assert info(cold) == {"folder": str(tmp_path / "cache"), "versions": []}
    assert not (tmp_path / "cache").exists()


def test_info_marks_the_folder_of_this_version(tmp_path):
    """Of the cache that other tests have filled."""
    assert run("render", *SMALL, "-q", "-o", tmp_path / "a.exr") == (0, "", "")
    (present,) = (version for version in info({})["versions"] if version["present"])
    assert present["kernels"] > 0
    _, text, _ = run("cache", "info")
    (line,) = (line for line in text.splitlines() if "(this version)" in line)
    assert line.startswith(Path(present["folder"]).name)


def test_clear_leaves_what_is_not_ours(tmp_path, cold):
    folder = tmp_path / "cache"
    (folder / "kernels-0123" / "atmospheres").mkdir(parents=True)
    (folder / "kernels-0123" / "atmospheres" / "b.tables").write_bytes(bytes(2_000_000))
    (folder / "kernels-file").write_text("not a folder")
    (folder / "notes").mkdir()
    assert run("cache", "clear", env=cold) == (0, "2.0 MB freed\n", "")
    assert sorted(path.name for path in folder.iterdir()) == ["kernels-file", "notes"]


def test_clear_of_nothing_is_no_fault(cold):
    assert run("cache", "clear", env=cold) == (0, "0.0 MB freed\n", "")


def test_clear_names_a_folder_that_it_cannot_remove(tmp_path, cold):
    folder = tmp_path / "cache" / "kernels-0123"
    folder.mkdir(parents=True)
    (folder / "a.kernel").write_bytes(bytes(3_000_000))
    folder.chmod(0o555)
    status, output, errors = run("cache", "clear", env=cold, wrapper=AS_A_USER)
    assert (status, output) == (1, "")
    assert errors == f"skybake: {folder}: cannot be removed (3.0 MB remain)\n"
    folder.chmod(0o755)


@pytest.mark.parametrize("presets", [("nowhere",), ("earth", "nowhere")])
def test_warm_refuses_an_unknown_preset_before_anything_is_compiled(tmp_path, cold, presets):
    options = [word for preset in presets for word in ("--preset", preset)]
    status, output, errors = run("cache", "warm", *options, env=cold)
    assert (status, output) == (1, "")
    assert errors.startswith("skybake: unknown preset 'nowhere'; known presets: ")
    assert errors.count("\n") == 1
    assert not list((tmp_path / "cache").rglob("*.*"))


@pytest.mark.parametrize("name", ["file/cache", "cache"])
def test_warm_refuses_a_folder_in_which_nothing_can_be_kept(tmp_path, name):
    (tmp_path / "file").write_text("not a folder")
    tmp_path.chmod(0o555)
    folder = tmp_path / name
    environment = {"SKYBAKE_CACHE_DIR": str(folder)}
    status, output, errors = run("cache", "warm", env=environment, wrapper=AS_A_USER)
    assert (status, output) == (1, "")
    assert errors.startswith(f"skybake: {folder}: kernel cache must be a folder that is writable")
    assert errors.count("\n") == 1


USES = [
    ("render", *SMALL, "--preset", "mars", "--sun", "20deg"),
    ("render", *SMALL, "--sun", "-4deg", "--preview"),
    ("render", *SMALL, "--altitude", "36000km", "--sun", "-12deg"),
    ("render", *SMALL, "--preset", "earth-hillaire2020", "--method", "march"),
    ("render", *SMALL, "--method", "hillaire", "--sun-disc", "only"),
    ("render", "--projection", "cubemap", "--size", "32", "--cube-layout", "cross"),
    ("render", "--projection", "cubemap", "--size", "32", "--altitude", "400km"),
    ("render", *SMALL, "--preset", "earth-overcast", "--clouds-quality", "draft"),
    ("render", *SMALL, "--preset", "mars-ice-clouds", "--clouds-quality", "draft", "--preview"),
]


LONG = "/tmp/" + "/".join(["a" * 200] * 30)  # noqa: S108 - longer than a path can be


def test_a_place_whose_name_is_too_long_is_one_line(tmp_path):
    environment = {"SKYBAKE_CACHE_DIR": LONG}
    for command in (("info",), ("clear",), ("warm",)):
        status, output, errors = run("cache", *command, env=environment)
        assert (status, output) == (1, ""), command
        assert errors.startswith(f"skybake: {LONG[:100]}")
        assert errors.count("\n") == 1
        assert len(errors) < 500


def test_without_such_a_place_kernels_are_compiled_with_one_warning(tmp_path):
    code = """
import numpy as np
from skybake.scattering.harmonics import build_harmonics, fill_harmonics
fill_harmonics(build_harmonics(2), 0.5, np.empty(6))
"""
    status, _, errors = run(code=f"import warnings\n{code}", env={"SKYBAKE_CACHE_DIR": LONG})
    assert status == 0
    assert errors.count("RuntimeWarning") == 1
    assert "kernel cache must be writable, got File name too long" in errors


@pytest.mark.slow
def test_after_warm_nothing_is_compiled(tmp_path, cold):
    assert run("cache", "warm", "-q", env=cold) == (0, "", "")

    def kernels():
        files = Path(cold["SKYBAKE_CACHE_DIR"]).rglob("*.kernel")
        return {path: path.stat().st_mtime_ns for path in files}

    compiled = kernels()
    assert compiled
    write_exr(tmp_path / "in.exr", beauty(np.full((4, 4), 5000.0)))
    camera = {"azimuth": 0, "elevation": 0, "fov": 50}
    (tmp_path / "camera.json").write_text(json.dumps(camera))
    picture = ("aerial", "--beauty", "in.exr", "--camera", "camera.json", "--method")
    for use in (*USES, (*picture, "march"), (*picture, "froxel")):
        status, _, errors = run(*use, "-q", "-o", "a.exr", cwd=tmp_path, env=cold)
        assert (status, errors) == (0, "")
    status, _, errors = run("luts", "-q", "-o", "tables", cwd=tmp_path, env=cold)
    assert (status, errors) == (0, "")
    for method in ("full", "reference"):
        for world in ("earth", "earth-fair"):
            traced = ("--preset", world, "--method", method, "--samples", "2")
            status, _, errors = run("probe", *traced, env=cold)
            assert (status, errors) == (0, "")
    assert kernels() == compiled
