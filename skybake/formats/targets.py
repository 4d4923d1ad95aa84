"""Names that files are to appear under, and checks of them."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from skybake.errors import OutputError

_FULL = 1 << 20


def check_target(path: Path) -> None:
    """Raise the errors of a target that can be found before anything is computed.

    Raises
    ------
    OutputError
        If a file cannot be written under that name.
    """
    with faults_of(path):
        target = real_target(path)
        if not is_utf8(target):
            raise OutputError(f"{path}: must be UTF-8, got bytes that are not")
        _check(path, target)


def real_target(path: Path) -> Path:
    """Return the file that a path means, at the end of its symbolic links."""
    return Path(os.path.realpath(path))


def is_utf8(path: Path) -> bool:
    """Whether libraries that take UTF-8 only can open a path."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        return False
    return True


@contextmanager
def faults_of(path: Path) -> Iterator[None]:
    """Turn an OSError into an OutputError about a path."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"{path}: must be writable, got {error.strerror or error}") from error


def write_error(path: Path, temporary: Path, message: str) -> OutputError:
    """Error for a write that failed; `message` is that of the library."""
    reason = message.replace(str(temporary), str(path)).strip().replace("\n", "; ")
    if shutil.disk_usage(temporary.parent).free < _FULL:
        reason = f"a full disk ({reason})"
    return OutputError(f"{path}: cannot be written completely: {reason or 'an unknown error'}")


def _check(path: Path, target: Path) -> None:
    if not target.parent.is_dir():
        raise OutputError(f"{path}: folder must exist, got {target.parent}")
    if target.is_dir():
        raise OutputError(f"{path}: must be a file, got a folder")
    if target.is_symlink():
        raise OutputError(f"{path}: must be a file, got a circular link")
    if target.exists() and not target.is_file():
        raise OutputError(f"{path}: must be a regular file, got a device or pipe")
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise OutputError(f"{path}: folder must be writable, got {target.parent}")
    if target.exists() and not os.access(target, os.W_OK):
        raise OutputError(f"{path}: must be writable, got a write-protected file")
