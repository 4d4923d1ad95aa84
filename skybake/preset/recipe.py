"""The merged content of a preset, as data that make the same planet again."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any

from skybake.preset.document import Document
from skybake.preset.tables import file_digest, is_user_file

_TEXTS = ("title", "data_quality", "cover")
"""Keys whose texts name no file, though they may hold a slash."""


def recipe_of(document: Document, folder: Path) -> dict[str, Any]:
    """Return the recipe of a checked preset, see `Planet.recipe`.

    Parameters
    ----------
    document : Document
        The merged preset.
    folder : Path
        The preset's own. Paths that were relative to another one become absolute.
    """
    recipe = deepcopy(document.data)
    digests = {}
    for key, value in document.leaves():
        if key[-1] in _TEXTS or not isinstance(value, str) or not is_user_file(value):
            continue
        home = document.source(key).folder
        file = home / value
        name = value if home.resolve() == folder.resolve() else str(file.resolve())
        table = recipe
        for part in key[:-1]:
            table = table[part]
        table[key[-1]] = name
        digests[name] = file_digest(file)
    if digests:
        recipe["files"] = digests
    if document.changes:
        recipe["set"] = dict(document.changes)
    return recipe
