"""A second process that compiles kernels in the background."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from skybake.jit.cache import cache_folder
from skybake.jit.private_folder import PrivateFolder
from skybake.jit.workers import cpu_count

PAUSE = 0.01
"""Time between two checks for a file. [s]"""

# With -P neither the working folder nor a script's is searched for modules. Where this
# process has found skybake in one of them, that one folder is added.
_RUN = """
import runpy, sys
home, module = sys.argv[1:]
if home not in sys.path:
    sys.path.insert(0, home)
runpy.run_module(module, run_name="__main__")
"""


@contextmanager
def compile_in_background(module: str, names: frozenset[str]) -> Iterator[None]:
    """Have another process compile kernels that this one needs later, if that helps.

    Parameters
    ----------
    module : str
        Compiles them when it is run, within `end_with_parent`.
    names : frozenset of str
        The kernels; a caller waits until the process has written one or has ended, and
        then compiles what is missing.
    """
    if cache_folder() is not None and cpu_count() > 1 and sys.executable:
        _background.start(python_command(module), names)
    try:
        yield
    finally:
        _background.stop()


def python_command(module: str) -> list[str]:
    """Return a command that runs a module of skybake without the working folder in its path."""
    home = str(Path(__file__).parents[2])
    return [sys.executable, "-P", "-c", _RUN, home, module]


def end_with_parent(work: Callable[[], None]) -> None:
    """Do what `compile_in_background` started a process for, until that one has ended.

    The other end of standard input closes when the process that started this one ends,
    however it ends.
    """
    threading.Thread(target=_exit_at_end_of_input, daemon=True).start()
    work()


def _exit_at_end_of_input() -> None:
    with suppress(OSError):
        while os.read(0, 1):
            pass
    os._exit(1)


def wait_for(name: str, folder: PrivateFolder, file: str) -> bool:
    """Wait for a file if the process writes it.

    Parameters
    ----------
    name : str
        The kernel.
    folder : PrivateFolder
        Where kernels are kept.
    file : str
        The file that holds it, which appears complete.

    Returns
    -------
    bool
        Whether it may be there now.
    """
    if name not in _background.names:
        return False
    while not folder.has(file) and _background.runs():
        time.sleep(PAUSE)
    return True


class _Background:
    """A process that compiles kernels into the same folder."""

    def __init__(self) -> None:
        self.names: frozenset[str] = frozenset()
        self._process: subprocess.Popen[bytes] | None = None

    def start(self, command: list[str], names: frozenset[str]) -> None:
        nothing, pipe = subprocess.DEVNULL, subprocess.PIPE
        with suppress(OSError):
            self._process = subprocess.Popen(command, stdin=pipe, stdout=nothing, stderr=nothing)
            self.names = names

    def runs(self) -> bool:
        return self._process is not None and self._process.poll() is None

    def stop(self) -> None:
        if self._process is not None:
            self._process.terminate()
            self._process.communicate()
            self._process = None
        self.names = frozenset()

    def forget(self) -> None:
        """Leave the process to the one that started it, and let it notice when that one ends."""
        if self._process is not None and self._process.stdin is not None:
            self._process.stdin.close()
            self._process.returncode = 0
        self._process = None
        self.names = frozenset()


_background = _Background()

if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_background.forget)
