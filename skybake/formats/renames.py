"""Several files that take their names together.

No file system renames several files at once. While they take their names one by one, a
journal in the first one's hidden folder lists them, and each hidden folder holds the file
that had the name before. If the journal outlives the renames, because one failed or the
process was killed, they are undone. Without the journal there is nothing to undo: either
no file has its name yet, or all have.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from skybake.formats.hidden_folders import is_ours, prefix

JOURNAL = "renames.json"
_FIRST = "first"


@dataclass(frozen=True)
class Rename:
    """A complete file and the name that it is to take.

    Attributes
    ----------
    target : Path
        The name.
    folder : Path
        Its hidden folder, beside the target.
    """

    target: Path
    folder: Path

    @property
    def new(self) -> Path:
        """The complete file."""
        return self.folder / f"whole{self.target.suffix}"

    @property
    def before(self) -> Path:
        """The file that had the name before."""
        return self.folder / f"before{self.target.suffix}"


def rename_all(renames: Sequence[Rename]) -> None:
    """Give files their names: all of them, or if an OSError is raised none.

    Parameters
    ----------
    renames : sequence of Rename
        At least one. Their files are complete and on stable storage.

    Notes
    -----
    To be called where `skybake.formats.held_signals` holds back signals.
    """
    if len(renames) == 1:
        renames[0].new.replace(renames[0].target)
        return
    for rename in renames:
        _keep_before(rename)
    _write_journal(renames)
    try:
        # Files that were added last hold digests of the others, and appear first.
        for rename in reversed(renames):
            rename.new.replace(rename.target)
        (renames[0].folder / JOURNAL).unlink()
    except BaseException:
        _undo(renames[0].folder)
        raise


def is_unfinished(renames: Sequence[Rename]) -> bool:
    """Whether some files have their names and others not, and this could not be undone."""
    return bool(renames) and (renames[0].folder / JOURNAL).exists()


def undo_unfinished(folder: Path) -> None:
    """Undo the renames of the set that a dead process's hidden folder belongs to.

    Raises
    ------
    OSError
        If one could not be undone; the journal then stays.
    """
    if not is_ours(folder):
        return
    with suppress(FileNotFoundError):
        name = (folder / _FIRST).read_text("utf-8", "surrogateescape")
        first = Path(os.path.normpath(folder.parent / name))
        if is_ours(first):
            _undo(first)


def _keep_before(rename: Rename) -> None:
    """Give the file that has a target's name a second one."""
    if not rename.target.exists():
        return
    try:
        rename.before.hardlink_to(rename.target)
    except OSError:  # by a file system without links
        shutil.copy2(rename.target, rename.before)


def _write_journal(renames: Sequence[Rename]) -> None:
    # Relative, since another container may see the folders elsewhere.
    first = renames[0].folder
    for rename in renames:
        _write(rename.folder / _FIRST, os.path.relpath(first, rename.folder.parent))
    entries = [
        {
            "target": os.path.relpath(rename.target, first.parent),
            "folder": rename.folder.name,
            "inode": rename.new.stat().st_ino,
        }
        for rename in renames
    ]
    written = first / f"{JOURNAL}.new"
    _write(written, json.dumps(entries))
    written.replace(first / JOURNAL)


def _write(path: Path, text: str) -> None:
    with path.open("w", encoding="utf-8", errors="surrogateescape") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


def _undo(first: Path) -> None:
    """Undo the renames of a journal, which may have been begun before."""
    journal = first / JOURNAL
    for entry in json.loads(journal.read_text("utf-8", "surrogateescape")):
        rename = _rename_of(entry, first.parent)
        # A file of another process under the name stays.
        if is_ours(rename.folder) and _inode(rename.target) == entry["inode"]:
            if rename.before.exists():
                rename.before.replace(rename.target)
            else:
                rename.target.unlink()
    journal.unlink()


def _rename_of(entry: dict[str, Any], parent: Path) -> Rename:
    """Return an entry of a journal, which may only give a file a name in the same folder."""
    target = Path(os.path.normpath(parent / str(entry["target"])))
    folder = target.with_name(Path(str(entry["folder"])).name)
    if not folder.name.startswith(prefix(target)):
        raise OSError(f"{folder}: must be a hidden folder of {target}")
    return Rename(target, folder)


def _inode(path: Path) -> int | None:
    try:
        return path.lstat().st_ino
    except FileNotFoundError:
        return None
