"""Decides how kernels are compiled, kept and called."""

from __future__ import annotations

import functools
import hashlib
import os
import threading
from collections.abc import Callable
from typing import Any

import llvmlite.binding as llvm

from skybake.jit import background_compiler
from skybake.jit.arguments import Flat, Kind, flatten_all, word_letters
from skybake.jit.cache import KERNEL_SUFFIX, cache_folder, warn_of_loss
from skybake.jit.digest import add_digest, remove_digest
from skybake.jit.machine_code import Entry, MachineCode
from skybake.jit.private_folder import PrivateFolder

_CONSTANT = (int, float, complex, str, tuple)


class Kernel:
    """A function that is compiled for the types of its arguments at their first use.

    Compiled code is kept on disk; only where there is none is numba imported. Other
    kernels may call it. It must not make arrays, raise exceptions or return more
    than a number, and is serial; `skybake.jit.workers` runs several at once.

    Parameters
    ----------
    function : callable
        What numba compiles in its nopython mode.
    is_inlined : bool, optional
        Whether kernels that call it contain it.

    Attributes
    ----------
    py_func : callable
        The function itself.
    """

    def __init__(self, function: Callable[..., Any], *, is_inlined: bool = False) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        self._is_inlined = is_inlined
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

        return linkable(self.py_func, is_inlined=self._is_inlined)

    @property
    def _numba_type_(self) -> Any:
        """What numba needs where a kernel that it compiles calls this one."""
        return self._dispatcher._numba_type_

    def _link(self, kinds: tuple[Kind, ...], arguments: tuple[Any, ...]) -> Entry:
        name, layout = self.py_func.__name__, word_letters(kinds)
        symbol = f"{name.strip('_')}-{self._digest(kinds)}"
        purpose = f"kernel {symbol} of {kinds!r} as {layout} for {_processor()!r}"
        folder = cache_folder()
        machine_code = None
        if folder is not None:
            machine_code = _load(folder, symbol, purpose)
            if machine_code is None and background_compiler.wait_for(name, folder, _file(symbol)):
                machine_code = _load(folder, symbol, purpose)
        if machine_code is None:
            _check_compiler(folder)
            machine_code = self._compile(symbol, arguments, layout)
            if folder is not None:
                _keep(folder, machine_code, purpose)
        entry = self._entries[kinds] = Entry(machine_code, layout)
        return entry

    def _compile(self, symbol: str, arguments: tuple[Any, ...], layout: str) -> MachineCode:
        from skybake.jit.compile import compile_kernel

        values = tuple(each.value if isinstance(each, Flat) else each for each in arguments)
        return compile_kernel(self._dispatcher, symbol, values, layout)

    def _digest(self, kinds: tuple[Kind, ...]) -> str:
        function, code = self.py_func, self.py_func.__code__
        constants = [each for each in code.co_consts if isinstance(each, _CONSTANT)]
        parts = function.__module__, kinds, _processor(), code.co_names, constants
        return hashlib.sha256(repr(parts).encode() + code.co_code).hexdigest()[:16]


def kernel(function: Callable[..., Any]) -> Kernel:
    """Make a kernel of `function`; see `Kernel`."""
    return Kernel(function)


def inlined_kernel(function: Callable[..., Any]) -> Kernel:
    """Make a kernel that those which call it contain.

    Tuples are passed by value: where one of many arrays goes through several calls for each
    sample, copies of it take as long as the work itself.
    """
    return Kernel(function, is_inlined=True)


_one_at_a_time = threading.RLock()

if hasattr(os, "register_at_fork"):
    # A forked process has none of its parent's threads: what one of them had begun to
    # compile, or held a lock of LLVM's for, would never end there.
    os.register_at_fork(
        before=_one_at_a_time.acquire,
        after_in_parent=_one_at_a_time.release,
        after_in_child=_one_at_a_time.release,
    )


_checked: set[PrivateFolder | None] = set()


def _check_compiler(folder: PrivateFolder | None) -> None:
    """Make sure that what numba compiles takes arguments as they are given here."""
    if folder not in _checked:
        from skybake.jit.canary import check_arguments

        check_arguments(folder)
        _checked.add(folder)


def _file(symbol: str) -> str:
    return f"{symbol}{KERNEL_SUFFIX}"


def _load(folder: PrivateFolder, symbol: str, purpose: str) -> MachineCode | None:
    """Read a kernel; None if it is missing, or is not what was written for that purpose."""
    stored = folder.read(_file(symbol))
    content = None if stored is None else remove_digest(stored, purpose)
    if content is None:
        return None
    try:
        machine_code = MachineCode.from_bytes(content)
    except ValueError:
        return None
    return machine_code if machine_code.symbol == symbol else None


def _keep(folder: PrivateFolder, machine_code: MachineCode, purpose: str) -> None:
    """Write a file; where that fails the code serves this process only."""
    try:
        folder.write(_file(machine_code.symbol), add_digest(machine_code.to_bytes(), purpose))
    except OSError as error:
        warn_of_loss(folder.path, error)


@functools.cache
def _processor() -> tuple[str, str, str]:
    """Name what machine code is made for, as numba's own settings would have it."""
    name = os.environ.get("NUMBA_CPU_NAME") or llvm.get_host_cpu_name()
    features = os.environ.get("NUMBA_CPU_FEATURES")
    if features is None:
        features = "" if name == "generic" else llvm.get_host_cpu_features().flatten()
    return llvm.get_process_triple(), name, features
