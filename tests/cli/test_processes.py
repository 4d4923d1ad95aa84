"""The command line as a process: interrupts, neighbours, terminals, memory, bytes."""

import json
import os
import pty
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from skybake.formats.reader import read_image
from tests.cli.runs import PACKAGES, SMALL, listing, run, start


def render(target, *arguments, **keywords):
    status, output, errors = run(
        *("render", *arguments, "-o", target, "--quiet"), cwd=target.parent, **keywords
    )
    assert (status, output, errors) == (0, "", "")
    return target.read_bytes()


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    """Kernels are compiled."""
    render(tmp_path_factory.mktemp("warm") / "a.exr", *SMALL, "--preview")


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


def start_large(folder, suffix="exr", **keywords):
    """Start a render that takes long, and wait until it writes."""
    process = start(
        *("render", "--size", "8192x4096", "-q", "--preview", "-o", f"a.{suffix}"),
        cwd=folder,
        **keywords,
    )
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
    process = start_large(tmp_path)
    render(tmp_path / "a.exr", *SMALL)
    assert process.poll() is None
    _, errors = process.communicate(timeout=240)
    assert (process.returncode, errors) == (0, "")
    assert listing(tmp_path) == ["a.exr", "a.png"]
    assert read_image(tmp_path / "a.exr")[0].shape == (4096, 8192, 3)


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


@pytest.mark.usefixtures("warm")
def test_a_terminal_sees_a_bar(tmp_path):
    master, slave = pty.openpty()
    pid = os.fork()
    if pid == 0:
        os.dup2(slave, 2)
        os.chdir(tmp_path)
        os.environ["PYTHONPATH"] = PACKAGES
        code = "from skybake.cli import run; run()"
        arguments = ["render", *SMALL, "--json", "-o", "a.exr"]
        os.execv(sys.executable, [sys.executable, "-c", code, *arguments])  # noqa: S606
    os.close(slave)
    seen = b""
    try:
        while chunk := os.read(master, 4096):
            seen += chunk
    except OSError:
        pass
    os.close(master)
    assert os.waitpid(pid, 0)[1] == 0
    assert b"100%" in seen


STATUSES = [
    (0, ("presets", "list")),
    (1, ("presets", "show", "vulcan")),
    (2, ("render", "--sun", "95deg")),
    (2, ("rendr",)),
]


@pytest.mark.parametrize(("status", "arguments"), STATUSES)
def test_the_program_ends_with_the_status_of_its_command(status, arguments):
    found, _, errors = run(*arguments)
    assert found == status
    assert errors.count("\n") == (status != 0)


@pytest.fixture
def many_directions(tmp_path):
    """A CSV that makes an answer of more than a pipe holds."""
    path = tmp_path / "directions.csv"
    lines = (f"{0.02 * i:.2f},{i % 360}" for i in range(4000))
    path.write_text("\n".join(["view_zenith_deg,relative_azimuth_deg", *lines, ""]))
    return path


def test_all_that_is_printed_reaches_a_pipe(tmp_path, many_directions):
    options = ("probe", "--method", "hillaire", "--directions", many_directions)
    status, output, errors = run(*options)
    assert (status, errors) == (0, "")
    assert len(output) > 1 << 18
    assert output.count("\n") == 4001
    assert run(*options, "-o", tmp_path / "a.csv") == (0, "", "")
    assert output == (tmp_path / "a.csv").read_text()


@pytest.mark.usefixtures("warm")
def test_json_reaches_a_pipe(tmp_path):
    status, output, _ = run("render", *SMALL, "--json", "-q", "-o", tmp_path / "a.exr")
    assert status == 0
    assert json.loads(output)["files"] == [str(tmp_path / "a.exr")]


