import os
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import numba
import numpy as np
import pytest

from skybake.transport import kernel as kernels
from skybake.transport.kernel import run_rows, thread_count


@pytest.mark.parametrize("chunk", [1, 3, 7, 100])
@pytest.mark.parametrize("rows", [0, 1, 10, 64])
def test_every_row_is_worked_on_once(rows, chunk):
    visits = np.zeros(rows, int)

    def work(first, last):
        visits[first:last] += 1

    run_rows(rows, work, chunk=chunk)
    assert (visits == 1).all()


def test_work_that_fails_tells_its_caller():
    def work(first, last):
        if first == 3:
            raise ArithmeticError("row 3")

    with pytest.raises(ArithmeticError, match="row 3"):
        run_rows(8, work)


def test_rows_within_rows_do_not_wait_for_themselves():
    done = []

    def outer(first, last):
        run_rows(4, lambda a, b: done.append((first, a)))

    worker = threading.Thread(target=run_rows, args=(2 * thread_count() + 2, outer), daemon=True)
    worker.start()
    worker.join(timeout=20.0)
    assert not worker.is_alive()
    assert len(set(done)) == 4 * (2 * thread_count() + 2)


SCRIPT = """
import sys
from skybake.transport.kernel import cache_directory, is_warm
import numpy as np
from skybake.luts.harmonics import build_harmonics, fill_harmonics
before = is_warm()
fill_harmonics(build_harmonics(2), 0.5, np.empty(6))
print(cache_directory(), before, is_warm(), sum(fill_harmonics.stats.cache_hits.values()))
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
        timeout=120,
    )


def test_second_process_finds_what_the_first_compiled(tmp_path):
    first, second = (run(tmp_path).stdout.split() for _ in range(2))
    assert first[1:3] == ["False", "True"]
    assert second[1:] == ["True", "True", "1"]
    assert first[0] == second[0]
    assert first[0].startswith(str(tmp_path))


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


def test_in_a_write_protected_folder_kernels_run_with_one_warning(tmp_path):
    """Root may write everywhere, unless a capability is taken from it."""
    tmp_path.chmod(0o555)
    bound = () if os.getuid() else ("setpriv", "--bounding-set=-dac_override,-dac_read_search")
    result = run(tmp_path, wrapper=bound)
    check_that_nothing_is_kept(result, "kernel cache must be writable")


HOMELESS = """
import pwd
def unknown(user):
    raise KeyError(user)
pwd.getpwuid = unknown
"""


def test_without_a_home_kernels_run_with_one_warning():
    """As a user whom the system does not know, which containers have."""
    result = run(script=HOMELESS + SCRIPT)
    check_that_nothing_is_kept(result, "kernel cache must be given without a home folder")


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
    assert kernels._user_cache() == Path(expected)


@pytest.mark.parametrize("room", [0, 40_000])
def test_on_a_full_disk_kernels_run_with_one_warning(tmp_path, room):
    """Without room for numba's folders, or for its files."""
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k,nr_inodes=64", "tmpfs", str(tmp_path)]
    if subprocess.run(mount, check=False, capture_output=True).returncode:
        pytest.skip("mounting a small file system needs root")
    try:
        cache = tmp_path / f"kernels-{kernels._source_hash()}"
        cache.mkdir()
        (tmp_path / "ballast").write_bytes(bytes(shutil.disk_usage(tmp_path).free - room))
        result = run(tmp_path)
    finally:
        subprocess.run(["umount", str(tmp_path)], check=True)
    assert result.stdout.split()[0] == str(cache)
    assert result.stdout.split()[-1] == "0"
    assert result.stderr.count("RuntimeWarning") == 1
    assert "kernel cache must have room" in result.stderr


def test_cache_of_other_users_of_numba_stays_where_it_was():
    before = numba.config.CACHE_DIR
    kernels.kernel(lambda x: x)
    assert before == numba.config.CACHE_DIR


def test_edit_to_any_kernel_source_changes_the_folder(tmp_path, monkeypatch):
    folder = tmp_path / "skybake" / "transport"
    folder.mkdir(parents=True)
    (folder / "kernel.py").write_text("a = 1\n")
    monkeypatch.setattr(kernels, "__file__", str(folder / "kernel.py"))
    first = kernels._source_hash.__wrapped__()
    (folder / "kernel.py").write_text("a = 2\n")
    assert kernels._source_hash.__wrapped__() != first
