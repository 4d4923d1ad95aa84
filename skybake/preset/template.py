"""Presets as text: merged with what they extend, and as the start of another."""

from __future__ import annotations

from pathlib import Path

from skybake.errors import PresetError
from skybake.preset.document import Key
from skybake.preset.extend import NAME, Overrides, load_document
from skybake.preset.find import display_name, find_preset, is_path
from skybake.preset.load import load_preset
from skybake.preset.message import shown
from skybake.preset.recipe import recipe_of
from skybake.preset.toml import toml_text, toml_value

_LONGEST = 80


def resolved_text(name_or_path: str | Path, overrides: Overrides = ()) -> str:
    """Return a preset with what it extends and what is set, as TOML.

    Each key that was not written in the preset itself names its origin in a comment.
    Loaded from the preset's own folder the text makes the same planet.

    Raises
    ------
    PresetError
        If the preset is faulty.
    """
    load_preset(name_or_path, overrides)
    path = find_preset(name_or_path)
    document = load_document(name_or_path, overrides)
    own = display_name(path)
    recipe = recipe_of(document, path.parent)
    data = {key: value for key, value in recipe.items() if key not in ("files", "set")}

    def with_origin(key: Key, line: str) -> str:
        origin = document.source(key).name
        return line if origin == own else f"{line} # {origin}"

    return toml_text(data, with_origin)


def preset_template(name: str, base: str) -> str:
    """Return the text of a preset that extends another and changes nothing yet.

    Parameters
    ----------
    name : str
        Of letters, digits, ``_`` and ``-``.
    base : str
        Name or path of the preset to extend.

    Raises
    ------
    PresetError
        If the name does not fit or the base is faulty.
    """
    if not NAME.fullmatch(name):
        raise PresetError(f"name: must consist of letters, digits, _ and -, got {shown(name)}")
    load_preset(base)
    file = str(Path(base).resolve()) if is_path(base) else base
    data = load_document(base).data
    body = {key: value for key, value in data.items() if key not in ("title", "data_quality")}
    return f"""\
# A world of your own. It contains only what differs from what it extends: remove the # from a line
# and change its value. The value "none" removes a key. To remove a whole constituent, delete its
# table here, including the header, and write above the first table: constituents.NAME = "none"
# Check it with: skybake presets check {name}.toml
extends = {toml_value(file)}
title = {toml_value(f"{name}, after {base}")}

{toml_text(body, _comment)}
# constituents.NAME = {{ ... }} adds one, and so does clouds.NAME, see docs/presets.md.
"""


def _comment(_: Key, line: str) -> str:
    return f"# {line}" if len(line) <= _LONGEST else f"# {line[:_LONGEST]} ..."
