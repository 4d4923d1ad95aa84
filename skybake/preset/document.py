"""A preset put together from several sources, which remembers where each key was written."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from skybake.errors import PresetError

Key = tuple[str, ...]
"""Names of the tables down to a key, and its own."""

NONE = "none"
"""The value that removes what an earlier source gave."""

MAX_DEPTH = 8
"""Nesting of tables; no key of a preset is deeper."""

_WHOLE = {"composition"}
_RIVALS = {
    "relative_extinction": "angstrom_exponent",
    "angstrom_exponent": "relative_extinction",
    "liquid_water_path_g_m2": "optical_depth",
    "optical_depth": "liquid_water_path_g_m2",
    # What a former table said of polarisation does not hold for another.
    "table": "polarisation",
    "tile": "kind",
    "kind": "tile",
}


@dataclass(frozen=True, slots=True)
class Source:
    """Where a part of a preset was written.

    Attributes
    ----------
    name : str
        Its name in messages: a file, or an option of the command line.
    folder : Path
        What paths to the user's tables are relative to.
    is_file : bool
        Whether it is a file, which must not point out of its folder.
    """

    name: str
    folder: Path
    is_file: bool = True


def dotted(key: Key) -> str:
    """Key as users write it."""
    return ".".join(key)


class Document:
    """The tables of a preset, merged in order.

    Attributes
    ----------
    data : dict
        The merged content of the preset.
    changes : dict
        The values that were set one by one, by their dotted keys.

    Notes
    -----
    A later source wins. Tables are merged key by key, but a table of another ``kind``,
    one with a ``tile`` instead of a kind, and a gas's composition replace the former one
    completely. The value "none" removes a key, and of two keys that exclude each other the
    later one removes the former.
    """

    def __init__(self) -> None:
        self.data: dict[str, Any] = {}
        self.changes: dict[str, Any] = {}
        self._sources: dict[Key, Source] = {}

    def lay(self, table: dict[str, Any], source: Source) -> None:
        """Merge a whole file into the tables.

        Raises
        ------
        PresetError
            If it removes what is not there, or its tables are nested too deep.
        """
        if not self.data:
            self._mark((), table, source)
            self.data = deepcopy(table)
            return
        self._sources[()] = source
        self._merge(self.data, (), table, source)

    def set(self, key: Key, value: Any, source: Source) -> None:
        """Set one value; missing tables around it are made.

        Raises
        ------
        PresetError
            If it removes what is not there.
        """
        self._check_depth(key, source)
        table = self.data
        for depth, name in enumerate(key[:-1], start=1):
            if not isinstance(table.get(name), dict):
                self._forget(key[:depth])
                table[name] = {}
            self._sources[key[:depth]] = source
            table = table[name]
        self._merge(table, key[:-1], {key[-1]: value}, source)
        self.changes[dotted(key)] = deepcopy(value)

    def table(self, key: Key) -> dict[str, Any]:
        """Return the table at a key."""
        table = self.data
        for name in key:
            table = table[name]
        return table

    def source(self, key: Key) -> Source:
        """Where a key was written, or if it is absent the innermost table around it."""
        while key not in self._sources:
            key = key[:-1]
        return self._sources[key]

    def place(self, key: Key) -> str:
        """Where a key was written, and its name: the beginning of messages."""
        file = self.source(key).name
        return f"{file}: {dotted(key)}" if key else file

    def leaves(self) -> list[tuple[Key, Any]]:
        """All values that are not tables, with their keys."""
        return _leaves(self.data, ())

    def _merge(self, into: dict[str, Any], at: Key, table: dict[str, Any], source: Source) -> None:
        for name, value in table.items():
            key = (*at, name)
            old = into.get(name)
            if value == NONE:
                if name not in into:
                    known = ", ".join(into)
                    raise PresetError(
                        f"{source.name}: {dotted(key)}: 'none' must remove one of {known}"
                    )
                self._remove(into, key)
            elif isinstance(value, dict) and isinstance(old, dict) and _merges(name, old, value):
                self._sources[key] = source
                self._merge(old, key, value, source)
            else:
                self._forget(key)
                self._mark(key, value, source)
                into[name] = deepcopy(value)  # keeps its place among the constituents
            rival = _RIVALS.get(name, "")
            if rival in into and rival not in table:
                self._remove(into, (*at, rival))

    def _remove(self, table: dict[str, Any], key: Key) -> None:
        del table[key[-1]]
        self._forget(key)

    def _forget(self, key: Key) -> None:
        for known in [known for known in self._sources if known[: len(key)] == key]:
            del self._sources[known]

    def _mark(self, key: Key, value: Any, source: Source) -> None:
        self._check_depth(key, source)
        self._sources[key] = source
        if isinstance(value, dict):
            for name, inner in value.items():
                self._mark((*key, name), inner, source)

    @staticmethod
    def _check_depth(key: Key, source: Source) -> None:
        if len(key) > MAX_DEPTH:
            raise PresetError(
                f"{source.name}: {dotted(key[:2])}: tables must be nested at most {MAX_DEPTH} deep"
            )


def _merges(name: str, old: dict[str, Any], new: dict[str, Any]) -> bool:
    is_same = "kind" not in new or new["kind"] == old.get("kind")
    # A layer of clouds may have the name of the key.
    is_tile = "tile" in new and not isinstance(new["tile"], dict)
    return name not in _WHOLE and is_same and (not is_tile or "tile" in old)


def _leaves(table: dict[str, Any], at: Key) -> list[tuple[Key, Any]]:
    found: list[tuple[Key, Any]] = []
    for name, value in table.items():
        key = (*at, name)
        found += _leaves(value, key) if isinstance(value, dict) else [(key, value)]
    return found
