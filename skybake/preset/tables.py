"""CSV tables: those that come with skybake, and the user's own."""

from __future__ import annotations

import math
import os
from pathlib import Path

from skybake import input_files
from skybake.errors import InputError, PresetError
from skybake.preset.document import Source
from skybake.preset.message import shown

_DATA = Path(__file__).resolve().parents[1] / "data"


def is_user_file(name: str) -> bool:
    """Whether a preset's string is the path of a user's file rather than a table of skybake."""
    return name.endswith((".csv", ".npz")) or "/" in name or "\\" in name


def load_table(name: str, where: str, source: Source, column: str) -> dict[str, tuple[float, ...]]:
    """Read a table.

    Parameters
    ----------
    name : str
        Name of a table that comes with skybake, or a CSV file of the user's.
    where : str
        Where the preset names it, for messages.
    source : Source
        What the user's paths are relative to; only an absolute path leads out of a file's
        folder, so that a preset from elsewhere stays within the files that came with it.
    column : str
        A column that it needs, so that messages can name suitable tables.

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
        where = f"{where}: {shown(name)}"
        return _parse(where, _read(find_user_file(name, where, source), where))
    if name not in {path.stem for path in _DATA.glob("*.csv")}:
        columns = table_columns()
        known = ", ".join(one for one in columns if column in columns[one])
        raise PresetError(
            f"{where}: unknown table {shown(name)}; tables with a column {column}: "
            f"{known or 'none'}; your own file must end in .csv"
        )
    return _parse(where, _read(_DATA / f"{name}.csv", where))


def find_user_file(name: str, where: str, source: Source) -> Path:
    """Path of a user's file that a preset names.

    Raises
    ------
    PresetError
        If it leads out of the preset's folder.
    """
    if source.is_file and Path(os.path.normpath(name)).parts[0] == os.pardir:
        raise PresetError(f"{where}: must be in the preset's folder or an absolute path")
    return source.folder / name


def file_digest(path: Path) -> str:
    """SHA-256 of a user's table or tile, in hexadecimal digits.

    Raises
    ------
    PresetError
        If it cannot be read.
    """
    try:
        return input_files.digest(path, str(path), input_files.LARGEST_TILE)
    except InputError as error:
        raise PresetError(str(error)) from error


def table_columns() -> dict[str, list[str]]:
    """Columns of the tables that come with skybake, by the tables' names, sorted."""
    return {
        path.stem: _lines(path.read_text(encoding="utf-8"))[0].split(",")
        for path in sorted(_DATA.glob("*.csv"))
    }


def _read(path: Path, where: str) -> str:
    try:
        return input_files.read_text(path, where, input_files.LARGEST_TABLE)
    except InputError as error:
        raise PresetError(str(error)) from error


def _lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.strip() and not line.startswith("#")]


def _parse(where: str, text: str) -> dict[str, tuple[float, ...]]:
    lines = _lines(text)
    if len(lines) < 2:
        raise PresetError(f"{where}: must have a line of column names and a line of numbers")
    names = [name.strip() for name in lines[0].split(",")]
    if len(set(names)) < len(names):
        raise PresetError(f"{where}: column names must differ, got {shown(lines[0])}")
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
            raise PresetError(f"{where}: a line must be {width} finite numbers, got {shown(line)}")
        rows.append(row)
    return rows
