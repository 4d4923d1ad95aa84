"""The one place that decides how kernels are compiled, cached and threaded."""

from __future__ import annotations

import functools
import hashlib
import os
import subprocess
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba
from numba.core.runtime.nrt import rtsys

# Without nnan and ninf: kernels may rely on the meaning of inf and nan.
FAST_MATH = {"nsz", "arcp", "contract", "afn", "reassoc"}

_KERNEL_PACKAGES = ("optics", "transport", "luts", "sky", "projection", "reference")


def kernel(function: Callable[..., Any]) -> Any:
    """Compile `function` on first call, without the GIL, kept on disk.

    Kernels are serial and take a range of rows; `run_rows` gives each thread
    its ranges. Measured against ``parallel=True`` this halves the compile time
    and saves milliseconds a call, and the result has the same bits for any
    number of threads.
    """
    return _compile_later(function)


def inner_kernel(function: Callable[..., Any]) -> Any:
    """Compile `function` for other kernels only: Python cannot call it.

    What would unpack its arguments from Python's objects costs more time to compile
    than many a kernel itself. Nor is memory counted in it: it must not make arrays.
    """
    return _compile_later(function, no_cpython_wrapper=True, _nrt=False)


def _compile_later(function: Callable[..., Any], **extra: bool) -> Any:
    options: dict[str, Any] = {"nogil": True, "fastmath": FAST_MATH, "error_model": "numpy"}
    options |= {"no_cfunc_wrapper": True, **extra}
    directory = cache_directory()
    if directory is None:
        return numba.njit(**options)(function)
    # numba resolves its cache folder while it decorates and nowhere later, so
    # other users of numba in this process keep the folder that they chose.
    config: Any = numba.config
    previous = config.CACHE_DIR
    config.CACHE_DIR = str(directory)
    try:
        dispatcher: Any = numba.njit(cache=True, **options)(function)
    except RuntimeError:
        # numba found no room for the folder that it keeps for each of ours.
        _warn_of_full_disk(directory)
        return numba.njit(**options)(function)
    finally:
        config.CACHE_DIR = previous
    stored = dispatcher._cache
    stored.save_overload = functools.partial(_save_compiled, directory, stored.save_overload)
    if hasattr(stored, "_load_overload"):
        stored.load_overload = functools.partial(_load_compiled, stored, function.__name__)
    return dispatcher


def _save_compiled(
    directory: Path, save: Callable[[Any, Any], None], signature: Any, compiled: Any
) -> None:
    """Keep a compiled kernel on disk; where that fails it serves this process only."""
    try:
        save(signature, compiled)
    except OSError:
        _warn_of_full_disk(directory)


def _load_compiled(stored: Any, name: str, signature: Any, target_context: Any) -> Any:
    """Load a kernel from disk without the machinery that compiles kernels.

    As it comes, numba imports some 180 modules (and scipy, where it is installed)
    before it looks whether a compiled kernel is there: 0.4 s, twice what the rest
    of a render's start takes. What a compiled kernel needs of them is the memory
    manager. Where none is found, numba's compiler loads them itself.
    """
    rtsys.initialize(target_context)
    with stored._guard_against_spurious_io_errors():
        compiled = stored._load_overload(signature, target_context)
        if compiled is None and name in _beside.names:
            _beside.wait()
            compiled = stored._load_overload(signature, target_context)
        return compiled


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


@functools.cache
def cache_directory() -> Path | None:
    """Folder of the compiled kernels, or None where none can be written.

    It is named by a hash of the kernels' sources, because numba does not notice
    an edit to a kernel that another file's kernel calls (numba issue 9483).
    SKYBAKE_CACHE_DIR and NUMBA_CACHE_DIR take precedence over the user's cache
    folder.
    """
    configured = os.environ.get("SKYBAKE_CACHE_DIR") or os.environ.get("NUMBA_CACHE_DIR")
    parent = Path(configured) if configured else _user_cache()
    if parent is None:
        _warn_of_no_cache("SKYBAKE_CACHE_DIR: kernel cache must be given without a home folder")
        return None
    directory = parent / f"kernels-{_source_hash()}"
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError:
        writable = False
    else:
        writable = os.access(directory, os.W_OK | os.X_OK)
    if not writable:
        _warn_of_no_cache(f"{directory}: kernel cache must be writable")
        return None
    return directory


@functools.cache
def _warn_of_full_disk(directory: Path) -> None:
    _warn_of_no_cache(f"{directory}: kernel cache must have room")


def _warn_of_no_cache(fault: str) -> None:
    warnings.warn(f"{fault}; compiling anew in every process", RuntimeWarning, stacklevel=3)


def is_warm() -> bool:
    """Whether compiled kernels of this version lie on disk."""
    directory = cache_directory()
    return directory is not None and any(directory.rglob("*.nbc"))


def thread_count() -> int:
    """CPUs that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run_rows(rows: int, work: Callable[[int, int], object], *, chunk: int = 1) -> None:
    """Call ``work(first, last)`` over chunks of ``range(rows)`` on all threads.

    Chunks are handed out as threads become free, since rows differ in cost.
    Each call must write to its own rows only. A call from one of the threads
    itself runs there alone: waiting for the others could wait forever.
    """
    starts = range(0, rows, chunk)
    if thread_count() == 1 or len(starts) == 1 or runs_alone():
        for first in starts:
            work(first, min(first + chunk, rows))
        return
    futures = [_pool().submit(work, first, min(first + chunk, rows)) for first in starts]
    try:
        for future in futures:
            future.result()
    except BaseException:
        for future in futures:
            future.cancel()
        raise


def lone_threads(count: int) -> ThreadPoolExecutor:
    """Threads that share no work: `run_rows` stays in the one that calls it."""
    return ThreadPoolExecutor(count, initializer=stay_in_thread)


def stay_in_thread() -> None:
    """Let `run_rows` use no other threads from now on when this one calls it."""
    _here.is_worker = True


def runs_alone() -> bool:
    """Whether the caller is one of several threads that are all busy."""
    return getattr(_here, "is_worker", False)


@functools.cache
def _pool() -> ThreadPoolExecutor:
    return lone_threads(thread_count())


_here = threading.local()


@functools.cache
def _source_hash() -> str:
    package = Path(__file__).parent.parent
    digest = hashlib.sha256(numba.__version__.encode())
    for name in _KERNEL_PACKAGES:
        for source in sorted((package / name).glob("*.py")):
            digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _user_cache() -> Path | None:
    """Folder for this program's files by the platform's convention; None without a home."""
    configured = os.environ.get("LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME")
    if configured:
        return Path(configured) / "skybake"
    try:
        home = Path.home()
    except RuntimeError:
        return None
    within = {"win32": "AppData/Local", "darwin": "Library/Caches"}.get(sys.platform, ".cache")
    return home / within / "skybake"
