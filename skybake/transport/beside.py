"""Another process that compiles kernels while this one goes on."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from skybake.transport.cache import cache_directory
from skybake.transport.threads import thread_count


@contextmanager
def compile_beside(module: str, names: frozenset[str]) -> Iterator[None]:
    """Have another process compile kernels that this one needs later, where that helps.

    Parameters
    ----------
    module : str
        Compiles them when it is run.
    names : frozenset of str
        The kernels; whoever calls one waits until the process has ended, and compiles
        itself what it then still does not find.
    """
    if cache_directory() is not None and thread_count() > 1:
        _beside.start([sys.executable, "-m", module], names)
    try:
        yield
    finally:
        _beside.stop()


def wait_for(name: str) -> bool:
    """Wait for the process if it compiles a kernel of that name; returns whether it does."""
    if name not in _beside.names:
        return False
    _beside.wait()
    return True


class _Beside:
    """A process that compiles kernels into the same folder."""

    def __init__(self) -> None:
        self.names: frozenset[str] = frozenset()
        self._process: subprocess.Popen[bytes] | None = None

    def start(self, command: list[str], names: frozenset[str]) -> None:
        nothing = subprocess.DEVNULL
        self._process = subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing)
        self.names = names

    def wait(self) -> None:
        if self._process is not None:
            self._process.wait()
        self.names = frozenset()

    def stop(self) -> None:
        if self._process is not None:
            self._process.terminate()
        self.wait()


_beside = _Beside()
