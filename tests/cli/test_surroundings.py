"""The command line as a process among terminals, pipes, limits and environments."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from tests.cli.runs import PACKAGES, SMALL, listing, render, run, run_on_terminal


@pytest.mark.usefixtures("warm")
def test_a_terminal_sees_a_bar(tmp_path):
    arguments = ("render", *SMALL, "--json", "-o", "a.exr")
    status, _, seen = run_on_terminal(*arguments, cwd=tmp_path)
    assert status == 0
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


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize(
    ("command", "closed"),
    [
        ("render", "2>&-"),
        ("render", ">&-"),
        ("render", "<&- >&- 2>&-"),
        ("sequence --frames 1-2", "<&- >&- 2>&-"),
    ],
)
def test_with_closed_streams_maps_are_baked(tmp_path, closed, command):
    expected = render(tmp_path / "expected.exr", *SMALL)
    name = "a.#.exr" if "frames" in command else "a.exr"
    code = "from skybake.cli import run; run()"
    line = f"exec {sys.executable} -c '{code}' {command} {' '.join(SMALL)} -o '{name}' {closed}"
    result = subprocess.run(
        ["sh", "-c", line],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": PACKAGES},
        capture_output=True,
        check=False,
        timeout=240,
    )
    assert result.returncode == 0
    found = sorted(tmp_path.glob("a.*exr"))
    assert len(found) == (2 if "frames" in command else 1)
    assert {path.read_bytes() for path in found} == {expected}


def test_with_closed_streams_a_fault_has_its_status():
    command = f"exec {sys.executable} -c 'from skybake.cli import run; run()' presets show vulcan"
    result = subprocess.run(
        ["sh", "-c", f"{command} 2>&-"],
        env=os.environ | {"PYTHONPATH": PACKAGES},
        capture_output=True,
        check=False,
    )
    assert (result.returncode, result.stdout) == (1, b"")


def test_a_full_disk_below_standard_output_is_one_line():
    with Path("/dev/full").open("w") as full:
        status, _, errors = run("presets", "show", "mars", stdout=full)
    assert (status, errors) == (1, "skybake: output: cannot be written (No space left on device)\n")


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
    for preset in ("mars", "earth-hillaire2020"):
        arguments = (*SMALL, "--preset", preset, "--preview")
        bare = render(tmp_path / "bare.exr", *arguments, code=BARE)
        assert bare == render(tmp_path / "full.exr", *arguments)


MEASURED = """
import sys
from skybake.cli import main
try:
    main(sys.argv[1:])
finally:
    # Unlike the maximum that getrusage tells, this one is not inherited from who ran us.
    lines = open("/proc/self/status").read().splitlines()
    print(*(line.split()[1] for line in lines if line.startswith("VmHWM:")))
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


def limited(megabytes, **limits):
    """Wrapper of a process that may use so much address space."""
    more = (f"--{name}={size << 20}" for name, size in limits.items())
    return "prlimit", f"--as={megabytes << 20}", *more


HEAVY = [
    ("render", "-o", "a.exr"),
    ("sequence", "--frames", "1-2", "-o", "a.#.exr"),
    ("preview", "a.exr"),
    ("probe",),
    ("presets", "check", "earth"),
    ("presets", "plot", "earth"),
    ("cache", "warm"),
]


# Each command at one limit, and one command at each.
LIMITS = [(command, 400) for command in HEAVY] + [(HEAVY[0], 128), (HEAVY[0], 700)]


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize(("arguments", "megabytes"), LIMITS)
def test_too_little_memory_is_one_line(tmp_path, arguments, megabytes):
    status, output, errors = run(*arguments, cwd=tmp_path, wrapper=limited(megabytes))
    assert (status, output) == (1, "")
    assert errors == (
        "skybake: memory: skybake needs at least 1 GB of address space "
        f"(the limit is {megabytes} MB)\n"
    )
    assert listing(tmp_path) == []


LIGHT = [("presets", "list"), ("presets", "show", "mars", "--resolved"), ("cache", "info")]


@pytest.mark.parametrize("arguments", LIGHT, ids=" ".join)
def test_what_computes_nothing_needs_hardly_any_memory(arguments):
    status, output, errors = run(*arguments, wrapper=limited(128))
    assert (status, errors) == (0, "")
    assert output


def test_memory_that_ends_on_the_way_is_one_line(tmp_path):
    """The pixels of this file take 0.8 GB, and it is not made smaller."""
    output = OpenImageIO.ImageOutput.create("exr")
    assert output.open(str(tmp_path / "a.exr"), OpenImageIO.ImageSpec(1024, 65536, 3, "half"))
    for first in range(0, 65536, 4096):
        assert output.write_scanlines(first, first + 4096, 0, np.zeros((4096, 1024, 3), np.half))
    assert output.close()
    found = run("preview", "a.exr", cwd=tmp_path, wrapper=limited(1536))
    assert found == (1, "", "skybake: memory: too little for this task (the limit is 1536 MB)\n")
    assert listing(tmp_path) == ["a.exr"]


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("arguments", HEAVY[:2], ids=" ".join)
def test_threads_without_memory_for_their_stacks_are_one_line(tmp_path, arguments):
    found = run(*arguments, "-q", cwd=tmp_path, wrapper=limited(1536, stack=2048))
    threads = "threads: none can be started (too little memory, or too few processes allowed)"
    assert found == (1, "", f"skybake: {threads}\n")
    assert listing(tmp_path) == []


FAULTY = """
import skybake.preset
from skybake.cli import run

def preset_names():
    raise {fault}

skybake.preset.preset_names = preset_names
run()
"""


@pytest.mark.parametrize(
    "fault", ["RuntimeError('a fault')", "ImportError('a fault')", "SystemError('a fault')"]
)
def test_a_fault_of_the_program_is_not_taken_for_a_lack_of_memory(fault):
    status, output, errors = run(
        "presets", "list", code=FAULTY.format(fault=fault), wrapper=limited(2048)
    )
    assert (status, output) == (1, "")
    assert errors.startswith("Traceback")
    assert errors.endswith("Error: a fault\n")


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
@pytest.mark.parametrize("environment", [{}, {"LC_ALL": "POSIX", "TERM": "dumb", "TZ": "Nowhere"}])
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
