"""Hidden folders beside targets, in which files are written before they take their names.

A folder is locked as long as its process lives. This identifies what a killed process left,
even from another container, where a process number would not.
"""

from __future__ import annotations

import hashlib
import os
import secrets
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

_OTHERS_MAY_WRITE = stat.S_IWGRP | stat.S_IWOTH


def name_hidden_folder(target: Path) -> Path:
    """Return a folder beside a target that is not there yet."""
    return target.with_name(f"{prefix(target)}{secrets.token_hex(8)}")


def lock_hidden_folder(folder: Path) -> int | None:
    """Make a folder, private to its owner, and lock it until its process ends.

    Returns
    -------
    int or None
        The descriptor that holds the lock, to be closed when the folder is removed; None
        where there are no locks, so that nothing is ever a leftover.
    """
    while True:
        folder.mkdir(0o700, exist_ok=True)
        # Before it is locked, another process may take it for a leftover.
        try:
            lock = _lock(folder)
        except (BlockingIOError, FileNotFoundError):
            continue
        if lock is None:
            return None
        if _is_still(folder, lock):
            return lock
        os.close(lock)


def leftovers(target: Path) -> Iterator[Path]:
    """Yield the folders that dead processes left beside a target, each locked meanwhile."""
    for folder in target.parent.glob(f"{prefix(target)}*"):
        with suppress(OSError), _locked(folder) as is_leftover:
            if is_leftover:
                yield folder


def prefix(target: Path) -> str:
    """How the names of a target's hidden folders begin."""
    # A digest, because the target's name may already be as long as names can be.
    return f".skybake-{hashlib.sha256(os.fsencode(target.name)).hexdigest()[:12]}-"


def is_ours(folder: Path) -> bool:
    """Whether a folder, not a link, is this user's and no other user could write to it."""
    try:
        status = folder.lstat()
    except OSError:
        return False
    if not stat.S_ISDIR(status.st_mode):
        return False
    if not hasattr(os, "geteuid"):
        return True
    return status.st_uid == os.geteuid() and not status.st_mode & _OTHERS_MAY_WRITE


@contextmanager
def _locked(folder: Path) -> Iterator[bool]:
    lock = _lock(folder)
    try:
        # One that was removed meanwhile may be back, and another process' own.
        yield lock is not None and _is_still(folder, lock)
    finally:
        if lock is not None:
            os.close(lock)


def _is_still(folder: Path, lock: int) -> bool:
    """Whether a folder of this name is still the one that was locked."""
    try:
        return os.path.samestat(os.fstat(lock), folder.stat())
    except FileNotFoundError:
        return False


def _lock(folder: Path) -> int | None:
    """Lock a folder until its descriptor is closed or this process ends.

    Returns
    -------
    int or None
        The descriptor; None where there are no locks.

    Raises
    ------
    BlockingIOError
        If a living process holds it.
    FileNotFoundError
        If it has been removed.
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
