"""From pixels to directions and back; without physics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from skybake.errors import InputError
from skybake.projection.angular import Angular
from skybake.projection.chart import Projection
from skybake.projection.cubemap import Cubemap
from skybake.projection.equirect import Equirect
from skybake.projection.fisheye import Fisheye
from skybake.projection.octahedral import Octahedral
from skybake.projection.perspective import Perspective

__all__ = [
    "PROJECTIONS",
    "Angular",
    "Cubemap",
    "Equirect",
    "Fisheye",
    "Octahedral",
    "Perspective",
    "Projection",
    "find_projection",
]

PROJECTIONS: dict[str, type[Projection]] = {
    kind.name: kind for kind in (Equirect, Cubemap, Fisheye, Perspective, Angular, Octahedral)
}


def find_projection(
    name: str, size: tuple[int, ...] | None = None, options: Mapping[str, Any] | None = None
) -> Projection:
    """Make a projection by its name.

    Parameters
    ----------
    name : str
        A key of `PROJECTIONS`.
    size : tuple of int, optional
        Width and height, or a single number. [pixel]
    options : mapping, optional
        Other attributes of the projection.

    Raises
    ------
    InputError
        If there is none of that name, it has no such attribute or shape, or a value is out
        of its range.
    """
    if name not in PROJECTIONS:
        raise InputError(f"projection: must be one of {', '.join(PROJECTIONS)}, got {name!r}")
    kind, options = PROJECTIONS[name], options or {}
    known = {one.name for one in fields(kind)}  # type: ignore[arg-type]
    unknown = sorted(options.keys() - known)
    if unknown:
        raise InputError(
            f"{', '.join(unknown)}: a map of the projection {name} has {', '.join(sorted(known))}"
        )
    return kind.of_size(size, options)
