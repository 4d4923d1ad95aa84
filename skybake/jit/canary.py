"""A kernel that returns the words it was given, to check that arguments arrive as they are sent.

It reads its arguments by numba's own names and follows no address, so that it returns
wrong numbers, rather than crashes, where a version of numba passes them in another way.
"""

from __future__ import annotations

import struct
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.extending import intrinsic

from skybake.jit.arguments import ARRAY_FIELDS, flatten_all, word_letters
from skybake.jit.compile import compile_kernel, layout_error, linkable, parts_of
from skybake.jit.digest import add_digest, remove_digest
from skybake.jit.machine_code import Entry
from skybake.jit.private_folder import PrivateFolder

_FILE = "arguments.checked"
_WORD = ir.IntType(64)


class _Inner(NamedTuple):
    second: float
    first: np.ndarray


class _Outer(NamedTuple):
    table: np.ndarray
    inner: _Inner
    is_set: bool
    whole: int
    strided: np.ndarray


_SAMPLE = _Outer(
    np.zeros((3, 5)),
    _Inner(0.1, np.zeros(7, np.int64)),
    True,
    -(2**40),
    np.zeros((8, 9, 2), np.float32)[::2, ::-3],
)


def check_arguments(folder: PrivateFolder | None) -> None:
    """Make sure, once for each folder of kernels, that they receive what they are given.

    Parameters
    ----------
    folder : PrivateFolder, optional
        Folder of kernels that this version of numba and llvmlite compiles; it records
        that the check has passed.

    Raises
    ------
    SkybakeError
        If a kernel would receive anything else.
    """
    stored = None if folder is None else folder.read(_FILE)
    if stored is not None and remove_digest(stored, _FILE) is not None:
        return
    arguments = (_SAMPLE, 0)
    kinds, _ = flatten_all(arguments)
    layout = word_letters(kinds)
    symbol = "word_at-check"
    entry = Entry(compile_kernel(linkable(_word_at), symbol, arguments, layout), layout)
    for index in range(len(layout)):
        _, words = flatten_all((_SAMPLE, index))
        (expected,) = struct.unpack("=q", struct.pack(f"={layout[index]}", words[index]))
        got = entry(words)
        if got != expected:
            raise layout_error(f"of {_SAMPLE!r:.40}... with word {index} = {expected}", f"{got}")
    if folder is not None:
        try:
            folder.write(_FILE, add_digest(b"", _FILE))
        except OSError:
            # That kernels cannot be kept is reported when the first one is written.
            return


def _word_at(arguments: Any, index: Any) -> Any:
    return _select_word(arguments, index)


def _word_selection(_typing: Any, arguments: Any, index: Any) -> Any:
    """Return one word of nested arguments, the index itself being the last."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        words: list[Any] = []
        for kind, value in zip(signature.args, values, strict=True):
            _append_words(context, builder, kind, value, words)
        result = ir.Constant(_WORD, 0)
        for i, word in enumerate(words):
            is_meant = builder.icmp_signed("==", values[1], ir.Constant(_WORD, i))
            result = builder.select(is_meant, word, result)
        return result

    return types.int64(arguments, index), generate


_select_word: Any = intrinsic(_word_selection)


def _append_words(context: Any, builder: Any, kind: Any, value: Any, words: list[Any]) -> None:
    if isinstance(kind, types.BaseTuple):
        for i, each in enumerate(parts_of(kind)):
            _append_words(context, builder, each, builder.extract_value(value, i), words)
    elif isinstance(kind, types.Array):
        array = context.make_helper(builder, kind, value)
        for name in ARRAY_FIELDS:
            field = getattr(array, name)
            parts = [field]
            if isinstance(field.type, ir.ArrayType):
                parts = cgutils.unpack_tuple(builder, field)
            words += [_as_word(builder, part) for part in parts]
    else:
        words.append(_as_word(builder, value))


def _as_word(builder: Any, value: Any) -> Any:
    if isinstance(value.type, ir.PointerType):
        return builder.ptrtoint(value, _WORD)
    if isinstance(value.type, ir.DoubleType):
        return builder.bitcast(value, _WORD)
    return builder.zext(value, _WORD) if value.type.width < _WORD.width else value
