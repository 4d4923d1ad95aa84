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

LONGEST = (
    "clouds/test_fields.py",
    "reference/test_cloudy.py",
    "baking/test_preview.py",
    "aerial/test_clouded.py",
    "studio/test_page.py",
    "eclipse/test_light.py",
    "test_accuracy.py",
    "sky/test_table.py",
    "cloud_fields/test_shapes.py",
    "baking/test_anchors.py",
    "test_readme.py",
    "reference/test_estimate.py",
    "studio/test_live.py",
    "cli/test_pictures.py",
    "cli/test_processes.py",
    "sequence/test_processes.py",
    "sequence/test_dask.py",
    "test_python_document.py",
    "test_sequences_document.py",
)
"""Files that take longest, which begin first so that none of them ends alone. Of the first ones,
which workers begin with, each needs other kernels."""


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


def pytest_collection_modifyitems(items):
    """Put the longest files first; within a file the order stays."""
    tests = Path(__file__).parent
    places = {tests / name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: places.get(item.path, len(places)))


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
