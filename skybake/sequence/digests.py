"""What is known of the files of a frame: their digests, and what they should hold.

They are stored in a hidden folder beside the maps, a file for each frame in the format of
``sha256sum``. A file without a digest counts as missing.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from skybake.errors import InputError
from skybake.formats.targets import faults_of
from skybake.formats.whole_files import WholeFiles
from skybake.input_files import read_text

FOLDER = ".skybake-digests"

_LARGEST = 1 << 16
_CLAIM = "# claim "
_SUFFIX = ".sha256"
_LONGEST_NAME = 255


def claim_of(recipe_hash: str, attributes: Mapping[str, Any]) -> str:
    """Digest of everything that a frame's files shall state.

    Parameters
    ----------
    recipe_hash : str
        As of `skybake.image.recipe.recipe_hash`.
    attributes : mapping
        Of time and place, fit for JSON.
    """
    text = json.dumps([recipe_hash, dict(attributes)], sort_keys=True)
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def file_sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def write_digests(files: WholeFiles, output: Path, claim: str, digests: Mapping[Path, str]) -> None:
    """Write what is known of a frame's files, to appear together with them.

    Parameters
    ----------
    files : WholeFiles
        Those of the frame.
    output : Path
        The frame's, as `skybake.baking.bake` takes it.
    claim : str
        As of `claim_of`.
    digests : mapping of Path to str
        SHA-256 of each file.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    path = _path(output)
    lines = [f"{_CLAIM}{claim}"]
    lines += [f"{sha256}  {_name(path, file)}" for file, sha256 in digests.items()]
    with faults_of(path):
        path.parent.mkdir(exist_ok=True)
        files.add(path).write_text("\n".join(lines) + "\n", "utf-8", "surrogateescape")


def verified_digests(output: Path, claim: str, files: Iterable[Path]) -> dict[Path, str] | None:
    """Return the digests of a frame's files if they are what was written, else None.

    Parameters
    ----------
    output, claim : Path, str
        As of `write_digests`.
    files : iterable of Path
        Files that are wanted.
    """
    path = _path(output)
    try:
        first, *lines = read_text(path, str(path), _LARGEST).splitlines()
    except (InputError, ValueError):
        return None
    if first != f"{_CLAIM}{claim}":
        return None
    found: dict[Path, str] = {}
    for file in files:
        try:
            found[file] = file_sha256(file)
        except OSError:
            return None
        if f"{found[file]}  {_name(path, file)}" not in lines:
            return None
    return found


def _path(output: Path) -> Path:
    name = f"{output.name}{_SUFFIX}"
    if len(os.fsencode(name)) > _LONGEST_NAME:
        name = f"{hashlib.sha256(os.fsencode(output.name)).hexdigest()}{_SUFFIX}"
    return output.parent / FOLDER / name


def _name(path: Path, file: Path) -> str:
    return Path(os.path.relpath(file, path.parent)).as_posix()
