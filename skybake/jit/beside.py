"""Another process that compiles kernels while this one goes on."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from skybake.jit.cache import cache_directory
from skybake.jit.workers import cpu_count

PAUSE = 0.01
"""Time between two looks for a file. [s]"""


@contextmanager
def compile_beside(module: str, names: frozenset[str]) -> Iterator[None]:
    """Have another process compile kernels that this one needs later, where that helps.

    Parameters
    ----------
    module : str
        Compiles them when it is run.
    names : frozenset of str
        The kernels; whoever calls one waits until the process has written it or has
        ended, and then compiles itself what it does not find.
    """
    if cache_directory() is not None and cpu_count() > 1:
        _beside.start([sys.executable, "-m", module], names)
    try:
        yield
    finally:
        _beside.stop()


def wait_for(name: str, path: Path) -> bool:
    """Wait for a file if the process writes it.

    Parameters
    ----------
    name : str
        The kernel.
    path : Path
        The file that holds it, which appears whole.

    Returns
    -------
    bool
        Whether it may be there now.
    """
    if name not in _beside.names:
        return False
    while not path.exists() and _beside.runs():
        time.sleep(PAUSE)
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

    def runs(self) -> bool:
        return self._process is not None and self._process.poll() is None

    def stop(self) -> None:
        if self._process is not None:
            self._process.terminate()
            self._process.wait()
        self.names = frozenset()


_beside = _Beside()
