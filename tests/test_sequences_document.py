"""Every command of docs/sequences.md runs."""

import os
import re
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from skybake.formats.reader import read_image
from tests.cli.runs import installed

TEXT = (Path(__file__).parents[1] / "docs" / "sequences.md").read_text("utf-8")
SCRIPTS = re.findall(r"^```sh\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)

SMALLER = """
import json, subprocess, sys

words = [*sys.argv[1:], "--size", "64x32", "--method", "hillaire"]
skybake = [sys.executable, "-m", "skybake"]
if "--only" in words:
    part = words.index("--only") + 1
    words[part] = words[part].partition("-")[0]
elif not {"--dry-run", "--emit-commands", "--emit-openjd"} & set(words):
    plan = subprocess.check_output([*skybake, *words, "--dry-run", "--json"])
    numbers = [frame["frame"] for frame in json.loads(plan)["frames"]]
    words += ["--only", f"{numbers[0]},{numbers[-1]}"]
sys.exit(subprocess.call([*skybake, *words]))
"""
"""Bakes the first and the last frame of a sequence, small and by the quickest method."""


@pytest.fixture
def shell(tmp_path):
    """Run a script in an empty folder and end all that it has started."""
    (tmp_path / "smaller.py").write_text(SMALLER)
    environment = installed(tmp_path / "bin", f'exec {sys.executable} {tmp_path}/smaller.py "$@"')
    folder = tmp_path / "empty"
    folder.mkdir()

    def run(script):
        # Into a file: a pipe would stay open as long as anything in the background.
        with (tmp_path / "log").open("w") as log:
            process = subprocess.Popen(
                ["/bin/sh", "-ec", script],
                cwd=folder,
                env=environment,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        try:
            status = process.wait(timeout=240)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        assert status == 0, (tmp_path / "log").read_text()

    run.folder = folder
    return run


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@pytest.mark.parametrize("script", SCRIPTS)
def test_every_command_of_the_document_runs(shell, script):
    assert "skybake sequence " in script
    shell(script.replace("8786", str(free_port())))
    made = sorted(shell.folder.rglob("*"))
    for path in made:
        if path.suffix == ".exr":
            read_image(path)
    frames = [path for path in made if path.suffix == ".exr"]
    if "--dry-run" in script:
        assert not made
    elif "--emit-openjd" in script:
        assert [path.name for path in made] == ["job", "template.json"]
    else:
        sequences = script.count("skybake sequence ")
        assert len(frames) == 2 * sequences
    for sheet in re.findall(r"--contact-sheet (\S+)", script):
        assert (shell.folder / sheet).is_file()


def test_its_pictures_are_of_its_commands():
    sheets = set(re.findall(r"--contact-sheet (\S+)", TEXT))
    assert sheets == set(re.findall(r"\(images/(\S+)\)", TEXT))
