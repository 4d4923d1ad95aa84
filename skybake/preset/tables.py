"""CSV tables: those that come with skybake, and the user's own."""

from __future__ import annotations

import math
from pathlib import Path

from skybake.errors import PresetError
from skybake.preset.find import read_text

_DATA = Path(__file__).resolve().parents[1] / "data"


def is_user_file(name: str) -> bool:
    """Whether a preset's string means a file of the user's rather than a table of skybake."""
    return name.endswith(".csv") or "/" in name or "\\" in name


def load_table(name: str, where: str, folder: Path) -> dict[str, tuple[float, ...]]:
    """Read a table.

    Parameters
    ----------
    name : str
        Name of a table that comes with skybake, or a CSV file of the user's.
    where : str
        Where the preset names it, for messages.
    folder : Path
        What the user's paths are relative to: the preset's folder.

    Returns
    -------
    dict of str to tuple of float
        Columns by their names, in the file's order and of equal length.

    Raises
    ------
    PresetError
        If there is no such table or it is not a rectangle of finite numbers.
    """
    if is_user_file(name):
        return _parse(f"{where}: {name}", read_text(folder / name))
    path = _DATA / f"{name}.csv"
    if not path.is_file():
        known = ", ".join(sorted(path.stem for path in _DATA.glob("*.csv")))
        raise PresetError(
            f"{where}: unknown table {name!r}; known tables: {known}; "
            "a file of your own needs the ending .csv"
        )
    return _parse(where, read_text(path))


def _parse(where: str, text: str) -> dict[str, tuple[float, ...]]:
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) < 2:
        raise PresetError(f"{where}: must have a line of column names and a line of numbers")
    names = [name.strip() for name in lines[0].split(",")]
    if len(set(names)) < len(names):
        raise PresetError(f"{where}: column names must differ, got {lines[0]!r}")
    rows = _rows(where, lines[1:], len(names))
    return dict(zip(names, zip(*rows, strict=True), strict=True))


def _rows(where: str, lines: list[str], width: int) -> list[list[float]]:
    rows = []
    for line in lines:
        try:
            row = [float(cell) for cell in line.split(",")]
        except ValueError:
            row = []
        if len(row) != width or not all(map(math.isfinite, row)):
            raise PresetError(f"{where}: a line must be {width} finite numbers, got {line!r}")
        rows.append(row)
    return rows
