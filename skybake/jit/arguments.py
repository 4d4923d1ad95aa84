"""Arguments of compiled kernels as a flat row of 64-bit words, the way numba passes them."""

from __future__ import annotations

from typing import Any

import numpy as np

_C_ORDER, _FORTRAN_ORDER, _ALIGNED, _WRITEABLE = 1, 2, 0x100, 0x400
_FLAGS = _ALIGNED | _WRITEABLE

ARRAY_FIELDS = ("meminfo", "parent", "nitems", "itemsize", "data", "shape", "strides")
"""Parts of an array in the order of its words, by the names that numba gives them.

The first two own the array's memory and are 0, since kernels keep no array.
"""

Kind = int | str


class Flat:
    """An argument that was flattened once for many calls; see `flatten`.

    Attributes
    ----------
    value : object
        The argument itself, which must outlive the calls.
    kinds : list of int or str
        What determines its type.
    words : list of int or float
        What is passed.
    """

    def __init__(self, value: Any) -> None:
        self.value = value
        self.kinds: list[Kind] = []
        self.words: list[int | float] = []
        _append(value, self.kinds, self.words)


def flatten(value: Any) -> Flat:
    """Flatten an argument once for many calls of kernels; it costs two microseconds an array.

    Parameters
    ----------
    value : ndarray, bool, int, float, or tuple or NamedTuple of these
        The argument. Arrays in it may be written to, but not be resized.

    Returns
    -------
    Flat
        Replaces the argument in calls of kernels.

    Raises
    ------
    TypeError
        If it is, or holds, something else.
    """
    return Flat(value)


def flatten_all(arguments: tuple[Any, ...]) -> tuple[tuple[Kind, ...], list[int | float]]:
    """Return what determines the types of a call's arguments, and the words that are passed."""
    kinds: list[Kind] = []
    words: list[int | float] = []
    for argument in arguments:
        _append(argument, kinds, words)
    return tuple(kinds), words


def word_letters(kinds: tuple[Kind, ...]) -> str:
    """Return the letters by which `struct` packs the words of arguments."""
    return "".join(_letters(kind) for kind in kinds)


def _letters(kind: Kind) -> str:
    if isinstance(kind, int):
        return "q" * (5 + 2 * (kind & 0xFF))
    return {"float": "d", "int": "q", "bool": "q"}.get(kind, "")


def _append(value: Any, kinds: list[Kind], words: list[int | float]) -> None:
    if isinstance(value, np.ndarray):
        _append_array(value, kinds, words)
    elif isinstance(value, Flat):
        kinds += value.kinds
        words += value.words
    elif isinstance(value, tuple):
        kinds.append(f"{type(value).__qualname__} of {len(value)}")
        for each in value:
            _append(each, kinds, words)
    elif isinstance(value, bool | np.bool_):
        kinds.append("bool")
        words.append(int(value))
    elif isinstance(value, int | np.int64):
        kinds.append("int")
        words.append(int(value))
    elif isinstance(value, float):
        kinds.append("float")
        words.append(value)
    else:
        raise TypeError(f"kernel: argument must be an array, a number or a tuple, got {value!r}")


def _append_array(array: np.ndarray, kinds: list[Kind], words: list[int | float]) -> None:
    """Append the `ARRAY_FIELDS` of an array."""
    if not array.dtype.isnative:
        raise TypeError(f"kernel: array must be in the machine's byte order, got {array.dtype}")
    flags = array.flags.num
    # An array may be in both orders; numba then takes it for one in C's.
    order = flags & _C_ORDER or flags & _FORTRAN_ORDER
    kinds.append((flags & _FLAGS | order) << 16 | array.dtype.num << 8 | array.ndim)
    words += (0, 0, array.size, array.itemsize, array.ctypes.data, *array.shape, *array.strides)
