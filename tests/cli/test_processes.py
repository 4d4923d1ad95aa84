"""The command line as a process: interrupts, neighbours, terminals, memory, bytes."""

import os
import pty
import signal
import sys
import time

import pytest

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


@pytest.mark.usefixtures("warm")
@pytest.mark.parametrize("suffix", ["exr", "hdr"])
def test_an_interrupt_is_exit_130_and_leaves_no_file(tmp_path, suffix):
    process = start(
        *("render", "--size", "8192x4096", "--quiet", "--preview", "-o", f"a.{suffix}"),
        cwd=tmp_path,
    )
    while not listing(tmp_path):
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (130, "")
    assert errors.strip() == "skybake: interrupted"
    assert listing(tmp_path) == []


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
        code = "from skybake.cli import main; main()"
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
