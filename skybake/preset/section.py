"""A table of a TOML document, read key by key with every fault named by its place."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NoReturn

from skybake.errors import PresetError
from skybake.preset.message import shown
from skybake.preset.model import Spectrum
from skybake.preset.tables import load_table

MISSING: Any = object()
"""Default of a key that must be given."""


class Section:
    """One TOML table and the keys that were asked of it.

    Parameters
    ----------
    file : str
        How messages call the preset.
    path : str
        Dotted keys down to this table, empty for the document.
    data : dict
        The table as parsed.
    folder : Path
        What paths to the user's tables are relative to.
    """

    def __init__(self, file: str, path: str, data: dict[str, Any], folder: Path) -> None:
        self._file = file
        self._path = path
        self._data = data
        self._asked: list[str] = []
        self.folder = folder

    def where(self, key: str = "") -> str:
        """Place of a key (or of this table) for a message."""
        path = self._dotted(key)
        return f"{self._file}: {path}" if path else self._file

    def fail(self, key: str, rule: str) -> NoReturn:
        """Raise the fault of a key."""
        raise PresetError(f"{self.where(key)}: {rule}")

    def keys(self) -> list[str]:
        """Keys that the user gave."""
        return list(self._data)

    def has(self, key: str) -> bool:
        """Whether the user gave the key; it counts as known from now on."""
        self._asked.append(key)
        return key in self._data

    def raw(self, key: str, default: Any = MISSING) -> Any:
        """Value as parsed."""
        if self.has(key):
            return self._data[key]
        if default is MISSING:
            self.fail(key, "must be given")
        return default

    def section(self, key: str) -> Section:
        """Table under a key."""
        value = self.raw(key)
        if not isinstance(value, dict):
            self.fail(key, f"must be a table, got {shown(value)}")
        return Section(self._file, self._dotted(key), value, self.folder)

    def text(self, key: str, default: Any = MISSING) -> str:
        """One line of text."""
        value = self.raw(key, default)
        if not isinstance(value, str) or len(value.strip().splitlines()) != 1:
            self.fail(key, f"must be a line of text, got {shown(value)}")
        return value

    def choice(self, key: str, choices: tuple[str, ...], default: Any = MISSING) -> str:
        """One of a few strings."""
        value = self.raw(key, default)
        if not isinstance(value, str) or value not in choices:
            self.fail(key, f"must be one of {', '.join(choices)}, got {shown(value)}")
        return str(value)

    def number(self, key: str, least: float, most: float, default: Any = MISSING) -> float:
        """Finite number within bounds, both included."""
        return self._number(key, self.raw(key, default), least, most)

    def numbers(
        self, key: str, least: float, most: float, default: Any = MISSING
    ) -> tuple[float, ...]:
        """Non-empty array of numbers within bounds."""
        values = self.raw(key, default)
        if not isinstance(values, list) or not values:
            self.fail(key, f"must be an array of numbers, got {shown(values)}")
        return tuple(self._number(key, value, least, most) for value in values)

    def spectrum(
        self, key: str, least: float, most: float, default: float | None = None
    ) -> Spectrum:
        """Spectrum: a number, a table or ``{ wavelength_nm = [...], values = [...] }``.

        A string names a table of skybake or a CSV file beside the preset; its
        column ``wavelength_nm`` holds the nodes and the column named as the
        key the values.
        """
        value = self.raw(key, MISSING if default is None else default)
        if isinstance(value, dict):
            inner = self.section(key)
            nodes = inner.numbers("wavelength_nm", 1.0, 1e6)
            values = inner.numbers("values", least, most)
            if len(nodes) != len(values):
                inner.fail("values", f"must have {len(nodes)} numbers, got {len(values)}")
            inner.finish()
            return self._ordered(key, nodes, values)
        if isinstance(value, str):
            nodes, values = self.columns(key, "wavelength_nm", key)
            for one in values:
                self._number(key, one, least, most)
            return self._ordered(key, nodes, values)
        return Spectrum(self.where(key), (), (self._number(key, value, least, most),))

    def table(self, key: str, column: str) -> dict[str, tuple[float, ...]]:
        """Columns of the table that the key names: one of skybake, or a user's CSV file."""
        return load_table(self.text(key), self.where(key), self.folder, column)

    def columns(self, key: str, first: str, second: str) -> list[tuple[float, ...]]:
        """Two columns of the table that the key names."""
        table = self.table(key, second)
        if not {first, second} <= set(table):
            self.fail(
                key,
                f"table {shown(self.raw(key))} must have columns {first} and {second}, "
                f"got {', '.join(table)}",
            )
        return [table[first], table[second]]

    def finish(self) -> None:
        """Refuse keys that nobody asked for."""
        for key in self._data:
            if key not in self._asked:
                known = sorted(set(self._asked))
                self.fail("", f"unknown key {shown(key)}; known keys: {', '.join(known)}")

    def _dotted(self, key: str) -> str:
        return ".".join(part for part in (self._path, key) if part)

    def _number(self, key: str, value: Any, least: float, most: float) -> float:
        # bool is an int to Python, but `optical_depth = true` is a slip.
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(key, f"must be a number, got {shown(value)}")
        # Written so that nan fails too.
        if not value >= least:
            self.fail(key, f"must be at least {least:g}, got {shown(value)}")
        if not value <= most:
            self.fail(key, f"must be at most {most:g}, got {shown(value)}")
        return float(value)

    def _ordered(self, key: str, nodes: tuple[float, ...], values: tuple[float, ...]) -> Spectrum:
        if len(set(nodes)) < len(nodes):
            self.fail(key, "wavelengths must differ from each other")
        pairs = sorted(zip(nodes, values, strict=True))
        return Spectrum(
            self.where(key), tuple(node for node, _ in pairs), tuple(value for _, value in pairs)
        )
