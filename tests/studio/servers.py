"""Servers of the studio as processes of their own, and clients of them."""

import http.client
import json
import signal
import time
from contextlib import contextmanager
from urllib.parse import urlsplit

import numpy as np

from tests.cli.runs import start

TOKEN = "a-token-of-the-tests"  # noqa: S105

RELEASED, STOPPED = "released", "stopped"
HOLDING = f"""
from pathlib import Path
from time import sleep

from skybake.cli import run
from skybake.errors import CancelledError
from skybake.preset import load_preset
from skybake.studio import scenes, views

released = Path({RELEASED!r}).absolute()
earth = load_preset("earth").recipe
solve = views.solve

def held(scene, stage):
    if scene.planet.recipe != earth:
        stage(scenes.SOLVING, None)
        scene.workers.tell(0.25)
        while not released.exists():
            try:
                scene.workers.check()
            except CancelledError:
                Path({STOPPED!r}).touch()
                raise
            sleep(0.01)
    solve(scene, stage)

views.solve = held
run()
"""
"""A server that solves Earth, and all other worlds once the file `RELEASED` is in its folder.

The file `STOPPED` is there once such a solution was cancelled.
"""


class Server:
    """A running server."""

    def __init__(self, process, url):
        self.process, self.url = process, url
        self.port = urlsplit(url).port
        self.token = url.partition("token=")[2]

    def request(self, path, *, method="GET", body=None, token=True, headers=None):
        """Return status, headers and body of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=600)
        given = {"X-Skybake-Token": self.token} if token else {}
        connection.request(method, path, body, given | (headers or {}))
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, dict(answer.headers), content

    def json(self, path, data=None):
        """Return the JSON of an answer, whatever its status."""
        method, body = ("GET", None) if data is None else ("POST", json.dumps(data))
        return json.loads(self.request(path, method=method, body=body)[2])

    def end(self, number=signal.SIGINT):
        """Send a signal; returns exit status, the rest of stdout, and stderr."""
        self.process.send_signal(number)
        output, errors = self.process.communicate(timeout=600)
        return self.process.returncode, output, errors


@contextmanager
def serving(folder, *arguments, port=0, **keywords):
    """Run a server in a folder as long as the block lasts; `keywords` are those of `start`."""
    process = start(
        *("studio", "--no-browser", "--port", port, *arguments),
        cwd=folder,
        env={"SKYBAKE_STUDIO_TOKEN": TOKEN},
        **keywords,
    )
    try:
        yield Server(process, process.stdout.readline().strip())
    finally:
        process.kill()
        process.communicate()


def wait_until(condition):
    """Wait for what another process does."""
    end = time.monotonic() + 600.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def read_frame(message):
    """Return header and pixels of a picture, in cd/m2 of white."""
    length = int.from_bytes(message[:4], "little")
    header = json.loads(message[4 : 4 + length])
    texels = np.frombuffer(message[4 + length :], "<f2")
    shape = header["height"], header["width"], header["channels"]
    return header, texels.reshape(shape).astype(np.float32)
