"""Where kernels are kept between runs, and for how long."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from skybake.jit import cache
from tests.jit.cached_runs import LARGER, SCRIPT, check_that_nothing_is_kept, run


def test_second_process_finds_what_the_first_compiled(tmp_path):
    first, second = (run(tmp_path).stdout.split() for _ in range(2))
    assert first[1:3] == ["False", "True"]
    assert second[1:] == ["True", "True", "1"]
    assert first[0] == second[0]
    assert first[0].startswith(str(tmp_path))


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
