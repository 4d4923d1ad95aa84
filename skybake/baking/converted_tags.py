"""Metadata of a map that was made of another file's: carried along, and mended where it changed."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from skybake.environment.environment import Environment
from skybake.formats.spec import Attribute
from skybake.formats.spectral_exr import SPECTRAL_UNITS
from skybake.image.light import attributes_from_light, light_from_attributes
from skybake.image.recipe import HASH_ATTRIBUTE, LONGEST_RECIPE
from skybake.projection.of_file import file_recipe
from skybake.units import degrees

_OWN = "skybake:"
_KEPT = ("Artist", "Copyright", "DateTime", "ImageDescription", "comments", "owner")
_RECIPE = "skybake:recipe"
_SPACE, _WHITE = "colorspace", "white_luminance_cd_m2"


def converted_attributes(
    before: Environment, after: Environment, encoding: Mapping[str, Any]
) -> dict[str, Attribute]:
    """Return the attributes of a file.

    Parameters
    ----------
    before, after : Environment
        The map as it was read, and as it is written.
    encoding : mapping
        Of the recipe's keys for the pixels, those of the file that is written.

    Returns
    -------
    dict of str to Attribute
        What the file before had, but that directions in the map's axes turn with it, that the
        recipe describes the file which is written and says what it was made of, and that it has no
        hash, which stands for a map as it is baked.
    """
    kept = {
        name: value
        for name, value in before.attributes.items()
        if (name.startswith(_OWN) or name in _KEPT)
        and name != SPECTRAL_UNITS
        and isinstance(value, str | int | float | tuple)
    }
    kept.pop(HASH_ATTRIBUTE, None)
    return {
        **kept,
        **_light(before.attributes, before.rotation - after.rotation),
        _RECIPE: _recipe(before, after, encoding),
    }


def _light(attributes: Mapping[str, Any], turn: float) -> dict[str, Attribute]:
    """Return the light that a file of ours states, in the axes of a map that is turned."""
    try:
        light = light_from_attributes(attributes)
    except (KeyError, TypeError, ValueError):
        return {}
    x, y, z = light.sun_direction
    sine, cosine = math.sin(turn), math.cos(turn)
    found = attributes_from_light(light)
    found["skybake:sunDirection"] = (x * cosine - z * sine, y, z * cosine + x * sine)
    return found


def _recipe(before: Environment, after: Environment, encoding: Mapping[str, Any]) -> str:
    recipe = file_recipe(before.attributes)
    shown = recipe.get("map")
    was = shown if isinstance(shown, dict) else {}
    layout = before.projection.recipe()
    # Of another projection, or without a spectrum, some keys have no meaning.
    others = {key: value for key, value in was.items() if key not in _layout_keys(before)}
    if others.get("sun_disc") == "separate":
        others["sun_disc"] = "include"
    now = {
        **others,
        **after.projection.recipe(),
        "rotate_deg": degrees(after.rotation),
        **encoding,
    }
    converted = {**layout, "rotate_deg": degrees(before.rotation)}
    if before.space is not None:
        converted[_SPACE] = before.space.name
    if before.white_luminance is not None:
        converted[_WHITE] = before.white_luminance
    for extra in ({"converted_from": converted}, {}):
        text = json.dumps({**recipe, "map": now, **extra})
        if len(text) <= LONGEST_RECIPE:
            break
    return text


def _layout_keys(environment: Environment) -> set[str]:
    keys = set(environment.projection.recipe())
    others = ("equirect_rows", "cube_layout", "cube_space", "face_names")
    return keys | {*others, "mips", "layers", "wavelengths_nm"}
