"""Six files that appear together, whatever happens while they take their names."""

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from skybake.errors import OutputError
from skybake.formats.renames import JOURNAL
from skybake.formats.whole_files import WholeFiles
from tests.formats.maps import listing, program

REPOSITORY = Path(__file__).parents[2]
NAMES = [f"sky_{face}.txt" for face in ("nx", "ny", "nz", "px", "py", "pz")]
OLD, NEW = "old", "new"

WRITE = """
import sys
from pathlib import Path
from skybake.errors import OutputError
from skybake.formats.whole_files import WholeFiles
folder, *names = sys.argv[1:]
try:
    with WholeFiles() as files:
        for name in names:
            files.add(Path(folder, name)).write_text("new")
except OutputError as error:
    print(error)
    sys.exit(1)
print("written")
"""

# How many of the names were there before.
BEFORE = pytest.mark.parametrize("before", [0, 3, 6])
# The first call, one amid the others and the last, or every one, each in a process of its own.
CALLS = pytest.mark.parametrize("calls", ["some", pytest.param("all", marks=pytest.mark.slow)])


def write(folder, names=NAMES, text=NEW):
    with WholeFiles() as files:
        for name in names:
            files.add(folder / name).write_text(text)


@pytest.fixture
def folder(tmp_path, before):
    found = tmp_path / "maps"
    found.mkdir()
    if before:
        write(found, NAMES[:before], OLD)
    return found


