"""What tests of the command line start from."""

import pytest

from tests.cli.runs import SMALL, render


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder, the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="session")
def warm(tmp_path_factory):
    """Kernels are compiled."""
    render(tmp_path_factory.mktemp("warm") / "a.exr", *SMALL, "--preview")
