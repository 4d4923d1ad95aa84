"""Whose files are read, and who can read and write ours."""

import os
import signal
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from skybake.jit.private_folder import NotPrivateError, open_private_folder

OTHER = 65534
PACKAGES = str(Path(open_private_folder.__code__.co_filename).parents[2])

needs_root = pytest.mark.skipif(os.getuid() != 0, reason="only root can give files away")


@pytest.fixture
def umask():
    def change(mask):
        os.umask(mask)

    before = os.umask(0o022)
    yield change
    os.umask(before)


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


@pytest.mark.parametrize("mask", [0, 0o002, 0o022, 0o077, 0o777])
def test_files_and_folders_are_for_their_owner_alone_whatever_the_umask(tmp_path, umask, mask):
    path = tmp_path / "home" / "cache" / "kernels"
    umask(mask)
    folder = open_private_folder(path)
    folder.write("a", b"content")
    folder.within("tables").write("b", b"content")
    assert [mode(each) for each in (path.parents[1], path.parent, path, path / "tables")] == [
        0o700
    ] * 4
    assert mode(path / "a") == mode(path / "tables" / "b") == 0o600


@pytest.mark.parametrize("bits", [0o770, 0o707, 0o777, 0o1777])
@pytest.mark.parametrize("level", ["", "cache", "cache/kernels"])
def test_what_the_group_or_others_may_write_to_is_refused_at_any_level(tmp_path, bits, level):
    path = tmp_path / "home" / "cache" / "kernels"
    path.mkdir(parents=True)
    shared = tmp_path / "home" / level
    shared.chmod(bits)
    if bits == 0o1777 and shared != path and os.getuid() == 0:
        open_private_folder(path)  # root's and sticky, as /tmp is
        return
    with pytest.raises(NotPrivateError, match=f"{shared} has mode {bits:04o}"):
        open_private_folder(path)


@needs_root
@pytest.mark.parametrize("level", ["home", "home/cache", "home/cache/kernels"])
def test_what_belongs_to_another_user_is_refused_at_any_level(tmp_path, level):
    path = tmp_path / "home" / "cache" / "kernels"
    path.mkdir(parents=True, mode=0o700)
    os.chown(tmp_path / level, OTHER, OTHER)
    with pytest.raises(NotPrivateError, match=f"{tmp_path / level} belongs to user {OTHER}"):
        open_private_folder(path)


def test_links_are_followed_to_a_place_that_is_judged(tmp_path):
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared").chmod(0o777)
    (tmp_path / "private").mkdir(mode=0o700)
    for name in ("shared", "private"):
        (tmp_path / f"to-{name}").symlink_to(tmp_path / name)
    assert open_private_folder(tmp_path / "to-private" / "a").path == tmp_path / "private" / "a"
    with pytest.raises(NotPrivateError):
        open_private_folder(tmp_path / "to-shared" / "a")


def test_a_folder_that_is_exchanged_after_it_was_opened_is_not_read(tmp_path):
    folder = open_private_folder(tmp_path / "kernels")
    folder.write("a", b"ours")
    (tmp_path / "kernels").rename(tmp_path / "away")
    (tmp_path / "kernels").mkdir()
    (tmp_path / "kernels" / "a").write_bytes(b"theirs")
    assert folder.read("a") == b"ours"
    assert folder.is_open()


def test_a_folder_that_was_removed_is_no_longer_open(tmp_path):
    folder = open_private_folder(tmp_path / "kernels")
    (tmp_path / "kernels").rmdir()
    assert not folder.is_open()


def test_a_link_in_place_of_a_file_is_not_read(tmp_path):
    folder = open_private_folder(tmp_path / "kernels")
    (tmp_path / "elsewhere").write_bytes(b"theirs")
    (tmp_path / "kernels" / "a").symlink_to(tmp_path / "elsewhere")
    assert folder.read("a") is None
    folder.write("a", b"ours")
    assert folder.read("a") == b"ours"
    assert (tmp_path / "elsewhere").read_bytes() == b"theirs"


@pytest.mark.parametrize("bits", [0o620, 0o602, 0o666])
def test_a_file_that_others_may_write_to_is_not_read(tmp_path, bits):
    folder = open_private_folder(tmp_path)
    folder.write("a", b"content")
    (tmp_path / "a").chmod(bits)
    assert folder.read("a") is None


@needs_root
def test_a_file_of_another_user_is_not_read(tmp_path):
    folder = open_private_folder(tmp_path)
    folder.write("a", b"content")
    os.chown(tmp_path / "a", OTHER, OTHER)
    assert folder.read("a") is None


def test_a_pipe_or_a_folder_in_place_of_a_file_is_not_waited_for(tmp_path):
    folder = open_private_folder(tmp_path)
    os.mkfifo(tmp_path / "pipe", 0o600)
    (tmp_path / "folder").mkdir()
    assert folder.read("pipe") is None
    assert folder.read("folder") is None
    assert folder.read("missing") is None


WRITE_FOR_EVER = """
import sys
from pathlib import Path
from skybake.jit.private_folder import open_private_folder
folder = open_private_folder(Path(sys.argv[1]))
with folder._temporary() as (name, descriptor):
    print(name, flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def writer(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", WRITE_FOR_EVER, tmp_path],
        env=os.environ | {"PYTHONPATH": PACKAGES},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    yield process, process.stdout.readline().strip()
    process.kill()
    process.communicate()


def test_what_a_killed_writer_left_goes_when_the_folder_is_opened_next(tmp_path, writer):
    process, name = writer
    assert (tmp_path / name).exists()
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert (tmp_path / name).exists()
    open_private_folder(tmp_path)
    assert not (tmp_path / name).exists()


def test_what_is_being_written_stays_when_the_folder_is_opened(tmp_path, writer):
    open_private_folder(tmp_path)
    assert (tmp_path / writer[1]).exists()


@pytest.mark.slow  # by the clock, which other load on the machine disturbs
def test_opening_takes_less_than_a_millisecond(tmp_path):
    path = tmp_path / "kernels"
    open_private_folder(path)

    def duration():
        started = time.perf_counter()
        open_private_folder(path)
        return time.perf_counter() - started

    assert min(duration() for _ in range(50)) < 1e-3
