"""``skybake clouds``: tiles that are written and imported."""

import sys

import numpy as np
import pytest

from tests.cli.runs import invoke, run

MODULE = """
import numpy as np

class Grid:
    name = "density"
    class transform:
        voxelSize = staticmethod(lambda: (10.0, 20.0, 30.0))
    activeVoxelCount = staticmethod(lambda: 6)
    evalActiveVoxelBoundingBox = staticmethod(lambda: ((-1, 0, 0), (0, 0, 2)))
    def copyToArray(self, array, ijk):
        array[:] = np.arange(6.0).reshape(2, 1, 3)

def readAllGridMetadata(path):
    return [Grid()]

def read(path, name):
    return Grid()
"""


@pytest.fixture
def openvdb(tmp_path, monkeypatch):
    """A module of that name: no package index has the real one."""
    (tmp_path / "openvdb.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    yield {"PYTHONPATH": f"{tmp_path}:{':'.join(sys.path)}"}
    sys.modules.pop("openvdb", None)


def test_a_tile_that_was_written_is_a_tile(tmp_path):
    path = tmp_path / "cloud.npz"
    layer = "cirrus:0.5,base=8km,depth=1km"
    made = invoke("clouds", "tile", "earth", "--clouds", layer, "-o", path)
    assert (made.exit_code, made.stderr) == (0, "")
    assert made.stdout.startswith("base 7.9")
    with np.load(path) as arrays:
        values, spacing = arrays["extinction_per_km"], arrays["spacing_km"]
    depth = values.sum(0) * spacing[0]
    assert depth.mean() == pytest.approx(0.15, rel=0.1)
    preset = tmp_path / "own.toml"
    preset.write_text('extends = "earth"\n[clouds.own]\ntile = "cloud.npz"\nbase_km = 8.0\n')
    assert invoke("presets", "check", preset).exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (("tile", "earth", "-o", "a.npz"), 1, "earth: must have a layer of clouds, got none"),
        (("tile", "earth-fair", "-o", "a.exr"), 2, "--output: must end in .npz, got a.exr"),
        (
            ("tile", "earth-fair", "--layer", "high", "-o", "a.npz"),
            2,
            "--layer: must be one of low, got 'high'",
        ),
        (
            ("tile", "earth", "--clouds", "cumulus:0", "-o", "a.npz"),
            1,
            "earth: clouds.cumulus must have clouds to write, got cover 0",
        ),
        (
            ("import", "a.vdb", "-o", "a.npz"),
            1,
            "a.vdb: needs the Python module openvdb, which is not installed",
        ),
    ],
)
def test_what_cannot_be_written_is_one_line(tmp_path, monkeypatch, arguments, status, message):
    monkeypatch.chdir(tmp_path)
    refused = invoke("clouds", *arguments)
    assert (refused.exit_code, refused.stderr.count("\n")) == (status, 1)
    assert message in refused.stderr
    assert not list(tmp_path.iterdir())


def test_a_grid_of_openvdb_becomes_a_tile(tmp_path, openvdb):
    path = tmp_path / "cloud.npz"
    arguments = "import", "a.vdb", "--extinction", "2", "--up", "z", "-o", path
    assert run("clouds", *arguments, env=openvdb) == (0, "", "")
    with np.load(path) as arrays:
        values, spacing = arrays["extinction_per_km"], arrays["spacing_km"]
    np.testing.assert_allclose(spacing, [0.03, 0.02, 0.01])
    np.testing.assert_array_equal(values, 2.0 * np.arange(6.0).reshape(2, 1, 3).transpose(2, 1, 0))


def test_a_module_that_does_not_load_says_why(tmp_path):
    (tmp_path / "openvdb.py").write_text("raise ImportError('libopenvdb.so.12: no such file')\n")
    environment = {"PYTHONPATH": f"{tmp_path}:{':'.join(sys.path)}"}
    status, _, errors = run("clouds", "import", "a.vdb", "-o", tmp_path / "a.npz", env=environment)
    assert (status, errors) == (
        1,
        "skybake: a.vdb: needs the Python module openvdb, which does not load "
        "(libopenvdb.so.12: no such file)\n",
    )


def test_a_grid_that_is_missing_is_named(tmp_path, openvdb):
    status, _, errors = run(
        "clouds", "import", "a.vdb", "--grid", "fog", "-o", tmp_path / "a.npz", env=openvdb
    )
    assert status == 1
    assert "a.vdb: must hold the grid fog, got density" in errors
