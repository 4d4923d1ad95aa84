"""Kernels that make arrays, return several values, or are called from tests: for the reference."""

from __future__ import annotations

import hashlib
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from skybake.jit.cache import KERNEL_SUFFIX, cache_directory, source_hash, warn_of_loss
from skybake.jit.compile import FAST_MATH
from skybake.jit.sealed import read_sealed, write_sealed


def shared_kernel(function: Callable[..., Any]) -> Any:
    """Compile `function` on first call, with all of numba's means, and keep it on disk."""
    dispatcher: Any = numba.njit(nogil=True, fastmath=FAST_MATH, error_model="numpy")(function)
    directory = cache_directory()
    if directory is not None:
        dispatcher._cache = _KernelCache(function, directory)
    return dispatcher


class _KernelCache(_Cache):
    """Compiled versions of one kernel on disk, a file for each signature and processor.

    In the place of numba's own cache, which tries the folder for each kernel, trusts
    what it finds there, and imports the machinery that compiles (some 180 modules, and
    scipy where it is installed) before it looks whether a kernel is compiled already.
    """

    def __init__(self, function: Callable[..., Any], directory: Path) -> None:
        self._function = function
        self._directory = directory

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
        if content is None:
            return None
        return CompileResult._rebuild(target_context, *pickle.loads(content))

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled kernel; where that fails it serves this process only."""
        try:
            write_sealed(self._path(sig, data.codegen), dumps(data._reduce()))
        except OSError as error:
            warn_of_loss(self._directory, error)

    def enable(self) -> None:
        """Do nothing: it is always on."""

    def disable(self) -> None:
        """Do nothing: it is always on."""

    def flush(self) -> None:
        """Do nothing: the folder's name changes with the sources."""

    def _path(self, signature: Any, codegen: Any) -> Path:
        function = self._function
        parts = function.__module__, source_hash("reference"), signature, codegen.magic_tuple()
        version = repr(parts).encode() + function.__code__.co_code
        digest = hashlib.sha256(version).hexdigest()[:16]
        name = re.sub(r"\W+", "_", function.__name__)
        return self._directory / f"{name}-{digest}{KERNEL_SUFFIX}"
