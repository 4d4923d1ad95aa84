"""Processes that are forked after their parent has baked, or while it does."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import skybake

PACKAGES = str(Path(skybake.__file__).parents[1])

AFTER_A_BAKE = """
import multiprocessing, sys, warnings
from pathlib import Path
import skybake
warnings.filterwarnings("ignore", category=DeprecationWarning)

def bake(name):
    skybake.bake(skybake.load_preset("earth"), Path(name), skybake.map_settings(size=64))

bake("parent.exr")
children = multiprocessing.get_context("fork").Pool(2)
children.map_async(bake, [f"child{i}.exr" for i in range(3)]).get(60)
children.terminate()
"""

WHILE_KERNELS_COMPILE = """
import multiprocessing, threading, time, warnings
from skybake.jit.kernel import Kernel, kernel
warnings.filterwarnings("ignore", category=DeprecationWarning)

@kernel
def square(x):
    return x * x

@kernel
def cube(x):
    return x * x * x

def use(results):
    results.put((square(3.0), cube(3.0)))

begun = threading.Event()
compile_it = Kernel._compile

def note(self, *arguments):
    begun.set()
    return compile_it(self, *arguments)

Kernel._compile = note
thread = threading.Thread(target=square, args=(2.0,))
thread.start()
begun.wait()
context = multiprocessing.get_context("fork")
results = context.Queue()
child = context.Process(target=use, args=(results,))
child.start()
print(results.get(timeout=150))
child.join(60)
thread.join()
"""

WHILE_AN_ATMOSPHERE_IS_BUILT = """
import multiprocessing, threading, time, warnings
import numpy as np
from skybake.scattering import atmosphere
from tests.media import plain_medium
warnings.filterwarnings("ignore", category=DeprecationWarning)
medium = plain_medium(lambda h: np.exp(-h / 8.0), [0.01, 0.05])
build = atmosphere.build_atmosphere
begun, go_on = threading.Event(), threading.Event()

def wait_and_build(*arguments):
    begun.set()
    go_on.wait()
    return build(*arguments)

def load(results):
    atmosphere.build_atmosphere = build
    results.put(atmosphere.load_atmosphere(medium, "hillaire").shells.size)

atmosphere.build_atmosphere = wait_and_build
thread = threading.Thread(
    target=atmosphere.load_atmosphere, args=(medium, "hillaire"), daemon=True
)
thread.start()
begun.wait()
context = multiprocessing.get_context("fork")
results = context.Queue()
with atmosphere._recent._lock:
    child = context.Process(target=load, args=(results,))
    child.start()
print(results.get(timeout=150) > 1)
child.join(60)
go_on.set()
thread.join()
"""


def run(script, folder, **environment):
    # From a file: a process of multiprocessing looks for what it shall run in its main module.
    path = folder / "main.py"
    path.write_text(script)
    return subprocess.run(
        [sys.executable, path],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": f"{PACKAGES}:{Path.cwd()}"} | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )


@pytest.fixture
def cold(tmp_path):
    return {"SKYBAKE_CACHE_DIR": str(tmp_path / "cache")}


def test_children_of_a_process_that_has_baked_bake_the_same(tmp_path):
    result = run(AFTER_A_BAKE, tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    maps = {path.read_bytes() for path in tmp_path.glob("*.exr")}
    assert len(list(tmp_path.glob("*.exr"))) == 4
    assert len(maps) == 1


def test_a_child_that_is_forked_while_a_kernel_compiles_compiles_its_own(tmp_path, cold):
    result = run(WHILE_KERNELS_COMPILE, tmp_path, **cold)
    assert (result.returncode, result.stdout, result.stderr) == (0, "(9.0, 27.0)\n", "")


@pytest.mark.slow
def test_a_child_that_is_forked_while_an_atmosphere_is_built_builds_its_own(tmp_path, cold):
    result = run(WHILE_AN_ATMOSPHERE_IS_BUILT, tmp_path, **cold)
    assert (result.returncode, result.stdout, result.stderr) == (0, "True\n", "")
