"""Files that appear whole or not at all.

A file is written in a hidden folder beside its target, which is locked as long as its
process lives. That tells what a killed process left, even to another container, where
the number of a process would not: it goes when the same target is written again.
"""

from __future__ import annotations

import hashlib
import os
import secrets
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

from skybake.errors import OutputError

_FULL = 1 << 20


@contextmanager
def replace_when_whole(path: Path) -> Iterator[Path]:
    """Yield a file in a hidden folder beside the target, which takes its name at the end.

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
    check_target(path)
    with _faults_of(path), _hidden_folder(target) as folder:
        temporary = folder / f"whole{target.suffix}"
        yield temporary
        if target.exists():
            shutil.copymode(target, temporary)
        with temporary.open("rb") as file:
            os.fsync(file.fileno())
        temporary.replace(target)


def remove_leftovers(path: Path) -> None:
    """Remove what dead processes left beside a target, which may be whole nevertheless."""
    target = Path(os.path.realpath(path))
    for leftover in target.parent.glob(f"{_prefix(target)}*"):
        with suppress(OSError):
            lock = _lock(leftover)
            if lock is not None:
                shutil.rmtree(leftover, ignore_errors=True)
                os.close(lock)


def _prefix(target: Path) -> str:
    """How the names of a target's hidden folders begin."""
    # A digest, because the target's name may already be as long as names can be.
    return f".skybake-{hashlib.sha256(os.fsencode(target.name)).hexdigest()[:12]}-"


@contextmanager
def _hidden_folder(target: Path) -> Iterator[Path]:
    """Yield a locked folder beside a target and remove it, and those that dead processes left."""
    remove_leftovers(target)
    folder = target.with_name(f"{_prefix(target)}{secrets.token_hex(8)}")
    lock = None
    # Made within the block: a signal may raise between any two lines.
    try:
        lock = _make_locked(folder)
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def _make_locked(folder: Path) -> int | None:
    """Make a folder and lock it, see `_lock`."""
    while True:
        folder.mkdir(exist_ok=True)
        # Before it is locked, another process may take it for a leftover.
        try:
            lock = _lock(folder)
        except (BlockingIOError, FileNotFoundError):
            continue
        if lock is None:
            return None
        with suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(lock), folder.stat()):
                return lock
        os.close(lock)


def _lock(folder: Path) -> int | None:
    """Lock a folder until its descriptor is closed or this process ends.

    Returns
    -------
    int or None
        The descriptor; None where there are no locks, so that nothing is ever a leftover.

    Raises
    ------
    BlockingIOError
        If a living process holds it.
    FileNotFoundError
        If it is no more.
    """
    if sys.platform == "win32":
        return None
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(descriptor)
        if isinstance(error, BlockingIOError):
            raise
        return None
    return descriptor


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
        target = Path(os.path.realpath(path))
        if not is_utf8(target):
            raise OutputError(f"{path}: must be UTF-8, got bytes that are not")
        _check(path, target)


def is_utf8(path: Path) -> bool:
    """Whether libraries that take UTF-8 only can open a path."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        return False
    return True


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
