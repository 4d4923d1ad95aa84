"""Files that appear complete or not at all, one or several together.

They are written in hidden folders beside their targets, synced to stable storage, and take
their names when all of them are complete, see `skybake.formats.renames`.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Self

from skybake.formats.held_signals import signals_held
from skybake.formats.hidden_folders import leftovers, lock_hidden_folder, name_hidden_folder
from skybake.formats.renames import Rename, is_unfinished, rename_all, undo_unfinished
from skybake.formats.targets import check_target, faults_of, real_target


class WholeFiles:
    """Files that take their names together when the block ends, or not at all if it raises.

    Notes
    -----
    Signals that end the process are held back while files take their names. If a rename
    fails, those before it are undone and the former files have their names again. If the
    process is killed meanwhile, the next one that writes any of the files does that.
    """

    def __init__(self) -> None:
        self._paths: list[Path] = []
        self._renames: list[Rename] = []
        self._locks: list[int] = []

    def __enter__(self) -> Self:
        """Return itself, without files."""
        return self

    def add(self, path: Path) -> Path:
        """Return the file to write for a target.

        Parameters
        ----------
        path : Path
            The target. A symbolic link is kept, the file that it points to is replaced.

        Returns
        -------
        Path
            Name to write to, with the target's suffix, in a hidden folder beside it.

        Raises
        ------
        OutputError
            If the target cannot be written.
        """
        check_target(path)
        target = real_target(path)
        remove_leftovers(path)
        rename = Rename(target, name_hidden_folder(target))
        # Known before it is made: a signal may raise between any two lines.
        self._paths.append(path)
        self._renames.append(rename)
        with faults_of(path):
            lock = lock_hidden_folder(rename.folder)
        if lock is not None:
            self._locks.append(lock)
        return rename.new

    def written(self, path: Path) -> Path:
        """Return the file that `add` returned for a target."""
        return self._renames[self._paths.index(path)].new

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Give all files their names, or remove them."""
        try:
            if kind is None and self._renames:
                self._finish()
        finally:
            self._clear()

    def _finish(self) -> None:
        for path, rename in zip(self._paths, self._renames, strict=True):
            with faults_of(path):
                if rename.target.exists():
                    shutil.copymode(rename.target, rename.new)
                with rename.new.open("rb") as file:
                    os.fsync(file.fileno())
        with signals_held():
            try:
                with faults_of(self._paths[0]):
                    rename_all(self._renames)
            finally:
                self._clear()

    def _clear(self) -> None:
        # What could not be undone needs its folders until a later process can.
        if not is_unfinished(self._renames):
            for rename in self._renames:
                shutil.rmtree(rename.folder, ignore_errors=True)
        self._renames.clear()
        while self._locks:
            os.close(self._locks.pop())


@contextmanager
def replace_when_whole(path: Path) -> Iterator[Path]:
    """Yield a file in a hidden folder beside the target, which takes its name at the end.

    Parameters
    ----------
    path : Path
        As of `WholeFiles.add`.

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
    with faults_of(path), WholeFiles() as files:
        yield files.add(path)


def remove_leftovers(path: Path) -> None:
    """Remove what dead processes left beside a target, which may be complete nevertheless.

    Sets of which only some files had taken their names are undone.
    """
    for folder in leftovers(real_target(path)):
        # A journal that the disk has damaged is not used.
        with suppress(OSError, ValueError, LookupError, TypeError):
            undo_unfinished(folder)
            shutil.rmtree(folder, ignore_errors=True)
