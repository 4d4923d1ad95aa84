"""A kernel on disk is used only where it is whole and the one that is meant."""

from tests.jit.cached_runs import run


def half(whole):
    return whole[: len(whole) // 2]


def with_another_bit(whole):
    middle = len(whole) // 2
    return whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]


def test_a_damaged_kernel_is_compiled_anew(tmp_path, filled):
    path = next(filled.rglob("fill_harmonics-*.kernel"))
    whole = path.read_bytes()
    for damaged in (b"", b"foreign", half(whole), with_another_bit(whole)):
        path.write_bytes(damaged)
        result = run(tmp_path)
        assert result.stdout.split()[1:] == ["True", "True", "0"]
        assert result.stderr == ""
        assert path.read_bytes() != damaged
    assert run(tmp_path).stdout.split()[-1] == "1"


TWO_KERNELS = """
import sys
from skybake.jit.kernel import kernel

@kernel
def twice(x):
    return 2.0 * x

@kernel
def last(values):
    return values[values.size - 1]

import numpy as np
print(twice(4.0), twice(4), last(np.arange(3.0)), int("numba" not in sys.modules))
"""


def test_a_kernel_under_the_name_of_another_is_compiled_anew(tmp_path):
    """Of another function, or of the same one for other types."""
    assert run(tmp_path, script=TWO_KERNELS).stdout.split() == ["8.0", "8.0", "2.0", "0"]
    kernels = sorted(tmp_path.rglob("*.kernel"))
    assert len(kernels) == 3
    contents = [path.read_bytes() for path in kernels]
    for path, content in zip(kernels, contents[1:] + contents[:1], strict=True):
        path.write_bytes(content)
    assert run(tmp_path, script=TWO_KERNELS).stdout.split() == ["8.0", "8.0", "2.0", "0"]
    assert run(tmp_path, script=TWO_KERNELS).stdout.split() == ["8.0", "8.0", "2.0", "1"]


def test_a_kernel_for_another_processor_is_compiled_anew(tmp_path):
    run(tmp_path, script=TWO_KERNELS, NUMBA_CPU_NAME="generic", NUMBA_CPU_FEATURES="")
    others = sorted(tmp_path.rglob("*.kernel"))
    run(tmp_path, script=TWO_KERNELS)
    ours = sorted(set(tmp_path.rglob("*.kernel")) - set(others))
    assert len(ours) == len(others) == 3
    for mine, other in zip(ours, others, strict=True):
        mine.write_bytes(other.read_bytes())
    assert run(tmp_path, script=TWO_KERNELS).stdout.split()[-1] == "0"
