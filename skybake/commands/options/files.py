"""Which files options name, so that a page reads none out of a folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from skybake.commands.options.world import read_value
from skybake.errors import InputError

_TILE = "tile="


def check_within(folder: Path, option: str, text: str, *, is_path: bool = False) -> None:
    """Refuse the text of an option that names a file out of a folder.

    Parameters
    ----------
    folder : Path
        Resolved; relative names are in it.
    option : str
        Long name without dashes.
    text : str
        As it is typed.
    is_path : bool, optional
        Whether the whole text is the name of a file.

    Raises
    ------
    InputError
        That names the file.
    """
    for name in [text] if is_path else files_named(option, text):
        if not (folder / name).resolve().is_relative_to(folder):
            raise InputError(f"--{option}: file must be in the working folder, got {name!r}")


def files_named(option: str, text: str) -> Iterator[str]:
    """Yield the names of the user's files in the text of an option."""
    from skybake.preset.find import is_path
    from skybake.preset.tables import is_user_file

    if option == "preset":
        named = [text] if is_path(text) else []
    elif option in {"set", "ground-albedo"}:
        value = text.partition("=")[2] if option == "set" else text
        named = [one for one in _texts(read_value(value.strip())) if is_user_file(one)]
    elif option == "clouds":
        parts = [part.strip() for part in text.split(",")]
        named = [part.removeprefix(_TILE).strip() for part in parts if part.startswith(_TILE)]
        named += [part.partition("=")[2] for part in parts if is_user_file(part.partition("=")[2])]
    else:
        named = []
    yield from named


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for one in value.values():
            yield from _texts(one)
    elif isinstance(value, list):
        for one in value:
            yield from _texts(one)
