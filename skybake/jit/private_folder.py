"""Folders in which only their owner and root can create or change a file.

Compiled kernels are programs: whoever can write one can run code as the user who reads it.
So a folder is opened once, level by level from the root and through no symbolic link, each
level is judged by its open descriptor, and files are named relative to the last one. What
others replace afterwards is not read.
"""

from __future__ import annotations

import os
import secrets
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

_RELATIVE = os.open in os.supports_dir_fd
_LINKED = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
_LEVEL = _LINKED | getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_PATH", os.O_RDONLY)
_FOLDER = _LINKED | getattr(os, "O_DIRECTORY", 0) | os.O_RDONLY
# Opening a pipe in place of a file must not block.
_FILE = _LINKED | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)

_OTHERS_MAY_WRITE = stat.S_IWGRP | stat.S_IWOTH
_LEFTOVER = ".partial"


class NotPrivateError(Exception):
    """Another user may write to a folder, or to one above it; says which and why."""


class PrivateFolder:
    """An open folder that only its owner, this user or root, can write to.

    Attributes
    ----------
    path : Path
        Its name, for messages.
    """

    def __init__(self, path: Path, descriptor: int) -> None:
        self.path = path
        self._place: int | Path = descriptor if _RELATIVE else path
        # Where names cannot be relative to a folder, they are full paths.
        self._above = descriptor if _RELATIVE else None
        self._identity = _state(self._place)
        self._remove_leftovers()

    def is_open(self) -> bool:
        """Whether files can still be kept in it: it is neither removed nor closed."""
        try:
            state = _state(self._place)
        except OSError:
            return False
        return os.path.samestat(state, self._identity) and state.st_nlink > 0

    def names(self) -> list[str]:
        """Names of all files in it."""
        with os.scandir(self._place) as entries:
            return [entry.name for entry in entries]

    def has(self, name: str) -> bool:
        """Whether a file exists, whatever it holds."""
        try:
            self._state(name)
        except OSError:
            return False
        return True

    def read(self, name: str, *, mark_used: bool = False) -> bytes | None:
        """Return the content of a file.

        Parameters
        ----------
        name : str
            Of the file, without a folder.
        mark_used : bool, optional
            Whether to set its time of change to now.

        Returns
        -------
        bytes or None
            None if it is missing or cannot be read, is no regular file, belongs to another
            user than this one or root, or may be written by other users.
        """
        try:
            descriptor = os.open(self._name(name), os.O_RDONLY | _FILE, dir_fd=self._above)
        except OSError:
            return None
        try:
            state = os.fstat(descriptor)
            if not stat.S_ISREG(state.st_mode) or _fault(state) is not None:
                return None
            if mark_used:
                with suppress(OSError):
                    os.utime(descriptor if _RELATIVE else self.path / name)
            with os.fdopen(descriptor, "rb", closefd=False) as file:
                return file.read()
        except OSError:
            return None
        finally:
            os.close(descriptor)

    def write(self, name: str, *parts: bytes | memoryview) -> None:
        """Write a file that only this user can read, completely or not at all.

        Parameters
        ----------
        name : str
            Of the file.
        *parts : bytes or memoryview
            What it holds, one after the other.

        Raises
        ------
        OSError
            If there is no room for it; nothing is left then.
        """
        with self._temporary() as (temporary, descriptor):
            # Only where a file can be renamed while it is open does it keep its lock until then.
            with os.fdopen(descriptor, "wb", closefd=not _RELATIVE) as file:
                file.writelines(parts)
            source, target = self._name(temporary), self._name(name)
            os.replace(source, target, src_dir_fd=self._above, dst_dir_fd=self._above)

    def remove(self, name: str) -> None:
        """Remove a file if it is there."""
        with suppress(FileNotFoundError):
            os.unlink(self._name(name), dir_fd=self._above)

    def used_at(self, name: str) -> tuple[float, int]:
        """When a file was written or marked as used [s since 1970], and its size [byte]."""
        state = self._state(name)
        return state.st_mtime, state.st_size

    def within(self, name: str) -> PrivateFolder:
        """Open a folder in it, which is made if it is missing.

        Raises
        ------
        NotPrivateError
            If other users may write to it.
        OSError
            If it cannot be opened.
        """
        if self._above is None:
            return open_private_folder(self.path / name)
        descriptor = _open_level(name, self._above, _FOLDER)
        return _judged(self.path / name, descriptor)

    def mark_used(self) -> None:
        """Make its own time of change now."""
        os.utime(self._place)

    def share(self) -> None:
        """Let every user read what is in it, and no other user write."""
        self.path.chmod(0o755)
        for name in self.names():
            path = self.path / name
            if path.is_file():
                path.chmod(0o644)

    def _name(self, name: str) -> str | Path:
        return self.path / name if self._above is None else name

    def _state(self, name: str) -> os.stat_result:
        return os.stat(self._name(name), dir_fd=self._above, follow_symlinks=False)

    @contextmanager
    def _temporary(self) -> Iterator[tuple[str, int]]:
        """Yield the name and the descriptor of a new file, locked as long as it is written."""
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | _FILE
        descriptor = -1
        name = ""
        try:
            while descriptor < 0:
                name = f".{secrets.token_hex(8)}{_LEFTOVER}"
                descriptor = os.open(self._name(name), flags, 0o600, dir_fd=self._above)
                if sys.platform != "win32":
                    os.fchmod(descriptor, 0o600)
                    _lock(descriptor, wait=True)
                    # Before it was locked, another process may have taken it for a leftover.
                    if os.fstat(descriptor).st_nlink == 0:
                        os.close(descriptor)
                        descriptor = -1
            yield name, descriptor
        finally:
            with suppress(OSError):
                self.remove(name)
            if _RELATIVE and descriptor >= 0:
                os.close(descriptor)

    def _remove_leftovers(self) -> None:
        """Remove what killed writers left; living ones hold a lock."""
        if sys.platform == "win32":
            return
        for name in self.names():
            if name.startswith(".") and name.endswith(_LEFTOVER):
                with suppress(OSError):
                    descriptor = os.open(self._name(name), os.O_RDONLY | _FILE, dir_fd=self._above)
                    try:
                        _lock(descriptor, wait=False)
                        self.remove(name)
                    finally:
                        os.close(descriptor)


