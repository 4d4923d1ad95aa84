"""All frames of a sequence side by side in one picture."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.formats.lettering import draw_text, text_width
from skybake.formats.preview import write_picture
from skybake.formats.targets import check_target

Picture = npt.NDArray[np.uint8]

TILE_WIDTH = 256
"""Of the thumbnails that suit a sheet. [pixel]"""

BACKGROUND = 24
"""Code value around the tiles: dark, so that skies are judged by themselves."""

_INK = (0.85, 0.85, 0.85)
_SHAPE = 16.0 / 9.0
_SMALLEST_LETTERS = 8
_LARGEST_LETTERS = 24
_LINE_SPACING = 1.4


def check_sheet(path: Path) -> None:
    """Raise what can be said of a contact sheet before anything is computed.

    Raises
    ------
    InputError
        If the suffix is not ``.png``.
    OutputError
        If a file cannot be written under that name.
    """
    if path.suffix.lower() != ".png":
        raise InputError(f"{path}: suffix of a contact sheet must be .png, got {path.suffix!r}")
    check_target(path)


def contact_sheet(
    path: Path,
    thumbnails: Sequence[Picture],
    labels: Sequence[str],
    *,
    title: str,
) -> None:
    """Write a picture of about 16:9 with a tile for each frame, and a title above all.

    Parameters
    ----------
    path : Path
        ``.png``.
    thumbnails : sequence of ndarray of uint8, shape (row, column, 3)
        At least one, code values of sRGB, all of one shape.
    labels : sequence of str
        One for each, below its tile; letters become smaller where a label is wider than its tile.
    title : str
        One line.

    Raises
    ------
    InputError
        If the suffix is not ``.png``.
    OutputError
        If the file cannot be written.
    """
    check_sheet(path)
    height, width = thumbnails[0].shape[:2]
    columns = _columns(len(thumbnails), width / height)
    gap = max(2, width // 32)
    tiles = [
        np.vstack([thumbnail, strip])
        for thumbnail, strip in zip(thumbnails, _strips(labels, width), strict=True)
    ]
    empty = np.full_like(tiles[0], BACKGROUND)
    tiles += [empty] * (-len(tiles) % columns)
    rows = [
        _joined(tiles[first : first + columns], gap, axis=1)
        for first in range(0, len(tiles), columns)
    ]
    sheet = _joined(rows, gap, axis=0)
    (heading,) = _strips([title], sheet.shape[1], 1.5)
    write_picture(path, _framed(np.vstack([heading, sheet]), gap))


def _columns(count: int, aspect: float) -> int:
    """Columns at which the tiles come closest to a sheet of `_SHAPE`."""

    def misfit(columns: int) -> float:
        return abs(math.log(aspect * columns / math.ceil(count / columns) / _SHAPE))

    return min(range(1, count + 1), key=misfit)


def _strips(texts: Iterable[str], width: int, larger: float = 1.0) -> list[Picture]:
    """Lines of text of one size, each in a picture of a width."""
    texts = list(texts)
    wanted = round(min(max(width / 14.0, _SMALLEST_LETTERS), _LARGEST_LETTERS) * larger)
    widest = max(text_width(text, wanted) for text in texts)
    size = max(_SMALLEST_LETTERS, min(wanted, int(wanted * width / max(widest, 1))))
    strips = []
    for text in texts:
        strip = np.full((math.ceil(size * _LINE_SPACING), width, 3), BACKGROUND, np.uint8)
        draw_text(strip, text, 0, round(size * 1.1), size, _INK)
        strips.append(strip)
    return strips


def _joined(pictures: Sequence[Picture], gap: int, axis: int) -> Picture:
    """Pictures in a row or a column with gaps between."""
    shape = list(pictures[0].shape)
    shape[axis] = gap
    between = np.full(shape, BACKGROUND, np.uint8)
    parts = [part for picture in pictures for part in (between, picture)]
    return np.concatenate(parts[1:], axis=axis)


def _framed(picture: Picture, gap: int) -> Picture:
    edges = ((gap, gap), (gap, gap), (0, 0))
    return np.pad(picture, edges, constant_values=BACKGROUND)
