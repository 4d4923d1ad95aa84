"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from skybake.errors import OutputError

_FULL = 1 << 20


@contextmanager
def replace_when_whole(path: Path) -> Iterator[Path]:
    """Yield a hidden file beside the target, which takes the target's name at the end.

    Parameters
    ----------
    path : Path
        The target. A symbolic link is kept, the file that it points to is replaced.

    Yields
    ------
    Path
        Name to write to, with the target's suffix. It is on stable storage before it
        is renamed, and removed if the block raises anything, also KeyboardInterrupt.

    Raises
    ------
    OutputError
        If the target cannot be written, or writing failed with an OSError.
    """
    target = Path(os.path.realpath(path))
    # The name does not contain the target's, which may already be as long as names can be.
    temporary = target.with_name(f".skybake-{os.getpid()}-{secrets.token_hex(4)}{target.suffix}")
    check_target(path)
    with _faults_of(path):
        try:
            yield temporary
            if target.exists():
                shutil.copymode(target, temporary)
            with temporary.open("rb") as file:
                os.fsync(file.fileno())
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)


def write_error(path: Path, temporary: Path, message: str) -> OutputError:
    """Error for a write that failed; `message` is what the library says."""
    reason = message.replace(str(temporary), str(path)).strip().replace("\n", "; ")
    if shutil.disk_usage(temporary.parent).free < _FULL:
        reason = f"a full disk ({reason})"
    return OutputError(f"{path}: must be written whole, got {reason or 'an unknown error'}")


def check_target(path: Path) -> None:
    """Raise what can be said of a target before anything is computed or written.

    Raises
    ------
    OutputError
        If a file cannot be written under that name.
    """
    with _faults_of(path):
        _check(path, Path(os.path.realpath(path)))


@contextmanager
def _faults_of(path: Path) -> Iterator[None]:
    """Turn an OSError into an OutputError about a path."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"{path}: must be writable, got {error.strerror or error}") from error


def _check(path: Path, target: Path) -> None:
    if not target.parent.is_dir():
        raise OutputError(f"{path}: folder must exist, got {target.parent}")
    if target.is_dir():
        raise OutputError(f"{path}: must be a file, got a folder")
    if target.is_symlink():
        raise OutputError(f"{path}: must be a file, got links in a circle")
    if target.exists() and not target.is_file():
        raise OutputError(f"{path}: must be a regular file, got a device or pipe")
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise OutputError(f"{path}: folder must be writable, got {target.parent}")
    if target.exists() and not os.access(target, os.W_OK):
        raise OutputError(f"{path}: must be writable, got a write-protected file")
