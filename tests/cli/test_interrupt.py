"""Ctrl-C while the program is still being imported."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.runs import PACKAGES

# Stops the import of a module, as Ctrl-C may at any of them.
INTERRUPTED = """
import os, signal, sys, time
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == {name!r}:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(10)
sys.meta_path.insert(0, Finder())
import runpy
sys.argv = ["skybake", "render", "--size", "64x32", "-o", "sky.exr"]
runpy.run_module("skybake", run_name="__main__", alter_sys=True)
"""


@pytest.mark.parametrize(
    "name",
    ["skybake.cli", "click", "skybake.commands.memory", "skybake.commands.render", "numpy",
     "OpenImageIO", "llvmlite.binding"],
)  # fmt: skip
def test_an_interrupt_during_imports_is_one_line(tmp_path, name):
    result = subprocess.run(
        [sys.executable, "-c", INTERRUPTED.format(name=name)],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": PACKAGES},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert (result.returncode, result.stdout) == (128 + signal.SIGINT, "")
    assert result.stderr.strip().splitlines() == ["skybake: interrupted"]
    assert not Path(tmp_path / "sky.exr").exists()
