import errno
import os
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

import numpy as np
import pytest

from skybake.errors import OutputError
from skybake.formats.whole_files import replace_when_whole
from skybake.formats.writer import open_map
from tests.formats.maps import listing, map_spec, sky, write_map

OLD = b"what was here before"
REPOSITORY = Path(__file__).parents[2]

SUFFIXES = pytest.mark.parametrize("suffix", [".exr", ".hdr"])


def run(code, *arguments):
    """Run Python code in a process of its own, which can write maps."""
    prelude = """
        import os, resource, sys, time
        from pathlib import Path
        import numpy as np
        from skybake.errors import OutputError
        from tests.formats.maps import map_spec, sky, write_map
        from skybake.formats.half import half_rows
        from skybake.formats.writer import open_map
        path = Path(sys.argv[1])
    """
    return subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(prelude) + textwrap.dedent(code), *arguments],
        cwd=REPOSITORY,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def write_until(path, error):
    with open_map(path, map_spec()) as writer:
        writer.write_rows(0, 16, sky()[:16])
        raise error


@SUFFIXES
@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, OutputError])
def test_an_interrupted_map_leaves_the_old_file_and_nothing_else(tmp_path, suffix, error):
    path = tmp_path / f"a{suffix}"
    path.write_bytes(OLD)

    with pytest.raises(error):
        write_until(path, error)
    assert path.read_bytes() == OLD
    assert listing(tmp_path) == [path.name]


@SUFFIXES
def test_the_target_does_not_appear_before_the_last_row(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    with open_map(path, map_spec()) as writer:
        for y in range(0, 64, 16):
            writer.write_rows(y, y + 16, sky()[y : y + 16])
            assert not path.exists()
            (folder,) = tmp_path.iterdir()
            assert folder.name.startswith(".skybake-")
            assert [Path(name).suffix for name in listing(folder)] == [suffix]

    assert listing(tmp_path) == [path.name]


@SUFFIXES
def test_a_killed_process_leaves_no_target(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    process = run(
        """
        with open_map(path, map_spec()) as writer:
            writer.write_rows(0, 16, sky()[:16])
            print("writing", flush=True)
            time.sleep(60)
        """,
        str(path),
    )
    assert process.stdout.readline() == "writing\n"
    process.send_signal(signal.SIGKILL)
    process.communicate()

    assert not path.exists()
    left = listing(tmp_path)
    assert [name[:9] for name in left] == [".skybake-"]
    write_map(tmp_path / f"b{suffix}", sky())
    assert listing(tmp_path) == [*left, f"b{suffix}"]
    write_map(path, sky())
    assert listing(tmp_path) == [path.name, f"b{suffix}"]


@SUFFIXES
def test_a_living_process_keeps_what_it_writes(tmp_path, suffix):
    """While another writes the same target and ends first."""
    path = tmp_path / f"a{suffix}"
    process = run(
        """
        with open_map(path, map_spec()) as writer:
            writer.write_rows(0, 64, sky())
            print("writing", flush=True)
            sys.stdin.readline()
        """,
        str(path),
    )
    assert process.stdout.readline() == "writing\n"
    other = 2.0 * sky()
    write_map(path, other)
    others = path.read_bytes()
    _, errors = process.communicate("go on\n", timeout=60)

    assert process.returncode == 0, errors
    write_map(tmp_path / f"b{suffix}", sky())
    assert path.read_bytes() == (tmp_path / f"b{suffix}").read_bytes() != others
    assert listing(tmp_path) == [path.name, f"b{suffix}"]


def test_a_file_system_without_locks_is_written_and_nothing_is_taken_for_a_leftover(
    tmp_path, monkeypatch
):
    def refuse(descriptor, operation):
        raise OSError(errno.EBADF, "Bad file descriptor")

    path = tmp_path / "a.exr"
    write_map(path, sky())  # compiles what the cache of kernels would have to lock
    monkeypatch.setattr("fcntl.flock", refuse)
    with open_map(path, map_spec()) as writer:
        writer.write_rows(0, 64, sky())
        write_map(path, sky())
    assert listing(tmp_path) == ["a.exr"]


@SUFFIXES
@pytest.mark.parametrize("missing", [1, 10, 4000, 4097, 20000, 90000])
def test_a_file_that_cannot_grow_to_its_end_is_an_error_and_no_file(tmp_path, suffix, missing):
    """Limits just below the size: the library loses its last block without a word."""
    whole = tmp_path / f"whole{suffix}"
    rows = np.random.default_rng(0).random((128, 256, 3), dtype=np.float32)
    write_map(whole, rows)
    size = whole.stat().st_size
    whole.unlink()
    process = run(
        """
        limit = int(sys.argv[2])
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        rows = np.random.default_rng(0).random((128, 256, 3), dtype=np.float32)
        try:
            write_map(path, rows)
        except OutputError as error:
            print(error)
        """,
        str(tmp_path / f"a{suffix}"),
        str(size - missing),
    )
    output, errors = process.communicate(timeout=60)

    problems = "must be ", "cannot be "
    assert output.startswith(tuple(f"{tmp_path}/a{suffix}: {each}" for each in problems)), errors
    assert output.count("\n") == 1
    assert listing(tmp_path) == []


@SUFFIXES
@pytest.mark.parametrize("small_disk", ["size=1m"], indirect=True)
@pytest.mark.parametrize("fraction", [0.1, 0.5, 0.99, 0.999])
def test_a_full_disk_is_named_and_the_old_file_stays(small_disk, suffix, fraction):
    path = small_disk / f"a{suffix}"
    path.write_bytes(OLD)
    rows = np.random.default_rng(0).random((256, 512, 3), dtype=np.float32)
    other = small_disk.parent / path.name
    write_map(other, rows)
    room = int(other.stat().st_size * fraction)
    (small_disk / "ballast").write_bytes(bytes(shutil.disk_usage(small_disk).free - room))

    with pytest.raises(
        OutputError, match=rf"^{path}: (cannot be written completely:|must be writable, got)"
    ):
        write_map(path, rows)
    assert path.read_bytes() == OLD
    assert listing(small_disk) == [path.name, "ballast"]


def test_after_a_failed_write_further_rows_fail_too_and_nothing_hangs(tmp_path):
    """OpenEXR 3.5 waits for ever in a write that follows a failed one."""
    process = run(
        """
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
        rows = np.random.default_rng(0).random((512, 512, 3), dtype=np.float32)
        try:
            with open_map(path, map_spec(512, 512)) as writer:
                for y in range(0, 512, 128):
                    try:
                        writer.write_rows(y, y + 128, rows[y : y + 128])
                    except OutputError:
                        print("failed")
                raise KeyboardInterrupt
        except KeyboardInterrupt:
            print("ended")
        """,
        str(tmp_path / "a.exr"),
    )
    output, _ = process.communicate(timeout=60)

    assert output == "failed\n" * 4 + "ended\n"
    assert listing(tmp_path) == []


@SUFFIXES
def test_permissions_of_a_new_map_follow_the_umask(tmp_path, suffix):
    before = os.umask(0o027)
    try:
        write_map(tmp_path / f"a{suffix}", sky())
    finally:
        os.umask(before)

    assert stat.S_IMODE((tmp_path / f"a{suffix}").stat().st_mode) == 0o640


def test_permissions_of_a_replaced_map_stay(tmp_path):
    path = tmp_path / "a.exr"
    path.write_bytes(OLD)
    path.chmod(0o604)
    write_map(path, sky())

    assert stat.S_IMODE(path.stat().st_mode) == 0o604


@pytest.mark.parametrize("exists", [True, False])
def test_a_symbolic_link_stays_and_its_target_is_written(tmp_path, exists):
    (tmp_path / "links").mkdir()
    (tmp_path / "maps").mkdir()
    target = tmp_path / "maps" / "sky_0001.exr"
    if exists:
        target.write_bytes(OLD)
    link = tmp_path / "links" / "latest.exr"
    link.symlink_to("../maps/sky_0001.exr")
    write_map(link, sky())

    assert link.is_symlink()
    assert target.read_bytes()[:4] == b"\x76\x2f\x31\x01"
    assert listing(link.parent) == ["latest.exr"]
    assert listing(target.parent) == ["sky_0001.exr"]


def test_two_processes_writing_one_map_leave_one_whole_map(tmp_path):
    path = tmp_path / "a.exr"
    code = """
        for _ in range(20):
            write_map(path, sky(), 8)
    """
    processes = [run(code, str(path)) for _ in range(2)]
    for process in processes:
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 0, errors
    once = tmp_path / "once.exr"
    write_map(once, sky(), 8)

    assert path.read_bytes() == once.read_bytes()
    assert listing(tmp_path) == ["a.exr", "once.exr"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("missing/a.exr", "folder must exist, got .*/missing$"),
        ("folder.exr", "must be a file, got a folder$"),
        ("pipe.exr", "must be a regular file, got a device or pipe$"),
        ("circle.exr", "must be a file, got a circular link$"),
        ("file/a.exr", "folder must exist, got .*/file$"),
        ("n" * 260 + ".exr", "must be writable, got File name too long$"),
    ],
)
def test_a_target_that_cannot_be_is_refused_in_one_line(tmp_path, name, message):
    (tmp_path / "folder.exr").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "circle.exr").symlink_to("circle.exr")
    os.mkfifo(tmp_path / "pipe.exr")
    before = listing(tmp_path)

    with pytest.raises(OutputError, match=message) as caught:
        write_map(tmp_path / name, sky())
    assert str(caught.value).startswith(f"{tmp_path / name}: ")
    assert "\n" not in str(caught.value)
    assert listing(tmp_path) == before


