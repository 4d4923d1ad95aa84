"""Kernels called from Python, by way of machine code alone."""

import math
import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numba.core import types

from skybake.jit.arguments import flatten
from skybake.jit.kernel import inlined_kernel, kernel


class Pair(NamedTuple):
    scale: float
    values: np.ndarray


class Nest(NamedTuple):
    count: int
    pair: Pair
    is_negative: bool
    table: np.ndarray


@kernel
def add_up(nest, offset, out):
    """Write to an array what every part of nested arguments has a share in."""
    for i in range(nest.table.shape[0]):
        out[i] = offset
        for j in range(nest.table.shape[1]):
            out[i] += nest.pair.scale * nest.pair.values[j] * nest.table[i, j]
        for _ in range(nest.count):
            out[i] *= 2.0
        if nest.is_negative:
            out[i] = -out[i]


def expected(nest, offset):
    total = offset + nest.pair.scale * (nest.table @ nest.pair.values)
    return (-1 if nest.is_negative else 1) * 2.0**nest.count * total


TABLE = np.arange(12.0).reshape(3, 4)
VALUES = np.array([1.0, -2.0, 0.5, 4.0])
NEST = Nest(2, Pair(0.25, VALUES), True, TABLE)
FORTRAN, SLICED = np.asfortranarray(TABLE), np.arange(48.0).reshape(6, 8)[::2, ::2]


@pytest.mark.parametrize(
    "nest",
    [
        NEST,
        NEST._replace(is_negative=False, count=0),
        NEST._replace(table=FORTRAN),
        NEST._replace(table=SLICED, pair=Pair(-3.0, VALUES[::-1])),
        NEST._replace(table=TABLE.astype(np.float32)),
        NEST._replace(pair=Pair(0.5, VALUES.astype(np.int64))),
        NEST._replace(table=TABLE[:1], pair=Pair(1e300, VALUES)),
        NEST._replace(table=TABLE[:0]),
    ],
)
def test_a_kernel_sees_its_arguments_as_they_are(nest):
    out = np.full(len(nest.table), np.nan)
    assert add_up(nest, 0.125, out) is None
    np.testing.assert_array_equal(out, expected(nest, 0.125))


def test_an_argument_that_was_flattened_stands_for_itself():
    plain, flat, nested = np.empty(3), np.empty(3), np.empty(3)
    add_up(NEST, 0.5, plain)
    add_up(flatten(NEST), 0.5, flatten(flat))
    add_up(Nest(2, flatten(NEST.pair), True, flatten(TABLE)), 0.5, nested)
    np.testing.assert_array_equal(flat, plain)
    np.testing.assert_array_equal(nested, plain)


def test_a_flattened_argument_shows_what_is_written_to_it():
    values, out = VALUES.copy(), np.empty(3)
    nest = flatten(NEST._replace(pair=Pair(1.0, values)))
    values *= 3.0
    add_up(nest, 0.0, out)
    np.testing.assert_allclose(out, -12.0 * TABLE @ VALUES)


def test_what_is_protected_from_writing_can_be_read():
    values = VALUES.copy()
    values.flags.writeable = False
    out = np.empty(3)
    add_up(NEST._replace(pair=Pair(0.25, values)), 0.0, out)
    np.testing.assert_array_equal(out, expected(NEST, 0.0))


@pytest.mark.parametrize(
    ("argument", "result"),
    [(3, 6), (-(2**40), -(2**41)), (np.int64(4), 8), (1.5, 3.0), (-math.inf, -math.inf)],
)
def test_a_kernel_returns_a_number_of_the_right_kind(argument, result):
    @kernel
    def twice(x):
        return x + x

    assert twice(argument) == result
    assert type(twice(argument)) is type(result)


def test_a_kernel_returns_a_truth_value():
    @kernel
    def is_above(x, limit):
        return x > limit

    assert is_above(2.0, 1.0) is True
    assert is_above(1.0, 1.0) is False
    assert is_above(math.nan, 1.0) is False


@kernel
def halve(x):
    """Serve `halve_twice`."""
    return 0.5 * x


@kernel
def halve_twice(x):
    """Call another kernel."""
    return halve(halve(x))


def test_kernels_call_kernels():
    assert halve_twice(8.0) == 2.0
    assert halve(8.0) == 4.0


@pytest.mark.parametrize("argument", [None, "1", [1.0], 1j, {1: 2}, np.float32(1.0)])
def test_arguments_without_a_layout_are_refused(argument):
    with pytest.raises(TypeError, match="kernel: argument must be an array, a number or a tuple"):
        halve(argument)


def test_numbers_of_the_other_byte_order_are_refused():
    other = ">" if sys.byteorder == "little" else "<"
    with pytest.raises(TypeError, match="byte order"):
        add_up(NEST, 0.0, np.empty(3, f"{other}f8"))


def test_kernels_that_make_arrays_are_refused():
    @kernel
    def make(size):
        return np.empty(size).sum()

    with pytest.raises(Exception, match="nopython mode"):
        make(3)


def test_kernels_that_need_numba_to_run_are_refused():
    """Linking them without it would end in a crash."""

    @kernel
    def first_of_reshaped(values):
        return values.reshape((2, 2))[0, 0]

    with pytest.raises(TypeError, match="must do without numba's own functions"):
        first_of_reshaped(np.arange(4.0))


def test_threads_that_meet_a_new_kernel_at_once_all_get_its_result():
    @kernel
    def square(x):
        return x * x

    start = threading.Barrier(4)

    def work(i):
        start.wait()
        return square(float(i))

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(work, range(4))) == [0.0, 1.0, 4.0, 9.0]
    assert len(square._entries) == 1


WARM_RENDER = """
import sys
from pathlib import Path
import skybake
skybake.bake(skybake.load_preset("earth"), Path("sky.exr"), skybake.map_settings(size=64))
loaded = {"numba", "scipy", "colour"} & set(sys.modules)
print(loaded or "none", sum(name.startswith("llvmlite") for name in sys.modules) > 0)
"""


def test_a_render_that_finds_its_kernels_imports_no_compiler(tmp_path):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    for _ in range(2):
        result = subprocess.run(
            [sys.executable, "-c", WARM_RENDER],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
            timeout=240,
        )
    assert result.stdout.split() == ["none", "True"]
    assert Path(tmp_path / "sky.exr").stat().st_size > 0


@pytest.mark.parametrize(("kind", "is_inlined"), [(kernel, False), (inlined_kernel, True)])
def test_kernels_that_call_an_inlined_one_contain_it(kind, is_inlined):
    @kind
    def inner(x):
        return 0.5 * x

    @kernel
    def twice(x):
        return inner(inner(x))

    inner._dispatcher.compile((types.float64,))
    (compiled,) = inner._dispatcher.overloads.values()
    assert ("alwaysinline" in compiled.library.get_llvm_str()) is is_inlined
    assert twice(8.0) == 2.0
