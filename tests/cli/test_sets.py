"""Cubes of six files and their previews, among signals and failing renames."""

import os
import shutil
import signal
import subprocess
import sys

import pytest

from tests.cli.runs import PACKAGES, listing, run
from tests.formats.maps import program

CUBE = ("--projection", "cubemap", "--size", "8", "--method", "hillaire", "--preview")
FACES = ("nx", "ny", "nz", "px", "py", "pz")

COMMANDS = {
    "render": ("render", *CUBE, "--sun", "40deg", "-o", "a.exr"),
    "sequence": ("sequence", *CUBE, "--sun", "40deg", "--frames", "1", "-o", "a.#.exr"),
}


def stem(command):
    return "a.0001" if command == "sequence" else "a"


def names(command):
    """Maps and preview."""
    name = "a.0001_{}.exr" if command == "sequence" else "a_{}.exr"
    return sorted([f"{stem(command)}.png", *(name.format(face) for face in FACES)])


@pytest.fixture(scope="module", params=COMMANDS)
def baked(request, tmp_path_factory):
    """A command, a folder with a set of another sun, and one of what it writes there."""
    command = request.param
    old, new = (tmp_path_factory.mktemp(name) for name in ("old", "new"))
    arguments = COMMANDS[command]
    for folder, sun in ((old, "20deg"), (new, "40deg")):
        status, _, errors = run(*arguments, "--sun", sun, "-q", cwd=folder)
        assert status == 0, errors
    contents = [found(folder, command) for folder in (old, new)]
    assert [len(content) for content in contents] == [7, 7]
    assert not contents[0].items() & contents[1].items()
    return command, *contents


def found(folder, command):
    there = [name for name in names(command) if (folder / name).exists()]
    return {name: (folder / name).read_bytes() for name in there}


def attempt(folder, command, old, fault):
    """Run a command in a folder that holds the old set, with a fault in its system calls."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name, content in old.items():
        (folder / name).write_bytes(content)
    trace = folder.with_name("trace")
    return subprocess.run(
        [
            *(program("strace"), "-f", "-o", trace, "-e", "trace=rename", "-e", f"inject={fault}"),
            *(sys.executable, "-c", "from skybake.cli import run; run()", *COMMANDS[command], "-q"),
        ],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": PACKAGES},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("number", [2, 5])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT"])
def test_a_signal_amid_the_renames_leaves_a_whole_set(tmp_path, baked, number, name):
    command, old, new = baked
    process = attempt(tmp_path / "maps", command, old, f"rename:signal={name}:when={number}")
    assert process.returncode == 128 + getattr(signal, name), process.stderr
    assert found(tmp_path / "maps", command) == new
    assert [one for one in listing(tmp_path / "maps") if one.startswith(".skybake-")] == []


def test_a_rename_that_fails_leaves_the_old_set(tmp_path, baked):
    command, old, _ = baked
    process = attempt(tmp_path / "maps", command, old, "rename:error=EIO:when=4")
    assert process.returncode in {1, 3}
    assert "must be writable, got Input/output error" in process.stderr
    assert listing(tmp_path / "maps") == names(command)
    assert found(tmp_path / "maps", command) == old


def test_a_kill_amid_the_renames_is_mended_by_the_next_run(tmp_path, baked):
    command, old, new = baked
    folder = tmp_path / "maps"
    attempt(folder, command, old, "rename:signal=SIGKILL:when=4")
    assert found(folder, command) not in (old, new)
    # Even by one that fails, of a file too many that has no place.
    status, _, _ = run(*COMMANDS[command], "-q", cwd=folder, wrapper=("prlimit", "--fsize=2000"))
    assert status in {1, 3}
    assert found(folder, command) == old
    status, _, errors = run(*COMMANDS[command], "-q", cwd=folder)
    assert status == 0, errors
    assert found(folder, command) == new
