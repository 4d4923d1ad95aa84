"""Tables on disk, as plain arrays under a name derived from what they depend on.

A file holds arrays only: what they are, and their numbers.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from skybake.jit.cache import CLOUD_LIGHT_PREFIX, TABLES_FOLDER, TABLES_SUFFIX, cache_folder
from skybake.jit.digest import parts_with_digest, remove_digest
from skybake.jit.private_folder import NotPrivateError, PrivateFolder

_HEAD_SIZE = 8

LARGEST_STORE = 1 << 30
"""Size beyond which the tables unused for longest are removed. [byte]"""

LARGEST_LIGHTS = 1 << 29
"""The same of the light of clouds, which does not push out others: it is large and soon unused."""


def read_tables(key: str) -> dict[str, Any] | None:
    """Return the arrays of a file, or None if it is missing or damaged."""
    folder = _folder()
    # The time of last use decides what is removed first when the folder is full.
    stored = None if folder is None else folder.read(_file(key), mark_used=True)
    return None if stored is None else arrays_from_content(key, stored)


def write_tables(key: str, arrays: Mapping[str, Any]) -> None:
    """Keep arrays on disk; if the disk is full they are computed again next time."""
    folder = _folder()
    if folder is None:
        return
    with suppress(OSError):
        folder.write(_file(key), *_parts(key, arrays))
        names = [name for name in folder.names() if name.endswith(TABLES_SUFFIX)]
        lights = [name for name in names if name.startswith(CLOUD_LIGHT_PREFIX)]
        _remove_oldest(folder, lights, LARGEST_LIGHTS)
        _remove_oldest(folder, list(set(names) - set(lights)), LARGEST_STORE)


def has_tables(key: str) -> bool:
    """Whether there is a file of a name's arrays."""
    folder = _folder()
    return folder is not None and folder.has(_file(key))


def content_from_arrays(key: str, arrays: Mapping[str, Any]) -> bytes:
    """Return what a file of these arrays holds."""
    return b"".join(_parts(key, arrays))


def arrays_from_content(key: str, stored: bytes) -> dict[str, Any] | None:
    """Return the arrays of a name's file, or None if it is damaged."""
    content = remove_digest(stored, _purpose(key))
    if content is None:
        return None
    try:
        return _arrays(content)
    except (TypeError, ValueError):
        return None


def _purpose(key: str) -> str:
    return f"tables {key}"


def _parts(key: str, arrays: Mapping[str, Any]) -> list[bytes | memoryview]:
    """Return names, types and shapes as JSON, then the numbers; NumPy's own files load slower.

    Numbers are not copied: the light of clouds takes a fifth of a map's memory.
    """
    plain = {name: np.asarray(array) for name, array in arrays.items()}
    head = json.dumps([[name, array.dtype.str, array.shape] for name, array in plain.items()])
    numbers = [np.ascontiguousarray(array).reshape(-1).view(np.uint8) for array in plain.values()]
    parts = [len(head).to_bytes(_HEAD_SIZE, "little"), head.encode()]
    return parts_with_digest([*parts, *(each.data for each in numbers)], _purpose(key))


def _arrays(content: memoryview) -> dict[str, Any]:
    begin = _HEAD_SIZE + int.from_bytes(content[:_HEAD_SIZE], "little")
    arrays = {}
    for name, kind, shape in json.loads(bytes(content[_HEAD_SIZE:begin])):
        array = np.frombuffer(content, kind, math.prod(shape), begin).reshape(shape).copy()
        arrays[name] = array
        begin += array.nbytes
    return arrays


def _folder() -> PrivateFolder | None:
    # The folder above is named by the code that makes the tables.
    above = cache_folder()
    if above is None:
        return None
    folder = _open.get(above)
    if folder is None or not folder.is_open():
        try:
            folder = above.within(TABLES_FOLDER)
        except (OSError, NotPrivateError):
            return None
        _open.clear()
        _open[above] = folder
    return folder


_open: dict[PrivateFolder, PrivateFolder] = {}


def _file(key: str) -> str:
    return f"{key}{TABLES_SUFFIX}"


def _remove_oldest(folder: PrivateFolder, names: list[str], most: int) -> None:
    """Keep these files below a size. [byte]"""
    last_used = sorted(((*folder.used_at(name), name) for name in names), reverse=True)
    total = 0
    for _, size, name in last_used:
        total += size
        if total > most:
            folder.remove(name)
