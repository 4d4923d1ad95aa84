"""Tables on disk, as plain arrays under a name that says what they depend on.

A file holds arrays only: what they are, and their numbers.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from skybake.jit.cache import TABLES_FOLDER, TABLES_SUFFIX, cache_directory
from skybake.jit.sealed import read_sealed, seal, unseal, write_sealed

_HEAD_SIZE = 8

LARGEST_STORE = 1 << 30
"""Size beyond which the tables unused for longest are removed. [byte]"""


def read_tables(key: str) -> dict[str, Any] | None:
    """Return the arrays of a file, or None if it is missing or not as it was written."""
    path = stored_tables(key)
    content = None if path is None else read_sealed(path)
    if path is None or content is None:
        return None
    # The time of last use decides what goes first when the folder is full.
    with suppress(OSError):
        os.utime(path)
    return _arrays(content)


def write_tables(key: str, arrays: Mapping[str, Any]) -> None:
    """Keep arrays on disk; a full disk only costs the reuse."""
    path = _path(key)
    if path is None:
        return
    with suppress(OSError):
        write_sealed(path, _content(arrays))
        _remove_oldest(path.parent)


def stored_tables(key: str) -> Path | None:
    """File of a name's arrays, or None if there is none."""
    path = _path(key)
    return path if path is not None and path.exists() else None


def content_from_arrays(arrays: Mapping[str, Any]) -> bytes:
    """Return what a file of these arrays holds."""
    return seal(_content(arrays))


def arrays_from_content(sealed: bytes) -> dict[str, Any] | None:
    """Return the arrays of a file, or None if it is not as it was written."""
    content = unseal(sealed)
    return None if content is None else _arrays(content)


def _content(arrays: Mapping[str, Any]) -> bytes:
    """Return names, types and shapes as JSON, then the numbers; NumPy's own files load slower."""
    plain = {name: np.asarray(array) for name, array in arrays.items()}
    head = json.dumps([[name, array.dtype.str, array.shape] for name, array in plain.items()])
    parts = [len(head).to_bytes(_HEAD_SIZE, "little"), head.encode()]
    return b"".join(parts + [array.tobytes() for array in plain.values()])


def _arrays(content: memoryview) -> dict[str, Any]:
    begin = _HEAD_SIZE + int.from_bytes(content[:_HEAD_SIZE], "little")
    arrays = {}
    for name, kind, shape in json.loads(bytes(content[_HEAD_SIZE:begin])):
        array = np.frombuffer(content, kind, math.prod(shape), begin).reshape(shape).copy()
        arrays[name] = array
        begin += array.nbytes
    return arrays


def _path(key: str) -> Path | None:
    # The folder is named by the code that makes the tables.
    directory = cache_directory()
    return None if directory is None else directory / TABLES_FOLDER / f"{key}{TABLES_SUFFIX}"


def _remove_oldest(folder: Path) -> None:
    """Keep the folder below `LARGEST_STORE`."""
    files = sorted(
        folder.glob(f"*{TABLES_SUFFIX}"), key=lambda file: file.stat().st_mtime, reverse=True
    )
    total = 0
    for file in files:
        total += file.stat().st_size
        if total > LARGEST_STORE:
            file.unlink(missing_ok=True)
