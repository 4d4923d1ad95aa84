"""Presets that extend others, and values that override them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from skybake.errors import PresetError
from skybake.preset.document import Document, Key, Source, dotted
from skybake.preset.find import display_name, find_preset, is_path, preset_names, read_preset
from skybake.preset.message import nearest, shown
from skybake.preset.toml import NAMED

TOP_KEYS = (
    "title",
    "data_quality",
    "rendering",
    "wavelengths_nm",
    "planet",
    "star",
    "ground",
    "constituents",
    "clouds",
)
"""Top-level keys of a preset, apart from `extends`."""

NAME = re.compile(r"[A-Za-z0-9_-]+")
"""Names of constituents and of layers of clouds, which fit into dotted keys."""


@dataclass(frozen=True, slots=True)
class Override:
    """A value that overrides one of a preset.

    Attributes
    ----------
    key : str
        Dotted; a constituent's may leave out the prefix ``constituents.``.
    value : Any
        As parsed from TOML; "none" removes the key.
    source : str
        Where it was written, for messages.
    """

    key: str
    value: Any
    source: str = "overrides"


Overrides = Mapping[str, Any] | Iterable[Override]
"""Values that override those of a preset, by dotted keys or with their sources."""


def load_document(name_or_path: str | Path, overrides: Overrides = ()) -> Document:
    """Read a preset with all that it extends, and override values.

    Parameters
    ----------
    name_or_path : str or Path
        As of `load_preset`.
    overrides : mapping of str to Any, or iterable of Override
        In the order in which they are applied.

    Returns
    -------
    Document
        Not checked yet, except as TOML.

    Raises
    ------
    PresetError
        If a file cannot be read, extends itself, or a key of the overrides is unknown.
    """
    document = Document()
    for path, table in reversed(_chain(find_preset(name_or_path))):
        document.lay(table, Source(display_name(path), path.parent))
    for override in _listed(overrides):
        source = Source(override.source, Path(), is_file=False)
        document.set(_full_key(document, override), override.value, source)
    return document


def planet_name(name_or_path: str | Path) -> str | None:
    """Return the planet of a preset, such as ``mars``, if it extends one that comes with skybake.

    Raises
    ------
    PresetError
        If a file cannot be read or extends itself.
    """
    base = _chain(find_preset(name_or_path))[-1][0].stem
    return base.partition("-")[0] if base in preset_names() else None


def _listed(overrides: Overrides) -> list[Override]:
    if isinstance(overrides, Mapping):
        return [Override(key, value) for key, value in overrides.items()]
    return list(overrides)


def _chain(path: Path) -> list[tuple[Path, dict[str, Any]]]:
    """Return a preset and what it extends, each the base of the one before."""
    chain: list[tuple[Path, dict[str, Any]]] = []
    where = display_name(path)
    while True:
        table = _parse(path, where)
        chain.append((path, table))
        if "extends" not in table:
            return chain
        where = f"{display_name(path)}: extends"
        path = _base(path, where, table.pop("extends"))
        visited = [known for known, _ in chain]
        if path.resolve() in [known.resolve() for known in visited]:
            names = " -> ".join(display_name(one) for one in [*visited, path])
            raise PresetError(f"{where}: must not form a cycle, got {names}")


def _base(path: Path, where: str, base: Any) -> Path:
    if not isinstance(base, str):
        raise PresetError(f"{where}: must be a preset's name or a file, got {shown(base)}")
    if is_path(base):
        file = path.parent / base
        read_preset(file, f"{where}: {shown(base)}")
        return file
    try:
        return find_preset(base)
    except PresetError as error:
        raise PresetError(f"{where}: {error}") from error


def _parse(path: Path, where: str) -> dict[str, Any]:
    text = read_preset(path, where)
    file = display_name(path)
    try:
        return tomllib.loads(text)
    # A ValueError that is not a TOMLDecodeError comes from an integer of thousands of digits.
    except (ValueError, RecursionError) as error:
        raise PresetError(f"{file}: not valid TOML: {error}") from error


def _full_key(document: Document, override: Override) -> Key:
    """Key of an override from the top."""
    key = tuple(override.key.split("."))
    names = _names(document, "constituents")
    if key[0] in names and key[0] not in TOP_KEYS:
        key = ("constituents", *key)
    known = _names(document, key[0]) if key[0] in NAMED else names
    if all(map(NAME.fullmatch, key)) and _leads_somewhere(key, known):
        return key
    keys = [dotted(key).removeprefix("constituents.") for key, _ in document.leaves()]
    like = nearest(override.key.removeprefix("constituents."), [*names, *TOP_KEYS, *keys])
    heads = ", ".join((*names, *(name for name in TOP_KEYS if name != "constituents")))
    raise PresetError(
        f"{override.source}: {shown(override.key)}: unknown key; "
        + (f"nearest: {like}" if like else f"keys start with: {heads}")
    )


def _names(document: Document, table: str) -> dict[str, Any]:
    found = document.data.get(table)
    return found if isinstance(found, dict) else {}


def _leads_somewhere(key: Key, names: Iterable[str]) -> bool:
    """Whether a key's table is there; its reader checks what is in it."""
    if key[0] not in NAMED or len(key) <= 2:
        return key[0] in TOP_KEYS
    return key[1] in names or key[2:] in (("kind",), ("tile",))
