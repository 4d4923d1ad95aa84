"""A first render, whose kernels two processes compile."""

import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from skybake.baking.late_kernels import KERNELS


def render(folder, **environment):
    command = [sys.executable, "-m", "skybake", "render", "--size", "64x32", "-o", "sky.exr"]
    return subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, "SKYBAKE_CACHE_DIR": str(folder / "cache"), **environment},
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )


@pytest.mark.slow
def test_first_render_compiles_each_kernel_for_one_set_of_types(tmp_path):
    """Two sets would mean that the other process has compiled for nothing."""
    result = render(tmp_path, PYTHONPATH=str(Path.cwd()))
    assert result.returncode == 0, result.stderr
    assert result.stderr.count("compiling kernels") == 1
    compiled = Counter(path.name.split("-")[0] for path in tmp_path.rglob("*.kernel"))
    assert {name: count for name, count in compiled.items() if count > 1} == {}
    assert set(compiled) >= {kernel.py_func.__name__ for kernel in KERNELS}
    again = render(tmp_path, PYTHONPATH=str(Path.cwd()))
    assert again.returncode == 0
    assert "compiling" not in again.stderr
    assert Counter(path.name.split("-")[0] for path in tmp_path.rglob("*.kernel")) == compiled


def test_kernels_of_a_process_that_failed_are_compiled_by_who_needs_them(tmp_path):
    script = """
import numpy as np
from skybake.scattering.harmonics import build_harmonics, fill_harmonics
from skybake.jit.background_compiler import compile_in_background
with compile_in_background("skybake.no_such_module", frozenset({"fill_harmonics"})):
    fill_harmonics(build_harmonics(1), 0.5, out := np.empty(3))
print(out[0] > 0.0)
"""
    result = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "SKYBAKE_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(Path.cwd())},
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    assert (result.stdout, result.stderr) == ("True\n", "")
