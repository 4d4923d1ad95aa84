"""Light from all around, as pixels and what is known of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.colour.space import ColourSpace
from skybake.projection.chart import Canvas, Chart, Projection

Pixels = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Environment:
    """A map of the light that arrives from every direction, or from some of them.

    Attributes
    ----------
    pixels : tuple of ndarray of float32, shape (row, column, 3)
        One picture for each canvas of the projection, linear and scene-referred.
    projection : Projection
        Where pixels look.
    rotation : float
        Compass bearing that the map's -Z looks to instead of north. [rad]
    space : ColourSpace or None
        Of the pixels, if it is known.
    white_luminance : float or None
        Luminance that RGB (1, 1, 1) stands for, if it is known. [cd m⁻²]
    attributes : mapping
        Of the file, as they were read.
    warnings : tuple of str
        What to know of the pixels, a line each.
    """

    pixels: tuple[Pixels, ...]
    projection: Projection
    rotation: float = 0.0
    space: ColourSpace | None = None
    white_luminance: float | None = None
    attributes: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()


def charts_of(
    projection: Projection, pictures: tuple[Pixels, ...]
) -> Iterator[tuple[Chart, Pixels]]:
    """Yield the charts of a map, each with its own pixels, the right way round."""
    for canvas, picture in zip(projection.canvases(), pictures, strict=True):
        yield from charts_on(canvas, picture)


def charts_on(canvas: Canvas, picture: Pixels) -> Iterator[tuple[Chart, Pixels]]:
    """Yield the charts of a picture, each with its own pixels, the right way round."""
    for part in canvas.parts:
        rows = slice(part.row, part.row + part.chart.height)
        here = picture[rows, part.column : part.column + part.chart.width]
        if part.flip in {"rows", "both"}:
            here = here[::-1]
        if part.flip in {"columns", "both"}:
            here = here[:, ::-1]
        yield part.chart, here


def flat_pixels(pictures: tuple[Pixels, ...]) -> Pixels:
    """Return all pixels of a map in one array, shape (pixel, 3)."""
    rows = [np.ascontiguousarray(picture, np.float32).reshape(-1, 3) for picture in pictures]
    return rows[0] if len(rows) == 1 else np.concatenate(rows)
