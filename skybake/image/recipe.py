"""All that decides the pixels of a map, as its files tell it."""

from __future__ import annotations

import hashlib
import json
from typing import Any

from skybake.formats.spec import Attribute
from skybake.image.settings import MapSettings
from skybake.preset import Planet
from skybake.version import __version__

HASH_ATTRIBUTE = "skybake:recipeHash"


def map_recipe(planet: Planet, settings: MapSettings) -> dict[str, Any]:
    """Return the recipe of a map, fit for JSON."""
    return {"map": settings.recipe(), "preset": planet.recipe}


def recipe_hash(planet: Planet, settings: MapSettings) -> str:
    """Digest of a map's recipe and of the version that bakes it."""
    recipe = json.dumps([__version__, map_recipe(planet, settings)], sort_keys=True)
    return hashlib.sha256(recipe.encode()).hexdigest()[:32]


def recipe_attributes(planet: Planet, settings: MapSettings) -> dict[str, Attribute]:
    """Return the attributes of a map's files."""
    return {
        "skybake:preset": planet.name,
        "skybake:recipe": json.dumps(map_recipe(planet, settings)),
        HASH_ATTRIBUTE: recipe_hash(planet, settings),
    }


def preview_texts(planet: Planet, settings: MapSettings, ev: float, view: str) -> dict[str, str]:
    """Return what the preview of a map says of itself, in PNG's only type.

    The exposure value is rounded to what no eye and no eight bits tell apart.
    """
    return {
        HASH_ATTRIBUTE: recipe_hash(planet, settings),
        "skybake:exposureValue": f"{ev:.4f}",
        "skybake:view": view,
    }
