"""The one place that decides how kernels are compiled, kept and called."""

from __future__ import annotations

import functools
import hashlib
import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm

from skybake.jit import beside
from skybake.jit.arguments import Flat, Kind, flatten_all, word_letters
from skybake.jit.cache import KERNEL_SUFFIX, cache_directory, warn_of_loss
from skybake.jit.machine_code import Entry, MachineCode
from skybake.jit.sealed import read_sealed, write_sealed


class Kernel:
    """A function that is compiled for the types of its arguments when they are first met.

    Compiled code is kept on disk; only where there is none is numba imported. Other
    kernels may call it too. It must not make arrays, raise exceptions or return more
    than a number, and is serial; `skybake.jit.threads` runs several at once.

    Parameters
    ----------
    function : callable
        What numba compiles in its nopython mode.

    Attributes
    ----------
    py_func : callable
        The function itself.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        self._entries: dict[tuple[Kind, ...], Entry] = {}

    def __call__(self, *arguments: Any) -> Any:
        """Call it with what `skybake.jit.arguments.flatten` takes, or returned."""
        kinds, words = flatten_all(arguments)
        entry = self._entries.get(kinds)
        if entry is None:
            with _one_at_a_time:
                entry = self._entries.get(kinds) or self._link(kinds, arguments)
        return entry(words)

    @functools.cached_property
    def _dispatcher(self) -> Any:
        from skybake.jit.compile import linkable

        return linkable(self.py_func)

    @property
    def _numba_type_(self) -> Any:
        """What numba asks for where a kernel that it compiles calls this one."""
        return self._dispatcher._numba_type_

    def _link(self, kinds: tuple[Kind, ...], arguments: tuple[Any, ...]) -> Entry:
        name = self.py_func.__name__
        symbol = f"{name.strip('_')}-{self._digest(kinds)}"
        directory = cache_directory()
        machine_code = (
            None if directory is None else self._load(directory / f"{symbol}{KERNEL_SUFFIX}")
        )
        if machine_code is None:
            machine_code = self._compile(symbol, arguments, word_letters(kinds))
            if directory is not None:
                _keep(directory / f"{symbol}{KERNEL_SUFFIX}", machine_code)
        entry = self._entries[kinds] = Entry(machine_code, word_letters(kinds))
        return entry

    def _load(self, path: Path) -> MachineCode | None:
        content = read_sealed(path)
        if content is None and beside.wait_for(self.py_func.__name__, path):
            content = read_sealed(path)
        return None if content is None else MachineCode.from_bytes(content)

    def _compile(self, symbol: str, arguments: tuple[Any, ...], layout: str) -> MachineCode:
        from skybake.jit.compile import compile_kernel

        values = tuple(each.value if isinstance(each, Flat) else each for each in arguments)
        return compile_kernel(self._dispatcher, symbol, values, layout)

    def _digest(self, kinds: tuple[Kind, ...]) -> str:
        function = self.py_func
        version = f"{function.__module__} {kinds!r} {_processor()!r}".encode()
        return hashlib.sha256(version + function.__code__.co_code).hexdigest()[:16]


def kernel(function: Callable[..., Any]) -> Kernel:
    """Make a kernel of `function`; see `Kernel`."""
    return Kernel(function)


_one_at_a_time = threading.RLock()


def _keep(path: Path, machine_code: MachineCode) -> None:
    """Write a file; where that fails the code serves this process only."""
    try:
        write_sealed(path, machine_code.to_bytes())
    except OSError as error:
        warn_of_loss(path.parent, error)


@functools.cache
def _processor() -> tuple[str, str, str]:
    """Name what machine code is made for, as numba's own settings would have it."""
    name = os.environ.get("NUMBA_CPU_NAME") or llvm.get_host_cpu_name()
    features = os.environ.get("NUMBA_CPU_FEATURES")
    if features is None:
        features = "" if name == "generic" else llvm.get_host_cpu_features().flatten()
    return llvm.get_process_triple(), name, features
