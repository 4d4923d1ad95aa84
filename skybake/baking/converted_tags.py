"""Metadata of a map that was made of another file's: carried along, and mended where it changed."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np

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
_VECTORS = {"skybake:moonDirection": 3, "skybake:celestialRotation": 9}
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
    turn = before.rotation - after.rotation
    return {
        **kept,
        **_light(before.attributes, turn),
        **_night(before.attributes, turn),
        _RECIPE: _recipe(before, after, encoding),
    }


def _light(attributes: Mapping[str, Any], turn: float) -> dict[str, Attribute]:
    """Return the light that a file of ours states, in the axes of a map that is turned."""
    try:
        light = light_from_attributes(attributes)
    except (KeyError, TypeError, ValueError):
        return {}
    found = attributes_from_light(light)
    found["skybake:sunDirection"] = _turned(light.sun_direction, turn)
    return found


def _night(attributes: Mapping[str, Any], turn: float) -> dict[str, Attribute]:
    """Return where the Moon and the stars of a file of ours stand in a map that is turned."""
    found: dict[str, Attribute] = {}
    for name, length in _VECTORS.items():
        value = attributes.get(name, ())
        numbers = value.split() if isinstance(value, str) else np.ravel(value)
        if len(numbers) != length:
            continue
        with suppress(ValueError):
            # Columns are vectors.
            rows = np.array(numbers, dtype=float).reshape(3, -1)
            columns = [_turned(column, turn) for column in rows.T.tolist()]
            found[name] = tuple(np.array(columns).T.ravel().tolist())
    return found


def _turned(vector: Sequence[float], turn: float) -> tuple[float, float, float]:
    x, y, z = vector
    sine, cosine = math.sin(turn), math.cos(turn)
    return x * cosine - z * sine, y, z * cosine + x * sine


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
