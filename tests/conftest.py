"""Settings of all tests."""

import os
import tempfile
from pathlib import Path

from hypothesis import settings

# One folder of kernels for all processes of all runs, apart from the user's own.
os.environ.setdefault(
    "SKYBAKE_CACHE_DIR", str(Path(tempfile.gettempdir()) / f"skybake-tests-{os.getuid()}")
)

# Kernels compile within the first example, and a run must not depend on luck.
settings.register_profile("skybake", deadline=None, derandomize=True, database=None)
settings.load_profile("skybake")


def pytest_addoption(parser):
    parser.addoption(
        "--update-goldens", action="store_true", help="write the maps of tests/goldens anew"
    )
