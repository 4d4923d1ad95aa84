"""Text in pictures, in the font that comes with OpenImageIO."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import OpenImageIO

# By name, since another font would have another width.
_FONT = "DroidSans"
_ABSENT = str.maketrans({"\u2212": "-", "\u2013": "-", "\u2026": "..."})


def text_width(text: str, size: int) -> int:
    """Width of a line of text. [pixel]

    Parameters
    ----------
    text : str
        A character that the font lacks has no width.
    size : int
        Height of the letters. [pixel]
    """
    box = OpenImageIO.ImageBufAlgo.text_size(_drawable(text), size, _FONT)
    return int(box.width) if box.defined else 0


def draw_text(
    pixels: npt.NDArray[np.uint8],
    text: str,
    x: int,
    baseline: int,
    size: int,
    colour: tuple[float, float, float],
) -> None:
    """Draw a line of text into a picture.

    Parameters
    ----------
    pixels : ndarray of uint8, shape (row, column, 3)
        Written to; what falls outside is left out.
    text : str
        One line.
    x, baseline : int
        Column of the left edge, row of the baseline. [pixel]
    size : int
        Height of the letters. [pixel]
    colour : tuple of 3 float
        Code values from 0 to 1.
    """
    height, width = pixels.shape[:2]
    image = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(width, height, 3, "uint8"))
    image.set_pixels(image.roi, np.ascontiguousarray(pixels))
    if not OpenImageIO.ImageBufAlgo.render_text(
        image, x, baseline, _drawable(text), size, _FONT, colour
    ):
        raise RuntimeError(f"text must be drawn, got {image.geterror()}")
    pixels[...] = np.asarray(image.get_pixels(OpenImageIO.UINT8), np.uint8)


def _drawable(text: str) -> str:
    return text.translate(_ABSENT)
