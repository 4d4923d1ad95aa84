"""Writes a preset as TOML; the standard library only reads it."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from skybake.preset.document import Key

HEADED = ("planet", "star", "ground", "constituents", "clouds")
"""Tables that get a heading; those within them are written inline."""

NAMED = ("constituents", "clouds")
"""Those whose tables have headings as well."""


def toml_text(data: dict[str, Any], line: Callable[[Key, str], str] | None = None) -> str:
    """Write a preset.

    Parameters
    ----------
    data : dict
        Of texts, numbers, booleans, arrays and tables.
    line : callable, optional
        From a dotted key's parts and its line to the line that is written instead.

    Returns
    -------
    str
        Reading it gives the same data, in the same order within each table.
    """
    return "\n".join(_lines(data, (), line or (lambda _, text: text)))


def _lines(table: dict[str, Any], key: Key, line: Callable[[Key, str], str]) -> list[str]:
    inner = {name for name, value in table.items() if _is_headed((*key, name), value)}
    lines = [
        line((*key, name), f"{_name(name)} = {toml_value(value)}")
        for name, value in table.items()
        if name not in inner
    ]
    if key and (lines or not table):
        lines.insert(0, f"[{'.'.join(map(_name, key))}]")
    if lines:
        lines.append("")
    for name, value in table.items():
        if name in inner:
            lines += _lines(value, (*key, name), line)
    return lines


def _is_headed(key: Key, value: Any) -> bool:
    return isinstance(value, dict) and key[0] in HEADED and len(key) <= 1 + (key[0] in NAMED)


def toml_value(value: Any) -> str:
    """Write one value, on one line.

    Raises
    ------
    TypeError
        If no preset can hold a value of its type.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(float(value) if isinstance(value, float) else int(value))
    if isinstance(value, str):
        # DEL is the one control character that JSON leaves as it is and TOML does not take.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, dict):
        inner = ", ".join(f"{_name(name)} = {toml_value(one)}" for name, one in value.items())
        return f"{{ {inner} }}" if inner else "{}"
    raise TypeError(f"not a TOML value: {value!r}")


def _name(name: str) -> str:
    bare = name.isascii() and name.replace("_", "").replace("-", "").isalnum()
    return name if bare else toml_value(name)
