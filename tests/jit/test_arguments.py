"""Arguments that a version of numba passes in another way are noticed before they are used."""

import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

import skybake
from tests.cli.runs import SMALL, start

PACKAGES = str(Path(skybake.__file__).parents[1])

SWAPPED_FIELDS = """
from numba.core.datamodel import models
first, second = {fields!r}
make = models.StructModel.__init__

def swapped(self, manager, kind, members):
    names = [name for name, _ in members]
    if isinstance(self, models.ArrayModel):
        i, j = names.index(first), names.index(second)
        members[i], members[j] = members[j], members[i]
    make(self, manager, kind, members)

models.StructModel.__init__ = swapped
"""

# The names stay, but words go by others: only a kernel that runs can tell.
SWAPPED_WORDS = """
from numba.core.datamodel import models
pack, unpack = models.StructModel.as_argument, models.StructModel.from_argument

def swapped(self, words):
    if not isinstance(self, models.ArrayModel):
        return words
    return (*words[:2], words[3], words[2], *words[4:])

models.StructModel.as_argument = lambda self, builder, value: swapped(
    self, pack(self, builder, value)
)
models.StructModel.from_argument = lambda self, builder, words: unpack(
    self, builder, swapped(self, words)
)
"""

CALL = """
import numpy as np
from skybake.jit.kernel import kernel

@kernel
def last(values):
    return values[values.size - 1]

print(last(np.arange(5.0)))
"""

VERSIONS = f"numba {version('numba')} with llvmlite {version('llvmlite')}"


def run(code, folder):
    return subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONPATH": PACKAGES, "SKYBAKE_CACHE_DIR": str(folder)},
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )


@pytest.mark.parametrize(
    "fields", [("nitems", "itemsize"), ("shape", "strides"), ("itemsize", "data")]
)
def test_an_array_model_with_other_fields_is_refused(tmp_path, fields):
    result = run(SWAPPED_FIELDS.format(fields=fields) + CALL, tmp_path)
    assert (result.returncode, result.stdout) == (1, "")
    error = result.stderr.splitlines()[-1]
    assert error.startswith(f"skybake.errors.SkybakeError: {VERSIONS}: must pass arguments as ")
    assert not list(tmp_path.rglob("*.kernel"))


def test_a_kernel_that_is_given_other_words_is_refused(tmp_path):
    result = run(SWAPPED_WORDS + CALL, tmp_path)
    assert (result.returncode, result.stdout) == (1, "")
    error = result.stderr.splitlines()[-1]
    assert error.startswith(f"skybake.errors.SkybakeError: {VERSIONS}: must pass arguments of ")
    assert not list(tmp_path.rglob("*.kernel"))
    assert not list(tmp_path.rglob("*.checked"))


def test_a_render_with_such_a_numba_ends_with_one_line(tmp_path):
    code = SWAPPED_FIELDS.format(fields=("nitems", "itemsize"))
    process = start(
        *("render", *SMALL, "-q", "-o", tmp_path / "sky.exr"),
        code=f"{code}\nfrom skybake.cli import run; run()",
        env={"SKYBAKE_CACHE_DIR": str(tmp_path / "cache"), "NUMBA_NUM_THREADS": "1"},
        wrapper=("taskset", "-c", str(min(os.sched_getaffinity(0)))),
    )
    output, errors = process.communicate(timeout=240)
    assert (process.returncode, output) == (1, "")
    assert errors.startswith(f"skybake: {VERSIONS}: must pass arguments as ")
    assert errors.count("\n") == 1
    assert not (tmp_path / "sky.exr").exists()


def test_the_check_is_made_once_for_each_folder_of_kernels(tmp_path):
    assert run(CALL, tmp_path).stdout == "4.0\n"
    (mark,) = tmp_path.rglob("*.checked")
    made = mark.stat().st_mtime_ns
    another = CALL.replace("size - 1", "size - 2")
    assert run(another, tmp_path).stdout == "3.0\n"
    assert mark.stat().st_mtime_ns == made
    assert len(list(tmp_path.rglob("*.kernel"))) == 2
    mark.write_bytes(b"")
    run(CALL.replace("size - 1", "size - 3"), tmp_path)
    assert mark.stat().st_size > 0
