"""A cluster bakes the same frames, whatever befalls it: scheduler and workers are processes."""

import re
import signal
import time
from contextlib import contextmanager

import pytest

from tests.cli.runs import listing, run, start
from tests.sequence.runs import QUICK, bake, contents, wait_for

SCHEDULER = "from distributed.cli.dask_scheduler import main; main()"
WORKER = "from distributed.cli.dask_worker import main; main()"
HERE = ("--host", "127.0.0.1", "--no-dashboard")


@contextmanager
def dask_process(log, code, *arguments, sign):
    """Start a process and yield it with the address that its log has behind a sign."""
    with log.open("w") as stream:
        process = start(*arguments, code=code, stdout=stream, stderr=stream)
    try:
        found = []
        wait_for(
            lambda: found.extend(re.findall(rf"{sign}:\s+(\S+)\n", log.read_text())) or found,
            process,
        )
        yield process, found[0]
    finally:
        process.kill()
        process.wait()


@contextmanager
def empty_cluster(folder):
    """Start a scheduler and yield its address."""
    options = (*HERE, "--port", "0")
    with dask_process(folder / "log", SCHEDULER, *options, sign="Scheduler at") as (_, address):
        yield address


@contextmanager
def worker(folder, address, code=WORKER):
    """Start a worker that bakes one frame at a time."""
    options = (*HERE, "--no-nanny", "--nthreads", "1", "--local-directory", folder)
    log = folder / "log"
    with dask_process(log, code, address, *options, sign="Registered to") as (process, _):
        yield process


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory):
    """Address of a scheduler without workers."""
    with empty_cluster(tmp_path_factory.mktemp("scheduler")) as address:
        yield address


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Address of a scheduler with two workers."""
    folders = [tmp_path_factory.mktemp("cluster") for _ in range(3)]
    with (
        empty_cluster(folders[0]) as address,
        worker(folders[1], address),
        worker(folders[2], address),
    ):
        yield address


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """What this machine bakes without help."""
    folder = tmp_path_factory.mktemp("alone")
    bake(folder, "--frames", "1-12", "--contact-sheet", "s.png")
    made = contents(folder)
    del made["a.sequence.json"]
    return made


@pytest.mark.slow
def test_a_cluster_makes_the_same_bytes(tmp_path, cluster, alone):
    arguments = ("--frames", "1-12", "--contact-sheet", "s.png")
    assert bake(tmp_path, *arguments, "--dask", cluster) == ""
    assert [name for name in listing(tmp_path) if name.startswith(".")] == []
    made = contents(tmp_path)
    del made["a.sequence.json"]
    assert made == alone
    before = {path.name: path.stat().st_ino for path in tmp_path.glob("*.exr")}
    bake(tmp_path, *arguments, "--dask", cluster, "--skip-existing")
    assert {path.name: path.stat().st_ino for path in tmp_path.glob("*.exr")} == before


def test_a_cluster_changes_the_air_frame_by_frame(tmp_path, cluster):
    arguments = ("--frames", "1-3", "--set", "aerosol.optical_depth=0.1..0.3")
    bake(tmp_path, *arguments, "--dask", cluster)
    made = contents(tmp_path)
    bake(tmp_path, *arguments)
    assert contents(tmp_path) == made


def test_frames_of_a_worker_that_dies_are_baked_by_another(
    tmp_path, cluster, tmp_path_factory, alone
):
    arguments = ("--frames", "1-12", "--dask", cluster)
    with worker(tmp_path_factory.mktemp("mortal"), cluster) as mortal:
        process = start(*QUICK, "-o", "a.#.exr", *arguments, cwd=tmp_path)
        wait_for(lambda: len(list(tmp_path.glob("a.*.exr"))) > 1, process)
        mortal.kill()
    output, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    assert "12 frames baked, 0 skipped, 0 failed; " in output
    assert all(re.match(r"skybake: \d+/12 baked ", line) for line in errors.splitlines())
    for path in tmp_path.glob("*.exr"):
        assert path.read_bytes() == alone[path.name]


def test_a_frame_that_fails_on_a_worker_does_not_stop_the_others(tmp_path, cluster):
    process = start(
        *(*QUICK, "-o", "a.#.exr", "-q", "--frames", "1-12", "--dask", cluster), cwd=tmp_path
    )
    wait_for(lambda: listing(tmp_path), process)
    (tmp_path / "a.0012.exr").mkdir()
    output, errors = process.communicate(timeout=120)
    assert (process.returncode, output) == (3, "")
    assert errors.splitlines() == [
        f"skybake: frame 12: {tmp_path}/a.0012.exr: must be a file, got a folder",
        "skybake: frames failed: 12",
    ]
    assert len(listing(tmp_path)) == 13


def test_an_interrupt_cancels_the_frames_of_a_cluster(tmp_path, cluster):
    process = start(
        *(*QUICK, "-o", "a.#.exr", "-q", "--frames", "1-200", "--dask", cluster), cwd=tmp_path
    )
    wait_for(lambda: list(tmp_path.glob("a.*.exr")), process)
    process.send_signal(signal.SIGINT)
    started = time.monotonic()
    output, errors = process.communicate(timeout=60)
    assert time.monotonic() - started < 2.0
    assert (process.returncode, output, errors.strip()) == (130, "", "skybake: interrupted")
    time.sleep(1.0)  # what had begun is finished
    done = listing(tmp_path)
    assert len(done) < 30
    time.sleep(1.0)
    assert listing(tmp_path) == done


def check_refused(tmp_path, address, message, within=10.0, **keywords):
    started = time.monotonic()
    status, output, errors = run(
        *(*QUICK, "-o", "a.#.exr", "-q", "--frames", "1-3", "--dask", address),
        cwd=tmp_path,
        **keywords,
    )
    assert time.monotonic() - started < within
    assert (status, output) == (1, "")
    assert errors.count("\n") == 1
    assert errors.startswith(f"skybake: dask: {message}")
    assert listing(tmp_path) == []


def test_a_scheduler_that_does_not_answer_is_one_line_within_ten_seconds(tmp_path):
    address = "tcp://127.0.0.1:1"
    check_refused(tmp_path, address, f"no scheduler has answered at {address} within 6 s (")


@pytest.mark.parametrize("address", ["carrier-pigeon://loft:1", "tcp://", "nowhere"])
def test_an_address_of_no_scheduler_is_one_line(tmp_path, address):
    check_refused(tmp_path, address, f"no scheduler has answered at {address} within 6 s (")


IMPATIENT = """
import skybake.sequence.dask
skybake.sequence.dask.WORKER_WITHIN = 1
from skybake.cli import run
run()
"""


def test_a_cluster_without_workers_is_one_line(tmp_path, scheduler):
    message = f"{scheduler} has had no worker within 1 s"
    check_refused(tmp_path, scheduler, message, code=IMPATIENT)


OF_ANOTHER_VERSION = f"import skybake.version; skybake.version.__version__ = '0.0.1'; {WORKER}"
ON_ANOTHER_PROCESSOR = (
    "import llvmlite.binding; llvmlite.binding.get_host_cpu_name = lambda: 'i486'; " + WORKER
)
WITHOUT_SKYBAKE = f"import sys; sys.modules['skybake'] = None; {WORKER}"


@pytest.mark.parametrize(
    ("code", "message"),
    [
        (OF_ANOTHER_VERSION, r"must have skybake \S+ as here, got 0\.0\.1\n"),
        (ON_ANOTHER_PROCESSOR, r"must have processor \S+ \S+ as here, got i486 \S+\n"),
        (WITHOUT_SKYBAKE, r"must have skybake \S+, got \S.*\n"),
    ],
)
def test_a_worker_of_another_version_is_refused(tmp_path, scheduler, code, message):
    folders = [tmp_path / name for name in ("maps", "worker")]
    for folder in folders:
        folder.mkdir()
    with worker(folders[1], scheduler, code):
        status, output, errors = run(
            *(*QUICK, "-o", "a.#.exr", "-q", "--frames", "1-3", "--dask", scheduler),
            cwd=folders[0],
        )
    assert (status, output) == (1, "")
    assert re.fullmatch(rf"skybake: dask: worker tcp://127\.0\.0\.1:\d+ {message}", errors)
    assert listing(folders[0]) == []


WITHOUT_EXTRA = """
import sys
sys.modules["dask"] = sys.modules["distributed"] = None
from skybake.cli import run
run()
"""


def test_a_missing_extra_is_one_line_that_names_it(tmp_path):
    check_refused(
        *(tmp_path, "tcp://127.0.0.1:1", "needs distributed; try pip install distributed"),
        code=WITHOUT_EXTRA,
    )
