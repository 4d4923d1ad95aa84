"""What is kept between runs is found again, and made anew where it is damaged."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

import pytest

import skybake
from skybake.jit import cache

SCRIPT = """
import sys
from skybake.jit.cache import cache_folder, is_warm
import numpy as np
from skybake.scattering.harmonics import build_harmonics, fill_harmonics
before = is_warm()
fill_harmonics(build_harmonics(2), 0.5, np.empty(6))
folder = cache_folder()
print(folder and folder.path, before, is_warm(), int("numba" not in sys.modules))
"""


LARGER = """
import numpy as np
from skybake import load_preset
from skybake.scattering.transmittance import build_columns
from skybake.optics.medium import build_medium
build_columns(build_medium(load_preset("earth"), np.array([550.0])), shape=(2, 2), steps=1)
"""


def run(cache=None, *, script=SCRIPT, wrapper=(), **environment):
    if cache is not None:
        environment["SKYBAKE_CACHE_DIR"] = str(cache)
    return subprocess.run(
        [*wrapper, sys.executable, "-W", "always", "-c", script],
        env={"PYTHONPATH": ":".join(sys.path), **environment},
        capture_output=True,
        text=True,
        check=True,
        timeout=240,
    )


def test_second_process_finds_what_the_first_compiled(tmp_path):
    first, second = (run(tmp_path).stdout.split() for _ in range(2))
    assert first[1:3] == ["False", "True"]
    assert second[1:] == ["True", "True", "1"]
    assert first[0] == second[0]
    assert first[0].startswith(str(tmp_path))


@pytest.fixture(scope="module")
def compiled_once(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compiled")
    run(folder)
    return folder


@pytest.fixture
def filled(compiled_once, tmp_path):
    """A cache that holds what `SCRIPT` needs, and the folder of this version in it."""
    shutil.copytree(compiled_once, tmp_path, dirs_exist_ok=True)
    (folder,) = tmp_path.glob("kernels-*")
    return folder


def check_that_nothing_is_kept(result, warning):
    assert result.stdout.split() == ["None", "False", "False", "0"]
    assert result.stderr.count("RuntimeWarning") == 1
    assert warning in result.stderr


@pytest.mark.parametrize("variable", ["SKYBAKE_CACHE_DIR", "NUMBA_CACHE_DIR", "XDG_CACHE_HOME"])
def test_without_a_writable_folder_kernels_run_with_one_warning(tmp_path, variable):
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    result = run(**{variable: str(blocked / "cache")})
    check_that_nothing_is_kept(result, f"{blocked}")
    assert "kernel cache must be writable" in result.stderr


UNPRIVILEGED = ("setpriv", "--bounding-set=-dac_override,-dac_read_search")


def test_in_a_write_protected_folder_kernels_run_with_one_warning(tmp_path):
    """Root may write everywhere, unless a capability is taken from it."""
    tmp_path.chmod(0o555)
    result = run(tmp_path, wrapper=() if os.getuid() else UNPRIVILEGED)
    check_that_nothing_is_kept(result, "kernel cache must be writable")


def test_a_folder_that_root_filled_is_read_by_all(tmp_path, filled):
    """As a container's users do what `skybake cache warm` left in its image."""
    filled.chmod(0o555)
    bound = () if os.getuid() else UNPRIVILEGED
    result = run(tmp_path, wrapper=bound)
    assert result.stdout.split() == [str(filled), "True", "True", "1"]
    assert result.stderr == ""
    missing = run(tmp_path, wrapper=bound, script=LARGER)
    assert missing.stderr.count("RuntimeWarning") == 1
    assert f"{filled}: kernel cache must be writable" in missing.stderr


HOMELESS = """
import pwd
def unknown(user):
    raise KeyError(user)
pwd.getpwuid = unknown
"""


def test_without_a_home_kernels_run_with_one_warning():
    """As a user whom the system does not know, which containers have."""
    result = run(script=HOMELESS + SCRIPT)
    check_that_nothing_is_kept(result, "must be set where there is no home folder")


def test_a_home_holds_the_cache_unless_the_desktop_says_where(tmp_path):
    home = run(HOME=str(tmp_path / "home")).stdout.split()[0]
    desktop = run(HOME="/nowhere", XDG_CACHE_HOME=str(tmp_path / "xdg")).stdout.split()[0]
    assert Path(home).parent == tmp_path / "home" / ".cache" / "skybake"
    assert Path(desktop).parent == tmp_path / "xdg" / "skybake"


