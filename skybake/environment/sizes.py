"""Sizes at which maps of different projections show about as much."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from skybake.projection import find_projection
from skybake.projection.chart import Projection
from skybake.projection.cubemap import Cubemap
from skybake.projection.fisheye import Fisheye
from skybake.projection.octahedral import Octahedral
from skybake.projection.perspective import Perspective

_SMALLEST = 4


def find_similar(
    name: str, size: tuple[int, ...] | None, options: Mapping[str, Any], old: Projection
) -> Projection:
    """Make a projection by its name, by default as finely divided as another.

    Parameters
    ----------
    name, size, options
        As of `skybake.projection.find_projection`.
    old : Projection
        The other one. If it has this name, the new one has all that is not given of it.

    Raises
    ------
    InputError
        As `skybake.projection.find_projection`.
    """
    if name == old.name:
        options = {**_options(old), **options}
        size = _size(old) if size is None else size
    if size is None and name != Perspective.name:
        size = (max(_SMALLEST, round(_around(old) * _share(name, options) / 2.0) * 2),)
    return find_projection(name, size, options)


def _options(projection: Projection) -> dict[str, Any]:
    return {
        key: value
        for key, value in vars(projection).items()
        if key not in {"width", "height", "edge"}
    }


def _size(projection: Projection) -> tuple[int, ...]:
    if isinstance(projection, Perspective):
        return projection.width, projection.height
    return (getattr(projection, "width", 0) or getattr(projection, "edge", 0),)


def _around(projection: Projection) -> float:
    """Pixels of a projection to a full circle."""
    (size, *_) = _size(projection)
    return size / _share(projection.name, vars(projection))


def _share(name: str, options: Mapping[str, Any]) -> float:
    """Share of a full circle that the width of a picture, or a face, covers."""
    if name == Cubemap.name:
        return 0.25
    if name == Octahedral.name:
        return 0.5
    if name in {Fisheye.name, Perspective.name}:
        kind = Fisheye if name == Fisheye.name else Perspective
        return float(options.get("fov", kind.fov)) / (2.0 * math.pi)
    return 1.0
