"""The one place that decides how kernels are compiled and threaded."""

from __future__ import annotations

import functools
import hashlib
import os
import pickle
import re
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from skybake.transport.cache import (
    KERNEL_SUFFIX,
    cache_directory,
    read_sealed,
    warn_of_full_disk,
    write_sealed,
)

# Without nnan and ninf: kernels may rely on the meaning of inf and nan.
FAST_MATH = {"nsz", "arcp", "contract", "afn", "reassoc"}


def kernel(function: Callable[..., Any]) -> Any:
    """Compile `function` on first call by Python, without the GIL, kept on disk.

    Kernels are serial and take a range of rows; `run_rows` gives each thread
    its ranges. Measured against ``parallel=True`` this halves the compile time
    and saves milliseconds a call, and the result has the same bits for any
    number of threads. No other kernel may call it: the file has no code to link to.
    """
    return _compile_later(function, is_linked=False)


def shared_kernel(function: Callable[..., Any]) -> Any:
    """Compile `function` for Python and for other kernels, at the cost of slower loading."""
    return _compile_later(function)


def inner_kernel(function: Callable[..., Any]) -> Any:
    """Compile `function` for other kernels only: Python cannot call it.

    What would unpack its arguments from Python's objects costs more time to compile
    than many a kernel itself. Nor is memory counted in it: it must not make arrays.
    """
    return _compile_later(function, no_cpython_wrapper=True, _nrt=False)


def _compile_later(function: Callable[..., Any], *, is_linked: bool = True, **extra: bool) -> Any:
    options: dict[str, Any] = {"nogil": True, "fastmath": FAST_MATH, "error_model": "numpy"}
    options |= {"no_cfunc_wrapper": True, **extra}
    dispatcher: Any = numba.njit(**options)(function)
    directory = cache_directory()
    if directory is not None:
        dispatcher._cache = _KernelCache(function, directory, is_linked=is_linked)
    return dispatcher


class _KernelCache(_Cache):
    """Compiled versions of one kernel on disk, a file for each signature and processor.

    In the place of numba's own cache, which tries the folder for each kernel, trusts
    what it finds there, and imports the machinery that compiles (some 180 modules, and
    scipy where it is installed) before it looks whether a kernel is compiled already.
    """

    def __init__(self, function: Callable[..., Any], directory: Path, *, is_linked: bool) -> None:
        self._function = function
        self._directory = directory
        self._is_linked = is_linked

    @property
    def cache_path(self) -> str:
        """Where the files lie."""
        return str(self._directory)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return a compiled kernel, or None if there is none."""
        # What a compiled kernel needs of numba's machinery is the memory manager.
        rtsys.initialize(target_context)
        path = self._path(sig, target_context.codegen())
        content = read_sealed(path)
        if content is None and self._function.__name__ in _beside.names:
            _beside.wait()
            content = read_sealed(path)
        if content is None:
            return None
        return CompileResult._rebuild(target_context, *pickle.loads(content))

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled kernel; where that fails it serves this process only."""
        try:
            parts = data._reduce() if self._is_linked else _unlinked(data)
            write_sealed(self._path(sig, data.codegen), dumps(parts))
        except OSError:
            warn_of_full_disk(self._directory)

    def enable(self) -> None:
        """Do nothing: it is always on."""

    def disable(self) -> None:
        """Do nothing: it is always on."""

    def flush(self) -> None:
        """Do nothing: the folder's name changes with the sources."""

    def _path(self, signature: Any, codegen: Any) -> Path:
        function = self._function
        version = f"{function.__module__} {signature!r} {codegen.magic_tuple()!r}".encode()
        digest = hashlib.sha256(version + function.__code__.co_code).hexdigest()[:16]
        name = re.sub(r"\W+", "_", function.__name__)
        return self._directory / f"{name}-{digest}{KERNEL_SUFFIX}"


def _unlinked(compiled: Any) -> tuple[Any, ...]:
    """Parts of a compiled kernel without what another would be linked to.

    That code, and the environments of what was compiled into it (numba's own array
    functions, whose modules would be imported), take ten times as long to load as the
    machine code. What is loaded must still name the function.
    """
    (name, kind, (machine_code, _)), descriptor, *others, _ = compiled._reduce()
    wrapper = f'define void @"{descriptor.llvm_cpython_wrapper_name}"() {{ ret void }}'
    named = llvmlite.binding.parse_assembly(wrapper).as_bitcode()
    return (name, kind, (machine_code, named)), descriptor, *others, ()


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
