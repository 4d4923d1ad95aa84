"""A table of a preset, read key by key; every error names its place."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any, NoReturn, ParamSpec, TypeVar, cast

from skybake.errors import PresetError
from skybake.preset.document import Document, Key, dotted
from skybake.preset.message import nearest, shown
from skybake.preset.optics_model import Spectrum
from skybake.preset.tables import find_user_file, load_table

MISSING: Any = object()
"""Default of a key that must be given."""

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


class Section:
    """One table of a preset and the keys that were read from it.

    Parameters
    ----------
    document : Document
        The whole preset.
    key : tuple of str
        Names down to this table, empty for the document.
    cover : tuple of float, optional
        Least and greatest wavelength that spectra must cover. [nm]
    """

    def __init__(
        self, document: Document, key: Key = (), cover: tuple[float, float] | None = None
    ) -> None:
        self._document = document
        self._key = key
        self._data = document.table(key)
        self._asked: list[str] = []
        self.cover = cover

    def where(self, key: str = "") -> str:
        """Place of a key (or of this table) for a message: where it was written, and its name."""
        return self._document.place(self._path(key))

    def fail(self, key: str, rule: str) -> NoReturn:
        """Raise an error about a key."""
        raise PresetError(f"{self.where(key)}: {rule}")

    def keys(self) -> list[str]:
        """Keys that are given."""
        return list(self._data)

    def has(self, key: str) -> bool:
        """Whether the key is given; it counts as known from now on."""
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
        return Section(self._document, self._path(key), self.cover)

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
        """Spectrum: a number, an array, a table or ``{ wavelength_nm = [...], values = [...] }``.

        An array has its nodes in the key ``wavelength_nm`` beside it. A string names a
        table of skybake or a CSV file beside the preset; its column ``wavelength_nm``
        holds the nodes and the column named as the key the values.
        """
        value = self.raw(key, MISSING if default is None else default)
        if isinstance(value, dict):
            inner = self.section(key)
            nodes = inner.numbers("wavelength_nm", 1.0, 1e6)
            values = inner.numbers("values", least, most)
            if len(nodes) != len(values):
                inner.fail("values", f"must have {len(nodes)} numbers, got {len(values)}")
            inner.finish()
            return self._covering(key, nodes, values)
        if isinstance(value, list):
            nodes = self.numbers("wavelength_nm", 1.0, 1e6)
            values = self.numbers(key, least, most)
            if len(nodes) != len(values):
                self.fail(
                    key, f"must have {len(nodes)} numbers like wavelength_nm, got {len(values)}"
                )
            return self._covering(key, nodes, values)
        if isinstance(value, str):
            nodes, values = self.columns(key, "wavelength_nm", key)
            for one in values:
                self._number(key, one, least, most)
            return self._covering(key, nodes, values)
        return Spectrum(self.where(key), (), (self._number(key, value, least, most),))

    def table(self, key: str, column: str) -> dict[str, tuple[float, ...]]:
        """Columns of the table that the key names: one of skybake, or a user's CSV file."""
        name = self.text(key)
        return load_table(name, self.where(key), self._document.source(self._path(key)), column)

    def user_file(self, key: str) -> Path:
        """Path of the user's file that the key names."""
        name = self.text(key)
        where = f"{self.where(key)}: {shown(name)}"
        return find_user_file(name, where, self._document.source(self._path(key)))

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

    def check_cover(self, key: str, nodes: tuple[float, ...]) -> None:
        """Refuse nodes [nm] that do not ascend or do not reach as far as the rendering."""
        for before, after in pairwise(nodes):
            if not before < after:
                self.fail(key, f"wavelengths must ascend, got {after:g} nm after {before:g} nm")
        if self.cover and not nodes[0] <= self.cover[0] <= self.cover[1] <= nodes[-1]:
            self.fail(
                key,
                f"must cover {self.cover[0]:g} to {self.cover[1]:g} nm, "
                f"got {nodes[0]:g} to {nodes[-1]:g} nm",
            )

    def finish(self) -> None:
        """Refuse unknown keys."""
        known = sorted(set(self._asked))
        faults = []
        for key in self._data:
            if key not in known:
                like = nearest(key, known)
                hint = f", nearest: {like}" if like else ""
                file = self._document.source(self._path(key)).name
                where = ": ".join(filter(None, (file, dotted(self._key))))
                faults.append(
                    f"{where}: unknown key {shown(key)}{hint}; known keys: {', '.join(known)}"
                )
        if faults:
            raise PresetError(*faults)

    def _path(self, key: str) -> Key:
        return (*self._key, key) if key else self._key

    def _number(self, key: str, value: Any, least: float, most: float) -> float:
        # bool is an int in Python, but `optical_depth = true` is a mistake.
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(key, f"must be a number, got {shown(value)}")
        # Written so that nan fails too.
        if not value >= least:
            self.fail(key, f"must be at least {least:g}, got {shown(value)}")
        if not value <= most:
            self.fail(key, f"must be at most {most:g}, got {shown(value)}")
        return float(value)

    def _covering(self, key: str, nodes: tuple[float, ...], values: tuple[float, ...]) -> Spectrum:
        self.check_cover(key, nodes)
        return Spectrum(self.where(key), nodes, values)


class Gather:
    """Calls readers one after another and collects their errors, so that all are reported.

    Parameters
    ----------
    *sections : Section
        Tables that are read, whose unknown keys are errors too.
    """

    def __init__(self, *sections: Section) -> None:
        self._sections = sections
        self._faults: list[str] = []

    def __call__(
        self,
        read: Callable[Parameters, Result],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> Result:
        """Return what the reader returns; the result of one that fails is never used."""
        try:
            return read(*args, **kwargs)
        except PresetError as error:
            self._faults += error.faults
            return cast(Result, None)

    def finish(self) -> None:
        """Raise all errors as one."""
        for section in self._sections:
            self(section.finish)
        if self._faults:
            raise PresetError(*self._faults)