def open_private_folder(path: Path) -> PrivateFolder:
    """Open a folder; missing levels of its path are made, for this user alone.

    Parameters
    ----------
    path : Path
        The folder. Symbolic links in it are followed to where they point, and all
        levels of that place are judged.

    Returns
    -------
    PrivateFolder
        The folder, which stays open.

    Raises
    ------
    NotPrivateError
        If it, or a folder above it, belongs to another user than this one or root, or
        may be written by its group or by other users. A parent that belongs to root may be,
        if only the owner of a file can remove it there, as in /tmp.
    OSError
        If it cannot be made or opened.
    """
    if not _RELATIVE:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
        return PrivateFolder(path, -1)
    place = Path(os.path.realpath(path))
    descriptor = os.open(place.anchor, _LEVEL)
    reached = Path(place.anchor)
    for part in place.parts[1:]:
        try:
            _check(reached, os.fstat(descriptor), is_above=True)
            below = _open_level(part, descriptor, _FOLDER if reached / part == place else _LEVEL)
        finally:
            os.close(descriptor)
        descriptor, reached = below, reached / part
    return _judged(place, descriptor)


def _judged(path: Path, descriptor: int) -> PrivateFolder:
    try:
        _check(path, os.fstat(descriptor), is_above=False)
        return PrivateFolder(path, descriptor)
    except BaseException:
        os.close(descriptor)
        raise


def _open_level(name: str, above: int, flags: int) -> int:
    """Open a folder below another, which is made if it is missing."""
    with suppress(FileNotFoundError):
        return os.open(name, flags, dir_fd=above)
    with suppress(FileExistsError):
        os.mkdir(name, 0o700, dir_fd=above)
        # Regardless of the umask.
        os.chmod(name, 0o700, dir_fd=above)
    return os.open(name, flags, dir_fd=above)


def _state(place: int | Path) -> os.stat_result:
    return os.fstat(place) if isinstance(place, int) else place.stat()


def _check(path: Path, state: os.stat_result, *, is_above: bool) -> None:
    fault = _fault(state)
    is_shared = state.st_uid == 0 and state.st_mode & stat.S_ISVTX
    if fault is not None and not (is_above and is_shared):
        raise NotPrivateError(f"{path} {fault}")


def _fault(state: os.stat_result) -> str | None:
    """Why a file or folder is not private, or None."""
    if sys.platform == "win32":
        return None
    if state.st_uid not in {0, os.getuid()}:
        return f"belongs to user {state.st_uid}"
    if state.st_mode & _OTHERS_MAY_WRITE:
        return f"has mode {stat.S_IMODE(state.st_mode):04o}"
    return None


def _lock(descriptor: int, *, wait: bool) -> None:
    """Lock a file until its descriptor is closed or this process ends.

    Raises
    ------
    BlockingIOError
        If it is not to wait and another process holds it.
    """
    if sys.platform != "win32":
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
