"""Sequences as processes: killed, interrupted, side by side, on full and on locked disks."""

import signal
import subprocess
import time

import numpy as np
import pytest

from skybake.formats.reader import read_image
from tests.cli.runs import AS_A_USER, installed, listing, run, run_on_terminal, start
from tests.sequence.runs import QUICK, bake, contents, wait_for

ALL = "1-80"


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Bytes of 80 frames that nothing disturbed, by name, with their manifest."""
    folder = tmp_path_factory.mktemp("undisturbed")
    bake(folder, "--frames", ALL)
    return contents(folder)


def frames(folder):
    """Finished frames: name, and what changes when a file is written again."""
    return {
        path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in folder.glob("a.*.exr")
    }


def killed(folder, more, delay):
    """Kill a sequence a while after it has begun to write, and has baked so many frames more."""
    process = start(*QUICK, "-o", "a.#.exr", "--frames", ALL, "--skip-existing", cwd=folder)
    before, baked = set(listing(folder)), len(frames(folder))
    wait_for(lambda: set(listing(folder)) - before, process)
    wait_for(lambda: len(frames(folder)) >= baked + more, process)
    time.sleep(delay)
    process.kill()
    process.communicate(timeout=60)
    return process.returncode


@pytest.mark.slow
def test_a_run_that_is_killed_ten_times_bakes_each_frame_once(tmp_path, undisturbed):
    chance = np.random.default_rng(40)
    done = {}
    for more in (0, 1, 2, 0, 3, 1, 0, 2, 1, 0):
        assert killed(tmp_path, more, chance.uniform(0.0, 0.05)) == -signal.SIGKILL
        now = frames(tmp_path)
        assert done.items() <= now.items()
        for name in now.keys() - done.keys():
            read_image(tmp_path / name)
        done = now
    assert 10 <= len(done) < 80
    bake(tmp_path, "--frames", ALL, "--skip-existing")
    assert done.items() <= frames(tmp_path).items()
    made = contents(tmp_path)
    assert made.keys() == undisturbed.keys()
    for name in frames(tmp_path):
        assert made[name] == undisturbed[name]
    manifest, other = (kind["a.sequence.json"].decode() for kind in (made, undisturbed))
    # The command names the folder, which is another.
    folders = [text.partition("--output=")[2].partition("/a.#")[0] for text in (manifest, other)]
    assert manifest.replace(folders[0], folders[1]) == other


def test_a_kill_leaves_hidden_folders_only_and_the_next_run_takes_them_along(tmp_path):
    arguments = ("--frames", "1-2", "--size", "2048x1024")
    process = start(*QUICK, *arguments, "-o", "a.#.exr", cwd=tmp_path)
    wait_for(lambda: len(listing(tmp_path)) == 2, process)
    process.kill()
    process.communicate(timeout=60)
    left = listing(tmp_path)
    assert len(left) == 2
    assert all(name.startswith(".skybake-") for name in left)
    bake(tmp_path, "--frames", "1-2", "--skip-existing")
    assert listing(tmp_path) == ["a.0001.exr", "a.0002.exr", "a.sequence.json"]


@pytest.mark.parametrize("workers", ["1", "2"])
@pytest.mark.parametrize(
    ("number", "status", "word"),
    [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")],
)
def test_an_interrupt_is_answered_at_once_and_leaves_no_part(
    tmp_path, workers, number, status, word
):
    process = start(
        *(*QUICK, "--frames", ALL, "-o", "a.#.exr", "--size", "2048x1024", "-q"),
        *("--workers", workers),
        cwd=tmp_path,
    )
    wait_for(lambda: "a.0001.exr" in listing(tmp_path), process)
    process.send_signal(number)
    finished = set(listing(tmp_path))
    output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (status, "")
    assert errors.strip() == f"skybake: {word}"
    left = listing(tmp_path)
    # Those that were being moved into their place.
    assert len(set(left) - finished) <= int(workers)
    assert len(left) < 20
    for name in left:
        read_image(tmp_path / name)


def test_two_sequences_in_one_folder_leave_whole_frames(tmp_path, undisturbed):
    arguments = ("-o", "a.#.exr", "-q", "--frames", ALL, "--only", "1-12")
    for process in [start(*QUICK, *arguments, cwd=tmp_path) for _ in range(2)]:
        _, errors = process.communicate(timeout=240)
        assert (process.returncode, errors) == (0, "")
    names = [f"a.{i:04d}.exr" for i in range(1, 13)]
    assert contents(tmp_path) == {name: undisturbed[name] for name in names}


def test_a_full_disk_fails_the_frames_that_have_no_room_and_keeps_the_others(small_disk):
    errors = bake(small_disk, "--frames", "1-20", "--retry", "1", status=3).splitlines()
    done = {name for name in listing(small_disk) if name.endswith(".exr")}
    assert 0 < len(done) < 20
    for name in done:
        read_image(small_disk / name)
    failed = [int(line.split()[2].rstrip(":")) for line in errors if " frame " in line]
    assert [f"a.{number:04d}.exr" for number in failed] == [
        f"a.{number:04d}.exr" for number in range(1, 21) if f"a.{number:04d}.exr" not in done
    ]
    assert all("full disk" in line or "No space left" in line for line in errors[: len(failed)])
    assert errors[len(failed)].startswith("skybake: frames failed: ")
    assert not [name for name in listing(small_disk) if name.startswith(".")]
    (small_disk / "a.0001.exr").unlink(missing_ok=True)


def test_a_folder_that_takes_no_file_is_one_line_before_anything_is_computed(tmp_path):
    folder = tmp_path / "protected"
    folder.mkdir(mode=0o555)
    status, output, errors = run(
        *(*QUICK, "--frames", "1-9", "-o", "protected/a.#.exr", "--set", "ground.albedo=0.123"),
        wrapper=AS_A_USER,
        cwd=tmp_path,
    )
    assert (status, output) == (1, "")
    # Else it would say first that it solves for the light of this air.
    assert errors == f"skybake: protected/a.0001.exr: folder must be writable, got {folder}\n"
    assert listing(folder) == []


@pytest.mark.parametrize("is_mended", [True, False])
def test_a_frame_that_fails_is_tried_again_and_does_not_stop_the_others(
    tmp_path, undisturbed, is_mended
):
    process = start(
        *(*QUICK, "--frames", ALL, "--only", "1-9", "-o", "a.#.exr"),
        *("--workers", "1", "--retry", "1"),
        cwd=tmp_path,
    )
    wait_for(lambda: listing(tmp_path), process)
    obstacle = tmp_path / "a.0003.exr"
    obstacle.mkdir()
    lines = iter(process.stderr.readline, "")
    told = next(line for line in lines if "retried" in line)
    assert told == "skybake: 2/9 retried a.0003.exr: a.0003.exr: must be a file, got a folder\n"
    if is_mended:
        obstacle.rmdir()
    output, rest = process.communicate(timeout=60)
    assert f"{9 if is_mended else 8} frames baked, 0 skipped, " in output
    assert process.returncode == (0 if is_mended else 3)
    assert ("frames failed: 3\n" in rest) is not is_mended
    assert ("9/9 failed a.0003.exr: " in rest) is not is_mended
    for path in tmp_path.iterdir():
        assert path.is_dir() or path.read_bytes() == undisturbed[path.name]
    assert len(listing(tmp_path)) == 9


def test_one_worker_two_workers_and_emitted_commands_make_the_same_bytes(tmp_path):
    arguments = ("--frames", "-1-2", "--preview", "--set", "aerosol.optical_depth=0.1..0.3")
    folders = {name: tmp_path / name for name in ("one", "two", "shell", "elsewhere")}
    for folder in folders.values():
        folder.mkdir()
    bake(folders["one"], *arguments, "--workers", "1")
    bake(folders["two"], *arguments, "--workers", "2")
    commands = ("-o", "a.#.exr", "--emit-commands", "--chunk-size", "2")
    status, output, errors = run(*QUICK, *arguments, *commands, cwd=folders["shell"])
    assert (status, errors, output.count("\n")) == (0, "", 2)
    shell = subprocess.run(
        ["sh", "-e"],
        input=output,
        env=installed(tmp_path / "bin"),
        cwd=folders["elsewhere"],
        text=True,
        check=True,
        capture_output=True,
    )
    assert shell.stdout.count("2 frames baked") == 2
    made = {name: contents(folder) for name, folder in folders.items()}
    assert made["elsewhere"] == {}
    for name in ("one", "two"):
        del made[name]["a.sequence.json"]
    assert len(made["one"]) == 8
    assert made["one"] == made["two"] == made["shell"]


def test_a_terminal_sees_a_bar_with_the_speed(tmp_path):
    arguments = ("-o", "a.#.exr", "--frames", "1-6", "--json")
    status, output, seen = run_on_terminal(*QUICK, *arguments, cwd=tmp_path)
    assert status == 0
    assert output.startswith('{"baked": 6, ')
    assert b"  6/6  " in seen
    assert b" frames/s, " in seen