@pytest.mark.parametrize("end", ["head -c0", "head -c100", "true"])
def test_a_reader_that_closes_early_gets_no_traceback(many_directions, end):
    """In a pipe of the shell's, with the status of the first program."""
    code = "from skybake.cli import run; run()"
    command = f'"$0" -c "{code}" "$@" | {end}; exit ${{PIPESTATUS[0]}}'
    options = ("probe", "--method", "hillaire", "--directions", str(many_directions))
    result = subprocess.run(
        ["bash", "-c", command, sys.executable, *options],
        # Unbuffered, Python does not notice that only a part was taken.
        env=os.environ | {"PYTHONPATH": PACKAGES, "PYTHONUNBUFFERED": ""},
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert (result.returncode, result.stderr) == (1, "")


CLOSED = """
import os, sys
os.close(1)
code = "from skybake.cli import run; run()"
os.execv(sys.executable, [sys.executable, "-c", code, *sys.argv[1:]])
"""


@pytest.mark.parametrize("arguments", [("presets", "show", "mars"), ("--version",)])
def test_without_standard_output_the_program_ends_in_peace(arguments):
    status, output, errors = run(*arguments, code=CLOSED)
    assert (status, output, errors) == (0, "", "")


def test_a_full_disk_below_standard_output_is_one_line():
    with Path("/dev/full").open("w") as full:
        status, _, errors = run("presets", "show", "mars", stdout=full)
    assert (status, errors) == (1, "skybake: must be able to write, got No space left on device\n")


BARE = """
import sys

class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("colour", "scipy"):
            raise ImportError(name)

sys.meta_path.insert(0, Refuse())
from skybake.cli import main
main()
"""


@pytest.mark.usefixtures("warm")
def test_a_render_needs_neither_colour_science_nor_scipy(tmp_path):
    """numba looks for scipy by itself, so that its absence from sys.modules can't be asked for."""
    for preset in ("earth", "mars", "earth-hillaire2020"):
        arguments = (*SMALL, "--preset", preset, "--preview")
        bare = render(tmp_path / "bare.exr", *arguments, code=BARE)
        assert bare == render(tmp_path / "full.exr", *arguments)


MEASURED = """
import resource, sys
from skybake.cli import main
try:
    main(sys.argv[1:])
finally:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.slow
@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("suffix", ["exr", "hdr"])
def test_16k_needs_at_most_500_megabytes(tmp_path, suffix):
    status, output, errors = run(
        *("render", "--size", "16384x8192", "--quiet", "-o", tmp_path / f"a.{suffix}"),
        code=MEASURED,
    )
    assert status == 0, errors
    assert int(output) * 1024 < 500e6


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("megabytes", [128, 400, 700])
@pytest.mark.parametrize("command", ["render", "sequence", "preview", "probe"])
def test_too_little_memory_is_one_line(tmp_path, command, megabytes):
    arguments = {
        "render": ("-o", "a.exr"),
        "sequence": ("--frames", "1-2", "-o", "a.#.exr"),
        "preview": ("a.exr",),
        "probe": (),
    }[command]
    limit = ("prlimit", f"--as={megabytes << 20}")
    status, output, errors = run(command, *arguments, cwd=tmp_path, wrapper=limit)
    assert (status, output) == (1, "")
    assert errors == (
        "skybake: memory: must be at least 1024 MB of address space, "
        f"got a limit of {megabytes} MB\n"
    )
    assert listing(tmp_path) == []


KILLED = {
    "render": ("render", *SMALL, "-q", "-o", "sky.exr"),
    "cubemap": ("render", "--projection", "cubemap", "--size", "64", "-q", "-o", "sky.exr"),
    "preview": ("render", *SMALL, "--preview", "-q", "-o", "sky.exr"),
}


@pytest.mark.slow
@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("way", KILLED)
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


HARDLY_ANY = {"PATH": os.environ["PATH"], "PYTHONPATH": PACKAGES}


def run_bare(*arguments, cwd, **environment):
    """Run with hardly any environment."""
    cache = {"SKYBAKE_CACHE_DIR": os.environ["SKYBAKE_CACHE_DIR"]}
    result = subprocess.run(
        [sys.executable, "-m", "skybake", *arguments],
        cwd=cwd,
        env={**HARDLY_ANY, **cache, **environment},
        capture_output=True,
        check=False,
        timeout=240,
    )
    return result.returncode, result.stdout, result.stderr


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize(
    "environment", [{}, {"LC_ALL": "C"}, {"LC_ALL": "POSIX", "TERM": "dumb"}, {"TZ": "Nowhere"}]
)
def test_without_home_terminal_and_locale_maps_are_as_they_are(tmp_path, environment):
    name = "a folder/sky é 空.exr"
    (tmp_path / "a folder").mkdir()
    expected = render(tmp_path / "plain.exr", *SMALL)
    assert run_bare("render", *SMALL, "-q", "-o", name, cwd=tmp_path, **environment) == (
        0,
        b"",
        b"",
    )
    assert (tmp_path / name).read_bytes() == expected


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("arguments", [("render", *SMALL, "-o"), ("preview",)])
def test_a_name_that_is_no_utf8_is_one_line(tmp_path, arguments):
    name = b"sky\xff.exr"
    if arguments[0] == "preview":
        (tmp_path / os.fsdecode(name)).write_bytes(b"")
    status, output, errors = run_bare(*arguments, name, cwd=tmp_path)
    assert (status, output) == (1, b"")
    assert errors.splitlines()[-1].startswith(b"skybake: sky")
    assert b"must be UTF-8" in errors
    assert len(errors.splitlines()) <= 2


def half_steps(path):
    """Values of a map of halves as whole numbers, one from each half to the next."""
    bits = OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.HALF).view(np.uint16)
    steps = bits.astype(np.int32)
    return np.where(steps & 0x8000, -(steps & 0x7FFF), steps)


@pytest.mark.slow
@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("processor", ["generic", "haswell"])
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
