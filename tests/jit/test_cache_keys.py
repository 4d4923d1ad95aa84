"""The folder of kernels is another one after every change that may change them."""

import os
from importlib.metadata import version
from pathlib import Path

import pytest

import skybake
from skybake.jit import cache
from tests.jit.cached_runs import run


@pytest.mark.parametrize("file", ["kernel.py", "part/kernel.py", "part/of/a/part/kernel.py"])
def test_edit_to_a_kernel_at_any_depth_changes_the_folder(tmp_path, monkeypatch, file):
    package = tmp_path / "skybake"
    path = package / "transport" / file
    path.parent.mkdir(parents=True)
    path.write_text("a = 1\n")
    monkeypatch.setattr(cache, "__file__", str(package / "jit" / "cache.py"))
    first = cache.source_hash.__wrapped__("transport")
    path.write_text("a = 2\n")
    assert cache.source_hash.__wrapped__("transport") != first


def is_digested(path):
    """Whether an edit to a file of the package changes the folder of kernels."""
    package = Path(cache.__file__).parents[1]
    return any(path.is_relative_to(package / source) for source in cache.KERNEL_SOURCES)


def test_every_module_with_kernels_counts():
    package = Path(skybake.__file__).parent
    modules = [path for path in package.rglob("*.py") if "\n@kernel\n" in path.read_text()]
    assert package / "scattering" / "field.py" in modules
    assert [path for path in modules if not is_digested(path)] == []
    assert not is_digested(package / "baking" / "write.py")


USED = """
import inspect, sys
from pathlib import Path
import skybake
from skybake.jit import kernel
compiled = []
def note(self, *arguments):
    compiled.append(self.py_func)
    return link(self, *arguments)
link, kernel.Kernel._link = kernel.Kernel._link, note
skybake.bake(skybake.load_preset("earth"), Path(sys.argv[1]), skybake.map_settings(size=16))
functions, known = set(compiled), set()
while functions:
    function = functions.pop()
    known.add(function)
    for value in inspect.getclosurevars(function).globals.values():
        called = getattr(value, "py_func", value)
        if inspect.isfunction(called) and called not in known:
            functions.add(called)
print(*sorted({inspect.getsourcefile(function) for function in known}))
"""


def test_every_kernel_that_a_render_uses_counts(tmp_path):
    """With all that they call, whatever it is decorated with."""
    script = USED.replace("sys.argv[1]", repr(str(tmp_path / "sky.exr")))
    files = run(os.environ["SKYBAKE_CACHE_DIR"], script=script).stdout.split()
    assert {"trace.py", "field.py"} <= {Path(file).name for file in files}
    assert [file for file in files if not is_digested(Path(file))] == []


def test_another_version_of_the_compiler_changes_the_folder(monkeypatch):
    first = cache.source_hash.__wrapped__("transport")
    (name,) = cache._installed("numba")
    assert name.startswith(f"numba-{version('numba')}.")
    monkeypatch.setattr(cache, "_installed", lambda package: [f"{package}-0.0"])
    assert cache.source_hash.__wrapped__("transport") != first
