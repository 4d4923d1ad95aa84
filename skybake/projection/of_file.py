"""How the picture in a file is laid out, by what the file says of itself and then by its shape."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

from skybake.errors import InputError
from skybake.projection import find_projection
from skybake.projection.chart import Canvas, Projection, whole
from skybake.projection.cubemap import FACES, Cubemap, FaceChart, parse_face_names
from skybake.projection.equirect import Equirect

# Values of OpenEXR's `envmap`, as OpenImageIO has them under `textureformat`.
_LATLONG, _CUBE = "LatLong Environment", "CubeFace Environment"

_EDGES = {"cross": 4, "vertical-cross": 3, "row": 6}
"""How many edges of its faces a cubemap is wide, if more than one."""

_ANGLES = {
    "fov_deg": "fov",
    "look_azimuth_deg": "azimuth",
    "look_elevation_deg": "elevation",
    "roll_deg": "roll",
}


def file_recipe(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the recipe that a file of ours holds, and nothing for another."""
    try:
        recipe = json.loads(attributes.get("skybake:recipe", ""))
    except (TypeError, ValueError, RecursionError):
        return {}
    return recipe if isinstance(recipe, dict) else {}


def file_rotation(attributes: Mapping[str, Any]) -> float:
    """Return the bearing that the -Z of a file's map looks to, 0 if the file does not say. [rad]"""
    shown = file_recipe(attributes).get("map")
    turn = shown.get("rotate_deg") if isinstance(shown, dict) else None
    if isinstance(turn, int | float) and math.isfinite(turn):
        return math.radians(turn)
    return 0.0


def file_canvas(attributes: Mapping[str, Any], name: str, width: int, height: int) -> Canvas | None:
    """Return where the pixels of a file look, or None if that is not known.

    Parameters
    ----------
    attributes : mapping
        Of the file. Its recipe comes first, then OpenEXR's `envmap`, and last the shape: 2:1 is an
        equirect map, 4:3 a horizontal and 3:4 a vertical cross, 6:1 a row and 1:6 a column of
        faces.
    name : str
        The file's name without its suffix, whose end says which face of a cube it is.
    width, height : int
        Size of the picture, which may be a smaller one of the same map. [pixel]
    """
    shown = file_recipe(attributes).get("map")
    if isinstance(shown, dict) and "projection" in shown:
        return _by_recipe(shown, name, width, height)
    return _canvas(_by_shape(attributes.get("textureformat"), width, height), width, height)


def file_projection(attributes: Mapping[str, Any], width: int, height: int) -> Projection | None:
    """Return the projection of the map that a file belongs to, or None if that is not known.

    Parameters are those of `file_canvas`. Of six files each has the edge of all.
    """
    shown = file_recipe(attributes).get("map")
    if not isinstance(shown, dict) or "projection" not in shown:
        return sized(_by_shape(attributes.get("textureformat"), width, height), width, height)
    if shown.get("cube_layout") == "faces" and width != height:
        return None
    return sized(_recipe_projection(shown), width, height)


def _by_recipe(shown: Mapping[str, Any], name: str, width: int, height: int) -> Canvas | None:
    if shown.get("cube_layout") == "faces":
        return _face(shown, name, width) if width == height else None
    return _canvas(_recipe_projection(shown), width, height)


def _recipe_projection(shown: Mapping[str, Any]) -> Projection | None:
    try:
        options: dict[str, Any] = {
            own: math.radians(shown[key]) for key, own in _ANGLES.items() if key in shown
        }
        if shown.get("cube_layout") is not None:
            options["layout"] = shown["cube_layout"]
        if "cube_space" in shown:
            options["space"] = shown["cube_space"]
        if "equirect_rows" in shown:
            options["rows"] = shown["equirect_rows"]
        if "lens_shift" in shown:
            right, up = shown["lens_shift"]
            options["shift"] = float(right), float(up)
        return find_projection(shown["projection"], None, options)
    except (InputError, TypeError, ValueError, OverflowError):
        return None


def _face(shown: Mapping[str, Any], name: str, edge: int) -> Canvas | None:
    """Return where one of six files looks, which its name says at its end or between signs."""
    try:
        names = parse_face_names(shown.get("face_names", FACES[0]))
        ending = [one for one in names if name.endswith(one)]
        apart = [one for one in names if re.search(rf"(^|\W|_){re.escape(one)}(\W|_|$)", name)]
        # Of right and bright the longer one.
        found = max(ending or apart[:1], key=len)
        chart = FaceChart(FACES[names.index(found)], edge, shown.get("cube_space", "world"))
    except (InputError, AttributeError, KeyError, TypeError, ValueError):
        return None
    return whole(chart, found)


def _by_shape(envmap: Any, width: int, height: int) -> Projection | None:
    if envmap not in {None, _LATLONG, _CUBE}:
        return None
    if height == 6 * width and envmap != _LATLONG:
        return Cubemap(layout="column" if envmap is None else "exr")
    if width == 2 * height and envmap != _CUBE:
        return Equirect()
    layouts = {(4, 3): "cross", (3, 4): "vertical-cross", (6, 1): "row"}
    for (across, down), layout in layouts.items():
        if down * width == across * height and envmap is None:
            return Cubemap(layout=layout)
    return None


def sized(projection: Projection | None, width: int, height: int) -> Projection | None:
    """Return a projection whose pictures have some size, or None if it has none of that shape."""
    if projection is None:
        return None
    edge = width // _EDGES.get(getattr(projection, "layout", ""), 1)
    sizes = {"width": width, "height": height, "edge": edge}
    known = {one.name for one in fields(projection)}  # type: ignore[arg-type]
    sizes = {key: value for key, value in sizes.items() if key in known}
    try:
        found: Projection = replace(projection, **sizes)  # type: ignore[type-var]
    except InputError:
        return None
    shapes = {(canvas.width, canvas.height) for canvas in found.canvases()}
    return found if shapes == {(width, height)} else None


def _canvas(projection: Projection | None, width: int, height: int) -> Canvas | None:
    """Return the layout of a picture of some size, if a projection has a single one of it."""
    found = sized(projection, width, height)
    canvases = () if found is None else found.canvases()
    return canvases[0] if len(canvases) == 1 else None
