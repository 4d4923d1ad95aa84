"""Writes that fail at their very end, which the library and readers do not notice."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from skybake.errors import OutputError
from skybake.formats.exr_chunks import find_chunk_fault
from tests.formats.maps import listing, program, sky, write_map

REPOSITORY = Path(__file__).parents[2]

WRITE = """
import sys
from pathlib import Path
from skybake.errors import OutputError
from skybake.formats.exr import ExrWriter
from skybake.formats.hdr import HdrWriter
from skybake.formats.cube_file import write_cube
from skybake.formats.exr_mips import write_exr_mips
from skybake.formats.exr_parts import PartsWriter
from tests.formats.cubes import cube_levels
from tests.formats.maps import map_spec, sky

class Files:
    def add(self, path):
        return temporary

temporary = Path(sys.argv[1])
Writer = ExrWriter if temporary.suffix == ".exr" else HdrWriter
try:
    if temporary.suffix in (".ktx2", ".dds"):
        write_cube(Path("a" + temporary.suffix), cube_levels(64), map_spec(64, 64), Files())
    elif temporary.stem == "levels":
        levels = [sky(64 >> k, 64 >> k) for k in range(7)]
        write_exr_mips(Path("a"), levels, map_spec(64, 64), Files())
    elif temporary.stem == "parts":
        with PartsWriter(Path("a"), temporary, dict.fromkeys("abc", map_spec())) as writer:
            writer.write_ready(0, 64, writer.ready((sky(), sky(), sky())))
    else:
      with Writer(Path("a"), temporary, map_spec(compression=sys.argv[2])) as writer:
          writer.write_rows(0, 64, sky())
except OutputError as error:
    print(error)
"""


def write_traced(temporary, compression, *options):
    """Write a map in a process whose writes to it are traced; returns what it says, and them."""
    trace = temporary.with_suffix(".trace")
    command = [program("strace"), "-f", "-o", trace, "-e", "trace=write", "-P", temporary, *options]
    process = subprocess.run(
        [*command, sys.executable, "-c", WRITE, temporary, compression],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=False,
    )
    assert process.returncode == 0, process.stderr
    return process.stdout, len(re.findall(r"\bwrite\(", trace.read_text()))


@pytest.mark.parametrize("writes", ["some", pytest.param("all", marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    ("name", "compression"),
    [
        *(("whole.exr", "zip"), ("whole.exr", "zips"), ("whole.exr", "none"), ("whole.hdr", "")),
        *(("levels.exr", ""), ("parts.exr", ""), ("whole.ktx2", ""), ("whole.dds", "")),
    ],
)
def test_each_write_that_fails_is_noticed(tmp_path, name, compression, writes):
    """The last one is of the table of chunks, over zeros that are there already."""
    temporary = tmp_path / name
    compression = compression or "zip"
    output, count = write_traced(temporary, compression)
    assert output == ""
    if writes == "some":
        numbers = [1, count]
    else:
        numbers = [*range(1, count + 1)] if count < 12 else [1, 2, *range(count - 4, count + 1)]
    for number in numbers:
        temporary.unlink()
        fault = f"inject=write:error=ENOSPC:when={number}"
        output, _ = write_traced(temporary, compression, "-e", fault)
        assert re.match(r"a(\.\w+)?: (must be|cannot be) ", output), (
            f"write {number} of {count} failed unnoticed"
        )
        assert output.count("\n") == 1


@pytest.mark.parametrize("small_disk", ["size=512k"], indirect=True)
@pytest.mark.parametrize("suffix", [".exr", ".hdr"])
def test_on_a_disk_of_any_size_a_map_is_whole_or_refused(small_disk, tmp_path, suffix):
    """Pages of 4096 bytes are what this file system grows by."""
    whole = refused = 0
    copies = 2 if suffix == ".hdr" else 1  # its header is put in by way of a second file
    for width in range(40, 200, 16):
        rows = np.random.default_rng(width).random((40, width, 3), dtype=np.float32)
        expected = tmp_path / f"a{suffix}"
        write_map(expected, rows, compression="zips")
        path = small_disk / expected.name
        for pages in range(-2, 3):
            room = copies * expected.stat().st_size + 4096 * pages
            ballast = small_disk / "ballast"
            ballast.write_bytes(bytes(shutil.disk_usage(small_disk).free - room))
            try:
                write_map(path, rows, compression="zips")
            except OutputError:
                refused += 1
                assert listing(small_disk) == ["ballast"]
            else:
                whole += 1
                assert path.read_bytes() == expected.read_bytes()
                path.unlink()
            ballast.unlink()
    assert min(whole, refused) >= 10


COMPRESSIONS = ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab")


@pytest.mark.parametrize("compression", [*COMPRESSIONS, "htj2k256", "htj2k32", "zstd"])
@pytest.mark.parametrize("height", [1, 2, 63, 64, 300])
def test_chunks_of_every_compression_are_found_whole(tmp_path, compression, height):
    write_map(tmp_path / "a.exr", sky(96, height), compression=compression)
    assert find_chunk_fault(tmp_path / "a.exr", height) is None


def test_damage_to_the_table_of_chunks_or_to_the_end_is_found(tmp_path):
    path = tmp_path / "a.exr"
    write_map(path, sky(), compression="zip")
    content = path.read_bytes()
    size = 8 * 4  # of the table, which ends where the first chunk begins
    table = next(
        at
        for at in range(8, len(content))
        if content[at : at + 8] == (at + size).to_bytes(8, "little")
    )
    faults = [content[:-1], content[:100], content + b"\0"]
    faults += [
        content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :]
        for at in range(table, table + size)
    ]
    faults.append(content[:table] + bytes(size) + content[table + size :])
    for damaged in faults:
        path.write_bytes(damaged)
        assert find_chunk_fault(path, 64) is not None