@pytest.mark.parametrize(
    ("platform", "variables", "expected"),
    [
        ("darwin", {}, "/home/Library/Caches/skybake"),
        ("darwin", {"XDG_CACHE_HOME": "/xdg"}, "/xdg/skybake"),
        ("win32", {}, "/home/AppData/Local/skybake"),
        ("win32", {"LOCALAPPDATA": "/local"}, "/local/skybake"),
    ],
)
def test_other_platforms_keep_caches_where_they_are_used_to(
    monkeypatch, platform, variables, expected
):
    monkeypatch.setenv("HOME", "/home")
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys, "platform", platform)
    assert cache._user_cache() == Path(expected)


@pytest.mark.parametrize("small_disk", ["size=64k,nr_inodes=64"], indirect=True)
@pytest.mark.parametrize("room", [0, 4096])
def test_on_a_full_disk_kernels_run_with_one_warning(small_disk, room):
    """Without any room, or with room for a part of a kernel."""
    small_disk.chmod(0o755)  # a new file system may be written to by all
    folder = small_disk / f"kernels-{cache.source_hash(*cache.KERNEL_SOURCES)}"
    folder.mkdir(mode=0o700)
    (small_disk / "ballast").write_bytes(bytes(shutil.disk_usage(small_disk).free - room))
    result = run(small_disk, script=LARGER + SCRIPT)
    assert result.stdout.split()[0] == str(folder)
    assert result.stdout.split()[-1] == "0"
    assert result.stderr.count("RuntimeWarning") == 1
    assert "kernel cache must have room" in result.stderr


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


def only_file(folder, suffix):
    (path,) = folder.rglob(f"*{suffix}")
    return path


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


READ_AS_ANOTHER_USER = """
import os
from skybake.jit import cache
from skybake.jit.private_folder import open_private_folder
path = cache.cache_folder().path
cache.cache_folder().write("a.kernel", b"content")
before = path.parent.stat().st_mode & 0o777
cache.share_cache()
child = os.fork()
if child == 0:
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)
    folder = open_private_folder(path)
    readable = folder.read("a.kernel") == b"content"
    try:
        folder.write("b.kernel", b"content")
    except OSError:
        os._exit(7 if readable else 1)
print(oct(before), os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


@pytest.mark.skipif(os.getuid() != 0, reason="only root can become another user")
def test_what_root_shares_is_read_but_not_written_by_others():
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        result = run(Path(folder) / "cache", script=READ_AS_ANOTHER_USER)
    assert (result.stdout, result.stderr) == ("0o700 7\n", "")


def test_nothing_that_a_process_leaves_can_be_read_by_others(tmp_path):
    run(tmp_path / "cache", script="import os; os.umask(0)" + LARGER + SCRIPT)
    for path in [tmp_path / "cache", *(tmp_path / "cache").rglob("*")]:
        assert path.stat().st_mode & 0o777 == (0o700 if path.is_dir() else 0o600), path


def test_no_module_of_ours_unpickles():
    package = Path(skybake.__file__).parent
    banned = re.compile(r"^\s*(import|from) (pickle|marshal|shelve|dill|cloudpickle)\b", re.M)
    found = [path for path in package.rglob("*.py") if banned.search(path.read_text())]
    assert found == []


def test_a_folder_that_others_may_write_to_is_not_used(tmp_path, filled):
    """Who can write there could have us run what they like."""
    filled.chmod(0o777)
    result = run(tmp_path)
    check_that_nothing_is_kept(result, "writable for its owner only")


def test_a_folder_is_private_whatever_the_umask(tmp_path):
    result = run(tmp_path, script="import os; os.umask(0)" + SCRIPT)
    assert Path(result.stdout.split()[0]).stat().st_mode & 0o022 == 0


def test_folders_of_other_versions_go_when_they_are_unused_for_long(tmp_path):
    old, recent, other = (tmp_path / name for name in ("kernels-old", "kernels-new", "notes"))
    for folder in (old, recent, other):
        folder.mkdir()
    long_ago = time.time() - 31 * 86400
    os.utime(old, (long_ago, long_ago))
    os.utime(other, (long_ago, long_ago))
    run(tmp_path)
    assert not old.exists()
    assert recent.exists()
    assert other.exists()


def test_use_keeps_a_folder_from_going(tmp_path, filled):
    long_ago = time.time() - 31 * 86400
    os.utime(filled, (long_ago, long_ago))
    run(tmp_path)
    assert time.time() - filled.stat().st_mtime < 3600


def test_processes_that_are_all_cold_all_succeed(tmp_path):
    environment = {"PYTHONPATH": ":".join(sys.path), "SKYBAKE_CACHE_DIR": str(tmp_path)}
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", SCRIPT],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for _ in range(2)
    ]
    for process in processes:
        output, errors = process.communicate(timeout=120)
        assert (process.returncode, errors) == (0, "")
        assert output.split()[2] == "True"
    assert run(tmp_path).stdout.split()[-1] == "1"
    assert not list(tmp_path.rglob(".*"))
