"""What the knobs are set to, as a command, a preset and a program."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from skybake.baking.paths import default_path, preview_beside
from skybake.optics.changes import PresetChanges
from skybake.preset import load_document
from skybake.preset.find import is_path
from skybake.preset.toml import toml_text, toml_value
from skybake.studio.reader import Reader, Request
from skybake.studio.state import State


def exported(reader: Reader, state: State, output: str | None = None) -> dict[str, str]:
    """Return a state as other programs take it, fit for JSON.

    Parameters
    ----------
    reader : Reader
        Whose command line it is.
    state : State
        What the knobs are set to.
    output : str, optional
        The map's file.

    Returns
    -------
    dict
        ``command``, ``python``, ``toml`` and ``link``.

    Raises
    ------
    SkybakeError
        If the command line refuses it.
    """
    request = reader.read(state)
    return {
        "command": shlex.join(reader.words(state, output)),
        "python": python_text(request, output),
        "toml": preset_text(request),
        "link": state.link(),
    }


def preset_text(request: Request) -> str:
    """Return a preset that extends the one asked for and holds its changes alone, as TOML."""
    preset = request.preset
    base = str(Path(preset).resolve()) if is_path(preset) else preset
    changes = load_document(preset, request.changes.overrides(preset)).changes
    tree: dict[str, Any] = {}
    for key, value in changes.items():
        *tables, name = key.split(".")
        inner = tree
        for table in tables:
            inner = inner.setdefault(table, {})
        inner[name] = value
    body = toml_text(tree)
    return f"extends = {toml_value(base)}\n" + (f"\n{body}" if body else "")


def python_text(request: Request, output: str | None = None) -> str:
    """Return a program that bakes the map."""
    planet = python_value(request.preset)
    changes = request.changes
    if _given(changes):
        planet = f"{python_value(changes)}.load({planet})"
    parts = _given(request.settings)
    inner = "".join(f"\n    {name}={python_value(one)}," for name, one in parts.items())
    closing = "\n" if parts else ""
    arguments = ["planet", python_value(output), "settings"]
    if request.has_preview:
        map_name = output or default_path(request.planet, request.settings)
        arguments.append(f"preview={python_value(preview_beside(Path(map_name)))}")
        arguments.append(f"picture={python_value(request.picture)}")
    if request.attributes:
        arguments.append(f"attributes={python_value(request.attributes)}")
    return "\n".join(
        [
            "import skybake",
            "",
            f"planet = {planet}",
            f"settings = skybake.MapSettings({inner}{closing})",
            f"baked = skybake.bake({', '.join(arguments)})",
            "print(baked.files[0])",
            "",
        ]
    )


def python_value(value: Any) -> str:
    """Return an expression for a value; of an object of skybake with what differs from usual."""
    if is_dataclass(value) and not isinstance(value, type):
        given = ", ".join(f"{name}={python_value(one)}" for name, one in _given(value).items())
        return f"skybake.{type(value).__name__}({given})"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{key!r}: {python_value(one)}" for key, one in value.items())
        return f"{{{inner}}}"
    if isinstance(value, tuple | list):
        inner = ", ".join(map(python_value, value))
        if isinstance(value, list):
            return f"[{inner}]"
        return f"({inner},)" if len(value) == 1 else f"({inner})"
    if isinstance(value, Path):
        return repr(str(value))
    return repr(value)


def _given(value: Any) -> dict[str, Any]:
    """Return the attributes of a dataclass that differ from their defaults."""
    left_out = {"sources"} if isinstance(value, PresetChanges) else set()
    found = {}
    for field in fields(value):
        own = getattr(value, field.name)
        default = field.default
        if callable(field.default_factory):
            default = field.default_factory()
        if field.init and field.name not in left_out and own != default:
            found[field.name] = own
    return found
