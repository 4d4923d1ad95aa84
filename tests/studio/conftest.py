"""What tests of the studio share: a browser and a server for each file."""

import pytest

from tests.studio.browser import chromium
from tests.studio.servers import serving


@pytest.fixture(scope="module")
def browser():
    with chromium() as one:
        yield one


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with serving(tmp_path_factory.mktemp("studio")) as one:
        yield one
