"""Maps and sequences with clouds, and without."""

from pathlib import Path

import numpy as np
import pytest

from skybake.formats.reader import read_image
from tests.cli.cloudy import LAYER, few_voxels
from tests.cli.runs import SMALL, run, run_on_terminal
from tests.cli.sequences import digests, sequence

CLEAR = """
import sys
from click.testing import CliRunner
from skybake.cli import main
assert CliRunner().invoke(main, sys.argv[1:]).exit_code == 0
rooms = ("skybake.clouds", "skybake.cloud_fields")
print([name for name in sys.modules if name.startswith(rooms)])
"""


@pytest.mark.parametrize(
    "world", [("--preset", "earth"), ("--preset", "earth-fair", "--clouds", "none")]
)
def test_a_clear_sky_imports_no_room_of_clouds(folder, world):
    arguments = ("render", *SMALL, *world, "--preview", "--quiet", "-o", "a.exr")
    status, output, errors = run(*arguments, code=CLEAR, cwd=folder)
    assert (status, output, errors) == (0, "[]\n", "")


@pytest.mark.slow
def test_a_terminal_is_told_while_clouds_are_lit(folder):
    few_voxels(folder)
    arguments = ("render", *SMALL, "--clouds", LAYER, "--json", "-o", "a.exr")
    status, _, seen = run_on_terminal(*arguments, cwd=folder)
    assert status == 0
    assert seen.index(b"clouds") < seen.rindex(b"baking")
    assert b"100%" in seen


@pytest.mark.slow
def test_clouds_of_a_frame_depend_on_its_time_alone(folder):
    few_voxels(folder)
    moving = ("--clouds", LAYER, "--cloud-time", "0s..20s", "--frames", "1-3", "--sun", "30deg")
    assert sequence(*moving, "-o", "a.#.exr")["baked"] == 3
    before = digests("a.*.exr")
    assert len(set(before.values())) == 3
    Path("a.0002.exr").unlink()
    told = sequence(*moving, "-o", "a.#.exr", "--skip-existing")
    assert (told["baked"], told["skipped"]) == (1, 2)
    assert digests("a.*.exr") == before


@pytest.mark.slow
def test_a_frame_shows_the_clouds_of_a_map_at_its_time(folder):
    few_voxels(folder)
    clouds = ("--clouds", LAYER, "--method", "hillaire")
    moving = ("--clouds", LAYER, "--cloud-time", "0s..20s", "--frames", "1-3", "--sun", "30deg")
    sequence(*moving, "-o", "a.#.exr")
    arguments = (*SMALL, *clouds, "--cloud-time", "10s", "--sun", "30deg", "-q", "-o", "b.exr")
    assert run("render", *arguments, cwd=folder)[0] == 0
    frame, lone = (read_image(Path(name))[0] for name in ("a.0002.exr", "b.exr"))
    np.testing.assert_array_equal(frame, lone)
