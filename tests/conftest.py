"""Settings of all tests."""

import os
import signal
import subprocess
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

# One folder of kernels for all processes of all runs, apart from the user's own.
os.environ.setdefault(
    "SKYBAKE_CACHE_DIR", str(Path(tempfile.gettempdir()) / f"skybake-tests-{os.getuid()}")
)

# Kernels compile within the first example, and a run must not depend on luck.
settings.register_profile("skybake", deadline=None, derandomize=True, database=None)
settings.load_profile("skybake")


# Processes of tests inherit an ignored interrupt, as of a shell's background job, and none other.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser):
    parser.addoption(
        "--update-goldens", action="store_true", help="write the maps of tests/goldens anew"
    )


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config):
    """Spread folders over the CPUs, a file to a worker, whose tests share solved atmospheres.

    A single file starts sooner in one process, as everything does with `-n0` or `-p no:xdist`.
    """
    option = config.option
    is_worker = "PYTEST_XDIST_WORKER" in os.environ
    is_alone = all(Path(place.partition("::")[0]).suffix == ".py" for place in config.args)
    if config.pluginmanager.hasplugin("xdist") and option.numprocesses is None:
        if is_worker or is_alone or option.usepdb or option.collectonly:
            return
        option.numprocesses = min(len(os.sched_getaffinity(0)), 4)
        option.dist = "loadfile"
        # By number of tests, files of few long ones would come last and keep one CPU.
        option.loadscopereorder = False


@pytest.fixture
def small_disk(tmp_path, request):
    """A file system of 64 KiB, or as an indirect parameter says to ``mount -o``."""
    disk = tmp_path / "disk"
    disk.mkdir()
    options = getattr(request, "param", "size=64k")
    mount = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", disk]
    if subprocess.run(mount, check=False, capture_output=True).returncode:
        pytest.skip("mounting a small file system needs root")
    yield disk
    subprocess.run(["umount", disk], check=True)