def start(folder, *options, code=WRITE, names=NAMES):
    """Write in a process whose renames of files are traced."""
    trace = folder.parent / "trace"
    command = [program("strace"), "-f", "-o", trace, "-e", "trace=rename,fsync", *options]
    return subprocess.run(
        [*command, sys.executable, "-c", code, folder, *names],
        env=os.environ | {"PYTHONPATH": str(REPOSITORY), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )


def begin_and_give_up(path):
    """Write a file, and fail before it is whole."""
    files = WholeFiles()
    files.add(path)
    files.__exit__(KeyboardInterrupt, None, None)


def is_old(folder, before):
    return listing(folder) == NAMES[:before] and {
        (folder / name).read_text() for name in NAMES[:before]
    } <= {OLD}


def is_new(folder):
    return listing(folder) == NAMES and {(folder / name).read_text() for name in NAMES} == {NEW}


@CALLS
@BEFORE
@pytest.mark.parametrize("call", ["rename", "fsync"])
def test_where_one_call_fails_all_is_as_it_was(folder, before, call, calls):
    count = count_calls(folder, call)
    assert count >= 7
    put_back(folder, before)
    for number in chosen(calls, 1, count):
        process = start(folder, "-e", f"inject={call}:error=EIO:when={number}")
        assert process.returncode == 1, process.stderr
        assert re.fullmatch(r".*: must be writable, got Input/output error\n", process.stdout)
        assert is_old(folder, before), f"{call} {number} of {count} left {listing(folder)}"


@CALLS
@pytest.mark.parametrize("before", [3])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT", "SIGHUP"])
def test_a_signal_between_renames_waits_for_the_last(folder, before, name, calls):
    for number in chosen(calls, 2, count_calls(folder, "rename")):
        put_back(folder, before)
        process = start(folder, "-e", f"inject=rename:signal={name}:when={number}")
        # Of strace, which ends as its process does.
        assert process.returncode in {-getattr(signal, name), 128 + getattr(signal, name)}
        assert is_new(folder), f"{name} at rename {number} left {listing(folder)}"


@CALLS
@BEFORE
def test_what_a_kill_between_renames_left_is_taken_back_by_the_next_that_writes(
    folder, before, calls
):
    numbers = chosen(calls, 1, count_calls(folder, "rename"))
    torn = 0
    for number in numbers:
        put_back(folder, before)
        start(folder, "-e", f"inject=rename:signal=SIGKILL:when={number}")
        names = [name for name in listing(folder) if name in NAMES]
        torn += 0 < sum((folder / name).read_text() == NEW for name in names) < 6
        # Whichever of them is written next, and even if that fails.
        begin_and_give_up(folder / NAMES[number % 6])
        left = [name for name in listing(folder) if not name.startswith(".skybake-")]
        assert left in (NAMES[:before], NAMES)
        assert len({(folder / name).read_text() for name in left}) <= 1
        write(folder)
        assert is_new(folder)
    assert torn >= (5 if calls == "all" else 1)


def test_names_in_several_folders_are_taken_back_too(tmp_path):
    for name in ("maps", "pictures"):
        (tmp_path / name).mkdir()
    names = ["maps/a.exr", "maps/b.exr", "pictures/a.png"]
    write(tmp_path, names, OLD)
    # The first rename is that of the journal.
    process = start(tmp_path, "-e", "inject=rename:signal=SIGKILL:when=3", names=names)
    assert process.returncode != 0
    assert (tmp_path / "pictures" / "a.png").read_text() == NEW
    assert (tmp_path / "maps" / "a.exr").read_text() == OLD
    # Elsewhere meanwhile, as another container sees them.
    moved = tmp_path.with_name("moved")
    tmp_path.rename(moved)
    begin_and_give_up(moved / "pictures" / "a.png")
    assert {(moved / name).read_text() for name in names} == {OLD}
    moved.rename(tmp_path)


def test_a_file_that_another_program_put_there_meanwhile_stays(tmp_path):
    write(tmp_path, NAMES, OLD)
    start(tmp_path, "-e", "inject=rename:signal=SIGKILL:when=5")
    other = tmp_path / "other"
    other.write_text("other")
    other.replace(tmp_path / NAMES[5])
    begin_and_give_up(tmp_path / NAMES[0])
    texts = [(tmp_path / name).read_text() for name in NAMES]
    assert texts == [*[OLD] * 5, "other"]


def test_a_journal_of_somebody_else_moves_no_file(tmp_path):
    """In a folder where others may write; ours are for their owner only."""
    victim = tmp_path / "victim"
    victim.mkdir()
    (victim / "a.txt").write_text(OLD)
    maps = tmp_path / "maps"
    maps.mkdir()
    write(maps, NAMES, OLD)
    start(maps, "-e", "inject=rename:signal=SIGKILL:when=5")
    (journal,) = maps.glob(f"*/{JOURNAL}")
    entries = json.loads(journal.read_text())
    entries[0] |= {"target": "../victim/a.txt", "inode": (victim / "a.txt").stat().st_ino}
    journal.write_text(json.dumps(entries))
    write(maps)
    assert (victim / "a.txt").read_text() == OLD

    write(maps, NAMES, OLD)
    start(maps, "-e", "inject=rename:signal=SIGKILL:when=5")
    for left in maps.glob(".skybake-*"):
        left.chmod(0o777)
    begin_and_give_up(maps / NAMES[0])
    assert (maps / NAMES[5]).read_text() == NEW


def test_without_hard_links_what_stood_there_is_copied(tmp_path, monkeypatch):
    def refuse(path, target):
        raise PermissionError(1, "Operation not permitted")

    def fail_for_last(source, target, replace=os.replace):
        if os.fspath(target).endswith(NAMES[5]) and "whole" in os.fspath(source):
            raise OSError(5, "Input/output error")
        replace(source, target)

    write(tmp_path, NAMES, OLD)
    monkeypatch.setattr(Path, "hardlink_to", refuse)
    monkeypatch.setattr(os, "replace", fail_for_last)
    with pytest.raises(OutputError, match="must be writable, got Input/output error"):
        write(tmp_path)
    assert is_old(tmp_path, 6)


def chosen(calls, first, last):
    """Numbers of the calls that are disturbed."""
    return range(first, last + 1) if calls == "all" else [first, (first + last) // 2, last]


def count_calls(folder, call):
    """How often a process calls the system to write all files."""
    assert start(folder).stdout == "written\n"
    return len(re.findall(rf"\b{call}\(", (folder.parent / "trace").read_text()))


def put_back(folder, before):
    """Make a folder as it was before."""
    for name in NAMES:
        (folder / name).unlink(missing_ok=True)
    if before:
        write(folder, NAMES[:before], OLD)
