"""Compiles kernels to machine code, by way of numba."""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numba
from llvmlite import ir
from numba.core import types
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target

from skybake.errors import SkybakeError
from skybake.jit.arguments import ARRAY_FIELDS
from skybake.jit.machine_code import MachineCode

# Without nnan and ninf: kernels may rely on the meaning of inf and nan.
FAST_MATH = {"nsz", "arcp", "contract", "afn", "reassoc"}

_OF_NUMBA = ("numba_", "NRT_", "Py")

_WORD = ir.IntType(64)
_STATUS = ir.IntType(32)
_RESULTS = {types.none: "none", types.boolean: "bool", types.int64: "int", types.float64: "float"}


def linkable(function: Callable[..., Any], *, is_inlined: bool = False) -> Any:
    """Return what numba links into a kernel that calls `function`, or that contains it.

    Neither can Python call it nor is memory counted in it: kernels make no arrays.
    """
    options: dict[str, Any] = {"nogil": True, "fastmath": FAST_MATH, "error_model": "numpy"}
    options |= {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "_nrt": False}
    options |= {"forceinline": True} if is_inlined else {}
    return numba.njit(**options)(function)


def compile_kernel(
    dispatcher: Any, symbol: str, arguments: tuple[Any, ...], layout: str
) -> MachineCode:
    """Compile a kernel for the types of arguments.

    Parameters
    ----------
    dispatcher : object
        Made by `linkable`.
    symbol : str
        Name of the entry, of its own in every process that links it.
    arguments : tuple
        As `skybake.jit.arguments.flatten` takes them.
    layout : str
        Their words, q for whole numbers and addresses, d for floats.

    Returns
    -------
    MachineCode
        The kernel and all that it calls.

    Raises
    ------
    SkybakeError
        If this version of numba passes arguments in another way.
    TypeError
        If the kernel needs numba to run.
    """
    signature = tuple(numba.typeof(argument) for argument in arguments)
    for kind in signature:
        _check_fields(kind)
    with global_compiler_lock, _without_emission(), _without_collection():
        dispatcher.compile(signature)
    compiled = dispatcher.overloads[signature]
    module = llvm.parse_assembly(str(_entry(compiled, symbol, layout)))
    module.link_in(compiled.library._get_module_for_linking(), preserve=True)
    for function in module.functions:
        if not function.is_declaration and function.name != symbol:
            function.linkage = llvm.Linkage.internal
        if function.is_declaration and function.name.startswith(_OF_NUMBA):
            raise TypeError(f"{symbol}: must do without numba's own functions, got {function.name}")
    machine = compiled.target_context.codegen()._tm
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    passes.run(module, llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options()))
    return MachineCode(
        symbol, _RESULTS[compiled.signature.return_type], machine.emit_object(module)
    )


def layout_error(expected: str, got: str) -> SkybakeError:
    """Error for arguments that numba does not pass as `skybake.jit.arguments` lays them out."""
    versions = f"numba {numba.__version__} with llvmlite {llvmlite.__version__}"
    return SkybakeError(f"{versions}: must pass arguments {expected}, got {got}")


def parts_of(kind: Any) -> tuple[Any, ...]:
    """Types of what a tuple consists of."""
    return tuple(kind)


def _check_fields(kind: Any) -> None:
    """Refuse arrays and tuples whose parts numba has in another order than arguments have."""
    if isinstance(kind, types.BaseTuple):
        for each in parts_of(kind):
            _check_fields(each)
        expected: tuple[str, ...] = tuple(f"f{i}" for i in range(len(parts_of(kind))))
    elif isinstance(kind, types.Array):
        expected = ARRAY_FIELDS
    else:
        return
    # Tuples of one kind have no fields.
    model = cpu_target.target_context.data_model_manager[kind]
    fields = tuple(getattr(model, "_fields", expected))
    if fields != expected:
        raise layout_error(f"as {', '.join(expected)}", ", ".join(fields))


@contextmanager
def _without_emission() -> Iterator[None]:
    """Keep numba from making machine code of each kernel that is to be linked into another.

    That would take a sixth of the time, for code that is never called.
    """
    codegen = cpu_target.target_context.codegen()
    engine = codegen._engine
    codegen._engine = _NoEngine()
    try:
        yield
    finally:
        codegen._engine = engine


class _NoEngine:
    """Replaces numba's LLVM engine, and discards what is added to it."""

    def __init__(self) -> None:
        self._nowhere = ctypes.c_void_p()

    def __getattr__(self, name: str) -> Callable[..., None]:
        return lambda *_: None

    def is_symbol_defined(self, _name: str) -> bool:
        """Claim to know every name."""
        return True

    def get_function_address(self, _name: str) -> int:
        """Return an address that is never called: such functions have no wrapper."""
        return ctypes.addressof(self._nowhere)

    get_global_value_address = get_function_address


@contextmanager
def _without_collection() -> Iterator[None]:
    """Let no garbage be collected: there is little among the many objects that numba makes."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def _entry(compiled: Any, symbol: str, layout: str) -> ir.Module:
    """Make a C function that takes a compiled function's arguments from a row of words."""
    context, descriptor = compiled.target_context, compiled.fndesc
    module = context.codegen()._create_empty_module(symbol)
    pointer = _WORD.as_pointer()
    entry = ir.Function(module, ir.FunctionType(_STATUS, [pointer, pointer]), symbol)
    words, result = entry.args
    builder = ir.IRBuilder(entry.append_basic_block())
    packer = context.get_arg_packer(descriptor.argtypes)
    expected = ("d" if isinstance(kind, ir.DoubleType) else "q" for kind in packer.argument_types)
    if "".join(expected) != layout:
        raise layout_error(f"of {symbol} as {layout}", "".join(expected))
    flat = [
        builder.load(builder.bitcast(builder.gep(words, [_WORD(i)]), kind.as_pointer()))
        for i, kind in enumerate(packer.argument_types)
    ]
    status, value = context.call_conv.call_function(
        builder,
        context.declare_function(module, descriptor),
        descriptor.restype,
        descriptor.argtypes,
        packer.from_arguments(builder, flat),
    )
    if descriptor.restype != types.none:
        builder.store(value, builder.bitcast(result, value.type.as_pointer()))
    builder.ret(status.code)
    return module
