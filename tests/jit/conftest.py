"""A cache of kernels that is filled once."""

import shutil

import pytest

from tests.jit.cached_runs import run


@pytest.fixture(scope="module")
def compiled_once(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compiled")
    run(folder)
    return folder


@pytest.fixture
def filled(compiled_once, tmp_path):
    """A cache that holds what `SCRIPT` needs, and the folder of this version in it."""
    shutil.copytree(compiled_once, tmp_path, dirs_exist_ok=True)
    (folder,) = tmp_path.glob("kernels-*")
    return folder