def test_a_name_as_long_as_names_can_be_is_written(tmp_path):
    write_map(tmp_path / ("n" * 251 + ".exr"), sky())

    assert listing(tmp_path) == ["n" * 251 + ".exr"]


def test_a_folder_or_file_that_is_write_protected_is_refused():
    """As a user who is not root, who may write everywhere."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "a.exr").write_bytes(OLD)
        (folder / "a.exr").chmod(0o444)
        (folder / "protected").mkdir()
        (folder / "protected").chmod(0o555)
        folder.chmod(0o777)
        process = run(
            """
            # Compiling, where there is no kernel yet, reads what is only for root here.
            half_rows(sky())
            if os.getuid() == 0:
                os.setuid(65534)
            for name in ("a.exr", "protected/b.exr", "c.exr"):
                try:
                    write_map(path / name, sky())
                except OutputError as error:
                    print(str(error).removeprefix(str(path)))
            """,
            name,
        )
        output, errors = process.communicate(timeout=60)

        assert output.splitlines() == [
            "/a.exr: must be writable, got a write-protected file",
            f"/protected/b.exr: folder must be writable, got {name}/protected",
        ], errors
        assert listing(folder) == ["a.exr", "c.exr", "protected"]


def test_a_relative_path_is_written_where_the_process_is(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with replace_when_whole(Path("a.txt")) as temporary:
        temporary.write_text("whole")

    assert (tmp_path / "a.txt").read_text() == "whole"
    assert listing(tmp_path) == ["a.txt"]
