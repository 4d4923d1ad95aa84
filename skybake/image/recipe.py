"""Everything that determines the pixels of a map, as its files state it."""

from __future__ import annotations

import hashlib
import json
from typing import Any

from skybake.formats.spec import Attribute
from skybake.image.settings import MapSettings
from skybake.preset import Planet
from skybake.version import __version__

HASH_ATTRIBUTE = "skybake:recipeHash"

LONGEST_RECIPE = 4000
"""Length of a recipe's text in a file. OpenImageIO opens no Radiance picture with a hundred
lines in its header. [character]"""

LONGEST_LIST = 16
"""Numbers in a list that a recipe which is too long keeps."""


def map_recipe(planet: Planet, settings: MapSettings) -> dict[str, Any]:
    """Return the recipe of a map, fit for JSON."""
    return {"map": settings.recipe(has_clouds=bool(planet.clouds)), "preset": planet.recipe}


def recipe_text(planet: Planet, settings: MapSettings) -> str:
    """Return the recipe of a map as JSON that every reader of its files accepts.

    Of one that is longer than `LONGEST_RECIPE` the preset's long lists, as inline spectra, are
    replaced by their digests, and if that does not suffice, the whole preset: SHA-256 of the
    JSON with sorted keys, which a manifest holds in full.
    """
    recipe = map_recipe(planet, settings)
    for preset in (planet.recipe, _without_long_lists(planet.recipe)):
        text = json.dumps({"map": recipe["map"], "preset": preset})
        if len(text) <= LONGEST_RECIPE:
            return text
    return json.dumps({"map": recipe["map"], "preset": _digest(planet.recipe)})


def _without_long_lists(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_long_lists(each) for key, each in value.items()}
    return _digest(value) if isinstance(value, list) and len(value) > LONGEST_LIST else value


def _digest(value: Any) -> dict[str, str]:
    text = json.dumps(value, sort_keys=True)
    return {"sha256": hashlib.sha256(text.encode()).hexdigest()}


def recipe_hash(planet: Planet, settings: MapSettings) -> str:
    """Digest of a map's recipe and of the version that bakes it."""
    recipe = json.dumps([__version__, map_recipe(planet, settings)], sort_keys=True)
    return hashlib.sha256(recipe.encode()).hexdigest()[:32]


def recipe_attributes(planet: Planet, settings: MapSettings) -> dict[str, Attribute]:
    """Return the attributes of a map's files."""
    return {
        "skybake:preset": planet.name,
        "skybake:recipe": recipe_text(planet, settings),
        HASH_ATTRIBUTE: recipe_hash(planet, settings),
        **target_attributes(settings),
    }


def target_attributes(settings: MapSettings) -> dict[str, Attribute]:
    """Return the attributes of a map's files that tell of its target, none without one."""
    if settings.encoding.target is None:
        return {}
    from skybake.image.target_sun import target_sun_direction

    return {
        "skybake:target": settings.encoding.target,
        "skybake:targetSunDirection": target_sun_direction(settings, settings.encoding.target),
    }
