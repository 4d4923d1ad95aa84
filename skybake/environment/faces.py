"""Six files of one cubemap, found by the name of one of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

from skybake.errors import InputError
from skybake.projection.cubemap import FACE_NAMES

KNOWN_NAMES = (*FACE_NAMES.values(), ("right", "left", "up", "down", "front", "back"))
"""Names of faces in the order +X -X +Y -Y +Z -Z, which files may have in another case."""

TEMPLATE = "{face}"

_Way = tuple[str, tuple[str, ...], str]


_CASES: tuple[Callable[[str], str], ...] = (str, str.lower, str.upper, str.title)


def face_files(
    path: Path, own_names: tuple[str, ...] | None = None, *, is_face: bool = False
) -> tuple[Path, ...] | None:
    """Return the six files of a cubemap in the order +X -X +Y -Y +Z -Z.

    Parameters
    ----------
    path : Path
        With ``{face}`` in place of a face's name, or one of the files, whose name has that of a
        face at its end, or apart from other letters.
    own_names : tuple of 6 str, optional
        Names besides `KNOWN_NAMES`.
    is_face : bool, optional
        Whether the file is known to be one of six.

    Returns
    -------
    tuple of 6 Path, or None
        None if it is another file.

    Raises
    ------
    InputError
        If files are missing.
    """
    stem, suffix = path.stem, path.suffix
    known = KNOWN_NAMES if own_names is None else (own_names, *KNOWN_NAMES)
    ways = list((_template if TEMPLATE in stem else _ways)(stem, known))
    sets = [
        tuple(path.with_name(f"{before}{name}{after}{suffix}") for name in names)
        for before, names, after in ways
    ]
    for files in sets:
        if all(file.is_file() for file in files):
            return files
    if TEMPLATE not in stem and not is_face:
        return None
    if not sets:
        raise InputError(f"{path}: name must be that of one of six faces, got {path.name}")
    nearest = min(sets, key=lambda files: sum(not file.is_file() for file in files))
    missing = next(file for file in nearest if not file.is_file())
    raise InputError(f"{path}: all six faces must exist, got no {missing.name}")


def _template(stem: str, known: tuple[tuple[str, ...], ...]) -> Iterator[_Way]:
    before, _, after = stem.partition(TEMPLATE)
    for names in known:
        for case in _CASES:
            yield before, tuple(map(case, names)), after


def _ways(stem: str, known: tuple[tuple[str, ...], ...]) -> Iterator[_Way]:
    """Yield what is before, in place of and after what may be the name of a face."""
    for names in known:
        for face in names:
            name = re.escape(face)
            for pattern in (rf"{name}$", rf"(?<![A-Za-z0-9]){name}(?![A-Za-z0-9])"):
                for match in re.finditer(pattern, stem, re.IGNORECASE):
                    case = next((one for one in _CASES if one(face) == match.group()), str)
                    yield stem[: match.start()], tuple(map(case, names)), stem[match.end() :]
