"""Pictures as the page gets them: a header in JSON, then half floats."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from skybake.image.image import BAND_ROWS
from skybake.image.layers import Pixels
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.projection import Equirect, Projection

COARSE_WIDTH = 256
LARGEST_HALF = 65504.0
LARGEST_WIDTH = 4096
"""Of an equirect picture: four times as many texels do not fit the memory of many tablets."""


def message(header: Mapping[str, Any], texels: bytes) -> bytes:
    """Return a binary message: length of the header, header, texels.

    The length is little-endian, of 4 bytes. Blanks after the header let texels begin at a
    multiple of 4.
    """
    text = json.dumps(header, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    return len(text).to_bytes(4, "little") + text + texels


def halves(pixels: Pixels) -> tuple[bytes, float]:
    """Return half floats, and the power of two that pixels were divided by.

    The brightest value becomes 2^14 to 2^15, which leaves night beside the stars, and day beside
    the sun's disc, their eleven bits.
    """
    peak = float(np.abs(pixels).max(initial=0.0))
    scale = 2.0 ** (math.frexp(peak)[1] - 15) if peak > 0.0 else 1.0
    return (pixels / np.float32(scale)).astype("<f2").tobytes(), scale


def coarse(projection: Projection) -> Projection | None:
    """Return the projection of a coarse picture, or None where the full one is no larger."""
    if isinstance(projection, Equirect) and projection.width > COARSE_WIDTH:
        return Equirect(COARSE_WIDTH)
    return None


def picture(scene: Scene, projection: Projection) -> Pixels:
    """Return the picture of a scene, shape (row, column, 3).

    Raises
    ------
    CancelledError
        If the scene's workers were stopped.
    """
    (canvas,) = projection.canvases()
    raster = Raster(scene, canvas)
    pixels = np.empty((canvas.height, canvas.width, 3), np.float32)
    for first in range(0, canvas.height, BAND_ROWS):
        scene.workers.check()
        last = min(first + BAND_ROWS, canvas.height)
        pixels[first:last] = raster.rows(first, last)
    return pixels
