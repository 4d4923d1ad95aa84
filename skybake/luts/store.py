"""Tables on disk, as plain arrays under a name that says what they depend on.

A file is a SHA-256 digest of the rest, then arrays in numpy's own format: their
names, and each of them.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from skybake.transport.kernel import cache_directory

LARGEST_STORE = 1 << 30
"""Size beyond which the tables unused for longest are removed. [byte]"""

_DIGEST_SIZE = hashlib.sha256().digest_size


def read_tables(key: str) -> dict[str, Any] | None:
    """Return the arrays of a file, or None if it is missing or not as it was written."""
    path = stored_tables(key)
    if path is None:
        return None
    try:
        content = path.read_bytes()
    except OSError:
        return None
    # The time of last use decides what goes first when the folder is full.
    with suppress(OSError):
        os.utime(path)
    return arrays_from_content(content)


def write_tables(key: str, arrays: Mapping[str, Any]) -> None:
    """Write arrays beside their name and rename them; a full disk only costs the reuse."""
    path = _path(key)
    if path is None:
        return
    content = content_from_arrays(arrays)
    temporary = path.with_name(f".{path.stem}-{os.getpid()}{path.suffix}")
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            temporary.write_bytes(content)
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
        _remove_oldest(path.parent)


def stored_tables(key: str) -> Path | None:
    """File of a name's arrays, or None if there is none."""
    path = _path(key)
    return path if path is not None and path.exists() else None


def content_from_arrays(arrays: Mapping[str, Any]) -> bytes:
    """Return what a file of these arrays holds."""
    stream = BytesIO()
    for array in (np.array(list(arrays)), *arrays.values()):
        np.save(stream, array, allow_pickle=False)
    return hashlib.sha256(stream.getbuffer()).digest() + stream.getvalue()


def arrays_from_content(content: bytes) -> dict[str, Any] | None:
    """Return the arrays of a file, or None if it is not as it was written.

    The digest is checked before anything else is read: damaged arrays can fail in
    any way, or only look right.
    """
    if hashlib.sha256(memoryview(content)[_DIGEST_SIZE:]).digest() != content[:_DIGEST_SIZE]:
        return None
    stream = BytesIO(content)
    stream.seek(_DIGEST_SIZE)
    names = np.load(stream, allow_pickle=False)
    return {str(name): np.load(stream, allow_pickle=False) for name in names}


def _path(key: str) -> Path | None:
    # The folder is named by the code that makes the tables.
    directory = cache_directory()
    return None if directory is None else directory / "atmospheres" / f"{key}.tables"


def _remove_oldest(folder: Path) -> None:
    """Keep the folder below `LARGEST_STORE`."""
    files = sorted(folder.glob("*.tables"), key=lambda file: file.stat().st_mtime, reverse=True)
    total = 0
    for file in files:
        total += file.stat().st_size
        if total > LARGEST_STORE:
            file.unlink(missing_ok=True)
