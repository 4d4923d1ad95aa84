"""Reads files that a user names: regular ones only, and up to a size."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from skybake.errors import InputError

LARGEST_PRESET = 1 << 20
"""Size of a preset. [byte]"""

LARGEST_TABLE = 4 << 20
"""Size of a table or a curve in CSV. [byte]"""

LARGEST_TILE = 4 << 30
"""Size of the voxels of clouds. [byte]"""

LARGEST_DIRECTIONS = 64 << 20
"""Size of a list of directions in CSV, some four million of them. [byte]"""

# Opening a pipe that has no writer would otherwise block for ever.
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def digest(path: Path, where: str, largest: int) -> str:
    """SHA-256 of a file, in hexadecimal digits, which is never held as a whole.

    Parameters and errors are those of `read_bytes`.
    """
    with _opened(path, where) as descriptor:
        _check_regular(descriptor, where, largest)
        with os.fdopen(descriptor, "rb", closefd=False) as file:
            return hashlib.file_digest(file, "sha256").hexdigest()


def read_bytes(path: Path, where: str, largest: int) -> bytes:
    """Read a file.

    Parameters
    ----------
    path : Path
        A regular file, or a symbolic link to one.
    where : str
        What names it, for messages.
    largest : int
        Size at which it is refused before it is read, or while it grows. [byte]

    Raises
    ------
    InputError
        If it is a folder, a device or a pipe, too large, or cannot be read.
    """
    with _opened(path, where) as descriptor:
        return _read_regular(descriptor, where, largest)


def read_text(path: Path, where: str, largest: int) -> str:
    """Read a file of UTF-8 text, without its byte order mark.

    Parameters and errors are those of `read_bytes`; the file must be text as well.
    """
    try:
        return read_bytes(path, where, largest).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{where}: must be UTF-8 text") from error


def read_stream(stream: TextIO, where: str, largest: int) -> str:
    """Read all text of an open stream.

    Raises
    ------
    InputError
        If it has more than `largest` characters or is no text.
    """
    try:
        text = stream.read(largest + 1)
    except UnicodeDecodeError as error:
        raise InputError(f"{where}: must be UTF-8 text") from error
    if len(text) > largest:
        raise _too_large(where, largest, "more")
    return text


@contextmanager
def _opened(path: Path, where: str) -> Iterator[int]:
    try:
        descriptor = os.open(path, _FLAGS)
    except OSError as error:
        raise InputError(f"{where}: cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise InputError(f"{where}: cannot be read: {error}") from error
    try:
        yield descriptor
    except OSError as error:
        raise InputError(f"{where}: cannot be read: {error.strerror or error}") from error
    finally:
        os.close(descriptor)


def _check_regular(descriptor: int, where: str, largest: int) -> None:
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        raise InputError(f"{where}: must be a regular file, got {_kind(status.st_mode)}")
    if status.st_size > largest:
        raise _too_large(where, largest, f"{status.st_size} bytes")


def _read_regular(descriptor: int, where: str, largest: int) -> bytes:
    _check_regular(descriptor, where, largest)
    # Files of /proc report no size, and others grow.
    with os.fdopen(descriptor, "rb", closefd=False) as file:
        content = file.read(largest + 1)
    if len(content) > largest:
        raise _too_large(where, largest, "more")
    return content


def _too_large(where: str, largest: int, got: str) -> InputError:
    return InputError(f"{where}: must have at most {largest} bytes, got {got}")


def _kind(mode: int) -> str:
    kinds = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket"}
    return kinds.get(stat.S_IFMT(mode), "a device")
