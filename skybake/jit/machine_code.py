"""Compiled kernels as machine code, which is loaded and called without numba.

Importing numba takes longer than a small map, and a process that finds its kernels on
disk does not need it: LLVM alone links them.
"""

from __future__ import annotations

import ctypes
import functools
import itertools
import struct
from typing import Any, NamedTuple

import llvmlite.binding as llvm

RESULTS = ("none", "bool", "int", "float")
"""What a kernel may return."""


class MachineCode(NamedTuple):
    """A kernel for one processor and one set of types.

    Attributes
    ----------
    symbol : str
        Name of its entry: a C function ``int32 (const int64 *words, int64 *result)`` that
        returns 0 unless the kernel raised an exception.
    result : str
        What it returns, one of `RESULTS`.
    code : bytes
        An object file.
    """

    symbol: str
    result: str
    code: bytes

    def to_bytes(self) -> bytes:
        """Return the content of a file."""
        return f"{self.symbol} {self.result}\n".encode() + self.code

    @classmethod
    def from_bytes(cls, content: memoryview) -> MachineCode:
        """Read what `to_bytes` returned.

        Raises
        ------
        ValueError
            If it is anything else.
        """
        head, _, code = bytes(content).partition(b"\n")
        symbol, result = head.decode().split()
        if result not in RESULTS:
            raise ValueError(f"{symbol}: must return one of {', '.join(RESULTS)}, got {result}")
        return cls(symbol, result, code)


class Entry:
    """Machine code that is linked into this process.

    Parameters
    ----------
    machine_code : MachineCode
        Made on this processor.
    layout : str
        Letters by which `struct` packs the words of its arguments.
    """

    def __init__(self, machine_code: MachineCode, layout: str) -> None:
        address = _link(machine_code)
        self._call = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_char_p, ctypes.c_void_p)(address)
        self._pack = struct.Struct(f"={layout}").pack
        self._is_none = machine_code.result == "none"
        self._result = {"bool": "?", "float": "d"}.get(machine_code.result, "q")

    def __call__(self, words: list[int | float]) -> Any:
        """Run it without the GIL."""
        result = ctypes.c_int64()
        if self._call(self._pack(*words), ctypes.addressof(result)) != 0:
            raise RuntimeError("kernel: must not raise exceptions")
        if self._is_none:
            return None
        return struct.unpack_from(self._result, result)[0]


def _link(machine_code: MachineCode) -> int:
    """Link code into this process; returns the address of its entry."""
    symbol = machine_code.symbol
    builder = llvm.JITLibraryBuilder().add_object_img(machine_code.code).export_symbol(symbol)
    # Kernels call the C library's mathematics.
    name = f"{symbol} {next(_numbers)}"
    library = builder.add_current_process().link(_linker(), name)
    # Its code is freed with the library.
    _libraries.append(library)
    return int(library[symbol])


_libraries: list[Any] = []
_numbers = itertools.count()


@functools.cache
def _linker() -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine(jit=True)
    return llvm.create_lljit_compiler(machine)
