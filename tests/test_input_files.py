"""Files that a user names, read by processes that would wait or fill the memory otherwise."""

import os
import shlex
import socket
from pathlib import Path

import pytest

from skybake.errors import InputError
from skybake.input_files import LARGEST_DIRECTIONS, LARGEST_PRESET, LARGEST_TABLE, read_bytes
from tests.cli.runs import run

# Enough for all that is imported, and far less than what endless files hold.
LITTLE = ("prlimit", f"--as={2 << 30}")

READERS = {
    "preset": "presets check {}",
    "extended preset": "presets check extending.toml",
    "table": "render --set ground.albedo={} -o a.exr",
    "phase": "render --set aerosol.phase.kind=tabulated --set aerosol.phase.table={} -o a.exr",
    "directions": "probe --directions {}",
    "exposure curve": "sequence --frames 1-2 --exposure-curve {} -o a.#.exr",
}


@pytest.fixture
def sources(tmp_path):
    """Files that are none to read, by what they are, and what is said of them."""
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "folder.csv").mkdir()
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(str(tmp_path / "socket.csv"))
    with (tmp_path / "large.csv").open("wb") as large:
        large.truncate(LARGEST_DIRECTIONS + 1)
    yield {
        "/dev/zero": "must be a regular file, got a device",
        str(tmp_path / "pipe.csv"): "must be a regular file, got a pipe",
        str(tmp_path / "folder.csv"): "must be a regular file, got a folder",
        str(tmp_path / "socket.csv"): "cannot be read: No such device or address",
        str(tmp_path / "large.csv"): "bytes, got 67108865 bytes",
    }
    listening.close()


@pytest.mark.parametrize("reader", READERS)
def test_what_is_no_regular_file_of_some_size_is_one_line_at_once(tmp_path, sources, reader):
    before = sorted(path.name for path in tmp_path.iterdir())
    for source, message in sources.items():
        extending = tmp_path / "extending.toml"
        if reader == "extended preset":
            extending.write_text(f'extends = "{source}"\n', encoding="utf-8")
        arguments = READERS[reader].format(shlex.quote(source))
        status, output, errors = run(*shlex.split(arguments), cwd=tmp_path, wrapper=LITTLE)
        extending.unlink(missing_ok=True)
        text = errors or output  # `presets check` prints what is wrong
        assert status == 1, text
        assert message in text
        assert "Traceback" not in text
    assert sorted(path.name for path in tmp_path.iterdir()) == before


def test_standard_input_without_end_is_one_line(tmp_path):
    with Path("/dev/zero").open() as zero:
        found = run("probe", "--directions", "-", stdin=zero, wrapper=LITTLE)
    assert found == (
        1,
        "",
        f"skybake: standard input: must have at most {LARGEST_DIRECTIONS} bytes, got more\n",
    )


def test_a_file_that_tells_no_size_is_read_up_to_the_limit():
    """As those of /proc."""
    path = Path("/proc/self/maps")
    assert path.stat().st_size == 0
    with pytest.raises(InputError, match=r"^maps: must have at most 100 bytes, got more$"):
        read_bytes(path, "maps", 100)
    assert read_bytes(path, "maps", LARGEST_TABLE)


def test_a_file_of_exactly_the_limit_is_read(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(bytes(LARGEST_PRESET))
    assert len(read_bytes(path, "a", LARGEST_PRESET)) == LARGEST_PRESET
    with pytest.raises(InputError, match=f"got {LARGEST_PRESET} bytes"):
        read_bytes(path, "a", LARGEST_PRESET - 1)


def test_more_wavelengths_than_tables_have_room_for_are_one_line(tmp_path):
    values = ",".join(str(400 + 0.5 * i) for i in range(129))
    arguments = ("render", "--set", f"wavelengths_nm=[{values}]", "-o", "a.exr")
    status, _, errors = run(*arguments, cwd=tmp_path)
    assert status == 1
    assert errors.endswith("wavelengths_nm: must be at most 128, got 129\n")
    assert errors.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
