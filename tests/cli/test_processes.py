"""The command line as a process: bytes, signals, kills, neighbours."""

import random
import signal
import time

import numpy as np
import OpenImageIO
import pytest

from skybake.formats.reader import read_image
from tests.cli.runs import SMALL, listing, render, run, start

WAYS = {
    "exr": (*SMALL, "--sun", "-2deg"),
    "mars": (*SMALL, "--preset", "mars", "--units", "nits"),
    "cube": ("--projection", "cubemap", "--size", "48", "--cube-layout", "cross"),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.usefixtures("warm")
def test_bytes_depend_neither_on_the_run_nor_on_the_number_of_threads(tmp_path, way):
    first = render(tmp_path / "first.exr", *WAYS[way])
    again = render(tmp_path / "again.exr", *WAYS[way])
    alone = render(tmp_path / "alone.exr", *WAYS[way], wrapper=("taskset", "-c", "0"))
    assert first == again
    assert first == alone


def start_large(folder, suffix="exr", size="8192x4096"):
    """Start a render that takes long, and wait until it writes."""
    process = start(*("render", "--size", size, "-q", "--preview", "-o", f"a.{suffix}"), cwd=folder)
    while not listing(folder):
        assert process.poll() is None
        time.sleep(0.01)
    return process


SIGNALS = [
    (signal.SIGINT, 130, "interrupted"),
    (signal.SIGTERM, 143, "terminated"),
    (signal.SIGHUP, 129, "terminated"),
]


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("suffix", ["exr", "hdr"])
@pytest.mark.parametrize(("number", "status", "word"), SIGNALS)
def test_a_signal_that_ends_leaves_no_file(tmp_path, suffix, number, status, word):
    process = start_large(tmp_path, suffix)
    process.send_signal(number)
    output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (status, "")
    assert errors.strip() == f"skybake: {word}"
    assert listing(tmp_path) == []


@pytest.mark.usefixtures("warm")
def test_a_second_signal_does_not_cut_the_clean_up_short(tmp_path):
    process = start_large(tmp_path)
    for _ in range(5):
        process.send_signal(signal.SIGTERM)
        time.sleep(0.002)
    process.communicate(timeout=60)
    assert process.returncode == 143
    assert listing(tmp_path) == []


@pytest.mark.usefixtures("warm")
def test_a_signal_that_is_ignored_stays_so(tmp_path):
    process = start("render", *SMALL, "-q", "-o", "a.exr", cwd=tmp_path, wrapper=("nohup",))
    time.sleep(0.2)  # nohup itself must have begun
    while process.poll() is None:
        process.send_signal(signal.SIGHUP)
        time.sleep(0.05)
    process.communicate()
    assert process.returncode == 0
    assert listing(tmp_path) == ["a.exr"]


@pytest.mark.usefixtures("warm")
def test_what_a_killed_process_left_goes_with_the_next_run(tmp_path):
    process = start_large(tmp_path)
    process.kill()
    process.communicate(timeout=60)
    left = listing(tmp_path)
    assert left
    assert all(name.startswith(".skybake-") for name in left)
    render(tmp_path / "b.exr", *SMALL)
    assert listing(tmp_path) == [*left, "b.exr"]
    render(tmp_path / "a.exr", *SMALL, "--preview")
    assert listing(tmp_path) == ["a.exr", "a.png", "b.exr"]


@pytest.mark.usefixtures("warm")
def test_a_process_leaves_alone_what_another_is_writing(tmp_path):
    process = start_large(tmp_path, size="4096x2048")
    process.send_signal(signal.SIGSTOP)
    render(tmp_path / "a.exr", *SMALL)
    process.send_signal(signal.SIGCONT)
    assert process.poll() is None
    _, errors = process.communicate(timeout=240)
    assert (process.returncode, errors) == (0, "")
    assert listing(tmp_path) == ["a.exr", "a.png"]
    assert read_image(tmp_path / "a.exr")[0].shape == (2048, 4096, 3)


def test_an_interrupt_while_kernels_compile_ends_at_once(tmp_path):
    process = start(
        *("render", *SMALL, "-o", "a.exr"),
        cwd=tmp_path,
        env={"SKYBAKE_CACHE_DIR": str(tmp_path / "cache")},
    )
    assert "compiling" in process.stderr.readline()
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    started = time.monotonic()
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors.endswith("skybake: interrupted\n")
    assert time.monotonic() - started < 20.0
    assert listing(tmp_path) == ["cache"]


@pytest.mark.usefixtures("warm")
def test_two_processes_on_one_target_leave_one_whole_map(tmp_path):
    target = tmp_path / "a.exr"
    processes = [start("render", *SMALL, "--quiet", "-o", target, "--preview") for _ in range(2)]
    for process in processes:
        _, errors = process.communicate(timeout=240)
        assert (process.returncode, errors) == (0, "")
    assert listing(tmp_path) == ["a.exr", "a.png"]
    whole = target.read_bytes()
    assert whole == render(target, *SMALL)


KILLED = {
    "render": ("render", *SMALL, "-q", "-o", "sky.exr"),
    "cubemap": ("render", "--projection", "cubemap", "--size", "64", "-q", "-o", "sky.exr"),
    "preview": ("render", *SMALL, "--preview", "-q", "-o", "sky.exr"),
}


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize(
    "way",
    [
        pytest.param("render", marks=pytest.mark.slow),
        pytest.param("cubemap", marks=pytest.mark.nightly),
        pytest.param("preview", marks=pytest.mark.nightly),
    ],
)
def test_killed_at_any_moment_it_leaves_whole_files_or_none(tmp_path, way):
    """Fifty kills in all; the next run of the same target takes away what they left."""
    begun = time.perf_counter()
    whole = tmp_path / "whole"
    whole.mkdir()
    assert run(*KILLED[way], cwd=whole) == (0, "", "")
    usual = time.perf_counter() - begun
    folder = tmp_path / "killed"
    folder.mkdir()
    moments = random.Random(way)
    for _ in range(17):
        process = start(*KILLED[way], cwd=folder)
        time.sleep(usual * moments.uniform(0.3, 1.05))
        process.kill()
        process.communicate()
        for name in listing(folder):
            if not name.startswith(".skybake-"):
                assert (folder / name).read_bytes() == (whole / name).read_bytes()
                (folder / name).unlink()
    assert run(*KILLED[way], cwd=folder) == (0, "", "")
    assert listing(folder) == listing(whole)


def half_steps(path):
    """Values of a map of halves as whole numbers, one from each half to the next."""
    bits = OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.HALF).view(np.uint16)
    steps = bits.astype(np.int32)
    return np.where(steps & 0x8000, -(steps & 0x7FFF), steps)


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize(
    "processor",
    [
        pytest.param("generic", marks=pytest.mark.nightly),
        pytest.param("haswell", marks=pytest.mark.slow),
    ],
)
def test_other_processors_make_the_same_map_but_for_the_last_bit(tmp_path, processor):
    arguments = ("--size", "128x64", "--sun", "-3deg", "--pixel", "half")
    render(tmp_path / "here.exr", *arguments)
    other = {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""}
    status, _, errors = run(
        *("render", *arguments, "-q", "-o", tmp_path / "there.exr"),
        env={**other, "SKYBAKE_CACHE_DIR": str(tmp_path / "cache")},
    )
    assert status == 0, errors
    difference = half_steps(tmp_path / "here.exr") - half_steps(tmp_path / "there.exr")
    assert np.abs(difference).max() <= 1
