"""The process that compiles kernels beside one that renders."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import skybake

PACKAGES = Path(skybake.__file__).parents[1]

INTRUDERS = ("llvmlite", "numba", "numpy", "runpy", "click", "skybake", "json")

RENDER = """
import sys
from skybake.__main__ import run
run()
"""


def start(folder, *arguments, code=RENDER, **environment):
    environment = {"SKYBAKE_CACHE_DIR": str(folder / "cache")} | environment
    return subprocess.Popen(
        [sys.executable, "-P", "-c", code, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(PACKAGES), **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


FIRST_RENDER = ("render", "--size", "64x32", "-o", "sky.exr", "-q")


@pytest.mark.slow
def test_no_process_of_a_first_render_runs_a_file_of_the_working_folder(tmp_path):
    for name in INTRUDERS:
        code = f"import pathlib; pathlib.Path(__file__).with_name('{name}.ran').touch()\n"
        (tmp_path / f"{name}.py").write_text(code)
    process = start(tmp_path, *FIRST_RENDER)
    assert process.communicate(timeout=240) == ("", "")
    assert process.returncode == 0
    assert list(tmp_path.rglob("*.ran")) == []


WHERE = """
from skybake.jit.background_compiler import python_command
import json, subprocess, sys
print(subprocess.run(python_command("tell"), capture_output=True, text=True).stdout)
"""


def test_a_module_is_still_found_where_the_environment_says(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "tell.py").write_text("print('found')\n")
    found = os.pathsep.join((str(PACKAGES), str(tmp_path / "elsewhere")))
    process = start(tmp_path, code=WHERE, PYTHONPATH=found)
    assert process.communicate(timeout=60) == ("found\n\n", "")


def test_skybake_is_found_where_its_parent_has_it_though_that_is_the_working_folder(tmp_path):
    """As in a checkout that is not installed."""
    (tmp_path / "skybake").symlink_to(PACKAGES / "skybake")
    code = """
import sys
sys.path.insert(0, "")
from skybake.jit.background_compiler import python_command
import subprocess
print(subprocess.run(python_command("skybake.version"), capture_output=True).returncode)
"""
    process = start(tmp_path, code=code, PYTHONPATH="")
    assert process.communicate(timeout=60) == ("0\n", "")


PARENT = """
from skybake.jit import background_compiler
from pathlib import Path
import time
module = "sleep_for_long"
with background_compiler.compile_in_background(module, frozenset({"none"})):
    print(background_compiler._background._process.pid, flush=True)
    time.sleep(100)
"""

CHILD = """
import os, time
from pathlib import Path
from skybake.jit.background_compiler import end_with_parent
def work():
    Path(os.environ["BEGUN"]).touch()
    time.sleep(100)
end_with_parent(work)
"""


def is_running(process):
    """Whether there is a process of that number that has not ended."""
    try:
        return ") Z " not in Path(f"/proc/{process}/stat").read_text()
    except FileNotFoundError:
        return False


def wait_until(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    return condition()


def test_it_ends_with_its_parent_though_that_is_killed(tmp_path):
    (tmp_path / "sleep_for_long.py").write_text(CHILD)
    begun = tmp_path / "begun"
    process = start(
        tmp_path,
        code=f"from skybake.jit import workers; workers.cpu_count = lambda: 2\n{PARENT}",
        PYTHONPATH=os.pathsep.join((str(PACKAGES), str(tmp_path))),
        BEGUN=str(begun),
    )
    helper = int(process.stdout.readline())
    assert wait_until(begun.exists)
    assert is_running(helper)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    assert wait_until(lambda: not is_running(helper), 5.0)


@pytest.mark.slow
def test_a_killed_first_render_leaves_no_process_and_the_next_run_no_leftovers(tmp_path):
    process = start(tmp_path, *FIRST_RENDER)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    assert wait_until(lambda: children.read_text().strip() != "")
    (helper,) = (int(number) for number in children.read_text().split())
    assert wait_until(lambda: list(tmp_path.rglob("*.kernel")) != [])
    process.send_signal(signal.SIGKILL)
    process.communicate()
    assert wait_until(lambda: not is_running(helper), 5.0)
    process = start(tmp_path, *FIRST_RENDER)
    assert process.communicate(timeout=240) == ("", "")
    assert list((tmp_path / "cache").rglob(".*")) == []
