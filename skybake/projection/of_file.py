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

_EDGES = {"cross": 4, "vertical-cross": 3}
"""How many edges of its faces a cubemap is wide, if more than one."""

_ANGLES = {
    "fov_deg": "fov",
    "look_azimuth_deg": "azimuth",
    "look_elevation_deg": "elevation",
}


def file_recipe(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the recipe that a file of ours holds, and nothing for another."""
    try:
        recipe = json.loads(attributes.get("skybake:recipe", ""))
    except (TypeError, ValueError, RecursionError):
        return {}
    return recipe if isinstance(recipe, dict) else {}


def file_canvas(attributes: Mapping[str, Any], name: str, width: int, height: int) -> Canvas | None:
    """Return where the pixels of a file look, or None if that is not known.

    Parameters
    ----------
    attributes : mapping
        Of the file. Its recipe comes first, then OpenEXR's `envmap`, and last the shape: 2:1 is an
        equirect map, 4:3 a horizontal cross, and 1:6 a column of OpenEXR's faces.
    name : str
        The file's name without its suffix, whose end says which face of a cube it is.
    width, height : int
        Size of the picture, which may be a smaller one of the same map. [pixel]
    """
    shown = file_recipe(attributes).get("map")
    if isinstance(shown, dict) and "projection" in shown:
        return _by_recipe(shown, name, width, height)
    return _canvas(_by_shape(attributes.get("textureformat"), width, height), width, height)


def _by_recipe(shown: Mapping[str, Any], name: str, width: int, height: int) -> Canvas | None:
    if shown.get("cube_layout") == "faces":
        return _face(shown, name, width) if width == height else None
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
        projection = find_projection(shown["projection"], None, options)
    except (InputError, TypeError, ValueError, OverflowError):
        return None
    return _canvas(projection, width, height)


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
    if width == 2 * height and envmap in {None, _LATLONG}:
        return Equirect()
    if height == 6 * width and envmap in {None, _CUBE}:
        return Cubemap(layout="exr")
    if 4 * height == 3 * width and envmap is None:
        return Cubemap(layout="cross")
    return None


def _canvas(projection: Projection | None, width: int, height: int) -> Canvas | None:
    """Return the layout of a picture of some size, if a projection has one of that shape."""
    if projection is None:
        return None
    edge = width // _EDGES.get(getattr(projection, "layout", ""), 1)
    sizes = {"width": width, "height": height, "edge": edge}
    known = {one.name for one in fields(projection)}  # type: ignore[arg-type]
    sizes = {key: value for key, value in sizes.items() if key in known}
    try:
        (canvas,) = replace(projection, **sizes).canvases()  # type: ignore[type-var]
    except InputError:
        return None
    return canvas if (canvas.width, canvas.height) == (width, height) else None
