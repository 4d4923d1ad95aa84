"""Smaller and smaller copies of a map, each with the light of the whole."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from skybake.errors import InputError
from skybake.image.layers import Pixels
from skybake.projection import Cubemap, Equirect, Projection
from skybake.projection.chart import Chart


def check_mips(path: Path, projection: Projection) -> None:
    """Refuse maps that have no smaller copies.

    Raises
    ------
    InputError
        Unless the map is an equirect map or a cubemap of single faces, with edges that are powers
        of two, in a format with levels.
    """
    if path.suffix.lower() == ".hdr":
        raise InputError(f"{path}: mips must be in .exr, .ktx2 or .dds")
    is_equirect = isinstance(projection, Equirect) and projection.rows == "centres"
    is_cube = isinstance(projection, Cubemap) and projection.layout == "faces"
    if not is_equirect and not is_cube:
        raise InputError(
            f"{path}: mips must be of an equirect map with centred rows or of a cubemap in faces, "
            f"got {projection.label}"
        )
    width = projection.canvases()[0].width
    if width & (width - 1):
        raise InputError(f"{path}: mips must be of a size that is a power of two, got {width}")


def mip_levels(pixels: Pixels, projection: Projection, number: int = 0) -> list[Pixels]:
    """Return a picture of a map and its smaller copies down to one pixel.

    Each texel is the mean of four of the next larger copy, weighted by solid angle, so that all
    copies of a map hold the same light, whose sum over solid angles is kept.

    Parameters
    ----------
    pixels : ndarray of float32, shape (row, column, 3)
        The picture.
    projection : Equirect or Cubemap
        Whose it is, of a size that is a power of two.
    number : int, optional
        Which of the projection's pictures.

    Returns
    -------
    list of ndarray
        The largest first.
    """
    levels = [pixels]
    while levels[-1].shape[0] > 1:
        width = levels[-1].shape[1]
        sizes = {"edge": width} if isinstance(projection, Cubemap) else {"width": width}
        canvas = replace(projection, **sizes).canvases()[number]  # type: ignore[type-var]
        levels.append(_halved(levels[-1], canvas.parts[0].chart))
    if levels[-1].shape[1] > 1:
        # The two halves of an equirect map are of one size.
        levels.append(levels[-1].mean(axis=1, keepdims=True))
    return levels


def _halved(pixels: Pixels, chart: Chart) -> Pixels:
    sizes = np.asarray(chart.solid_angles(0, chart.height), np.float32)
    sizes = np.broadcast_to(sizes, pixels.shape[:2])[..., None]
    corners = [(slice(row, None, 2), slice(column, None, 2)) for row in (0, 1) for column in (0, 1)]
    total = sum(sizes[corner] for corner in corners)
    out = np.zeros((pixels.shape[0] // 2, pixels.shape[1] // 2, 3), np.float32)
    for corner in corners:
        out += pixels[corner] * (sizes[corner] / total)
    return out
