"""All frames of a sequence side by side in one picture."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.formats.lettering import draw_text, text_width
from skybake.formats.preview import write_picture
from skybake.formats.targets import check_target

Picture = npt.NDArray[np.uint8]

TILE_WIDTH = 256
"""Width of the thumbnails of a sheet. [pixel]"""

BACKGROUND = 24
"""Code value around the tiles: dark, so that it does not affect the impression of skies."""

_INK = (0.85, 0.85, 0.85)
_SHAPE = 16.0 / 9.0
_SMALLEST_LETTERS = 8
_LARGEST_LETTERS = 24
_LINE_SPACING = 1.4


def check_sheet(path: Path) -> None:
    """Raise the errors of a contact sheet that can be found before anything is computed.

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
        One for each, below its tile, of equally many lines; letters become smaller where a line is
        wider than its tile.
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
    size = _letters((line for label in labels for line in label.split("\n")), width)
    rows = math.ceil(len(thumbnails) / columns)
    total = columns * width + (columns - 1) * gap
    heading = _strip(title, total, _letters([title], total, 1.5))
    lines = 1 + labels[0].count("\n")
    tile_height = height + lines * _strip_height(size)

    def bands() -> Iterator[Picture]:
        yield _margins(heading, gap, above=gap)
        for row in range(rows):
            here = range(row * columns, min((row + 1) * columns, len(thumbnails)))
            tiles = [_tile(thumbnails[i], labels[i], size) for i in here]
            tiles += [np.full_like(tiles[0], BACKGROUND)] * (columns - len(tiles))
            yield _margins(_joined(tiles, gap), gap, above=gap if row else 0)
        yield np.full((gap, total + 2 * gap, 3), BACKGROUND, np.uint8)

    sheet_height = gap + len(heading) + rows * tile_height + (rows - 1) * gap + gap
    write_picture(path, total + 2 * gap, sheet_height, bands())


def _columns(count: int, aspect: float) -> int:
    """Columns at which the tiles come closest to a sheet of `_SHAPE`."""

    def misfit(columns: int) -> float:
        return abs(math.log(aspect * columns / math.ceil(count / columns) / _SHAPE))

    return min(range(1, count + 1), key=misfit)


def _letters(texts: Iterable[str], width: int, larger: float = 1.0) -> int:
    """Size of letters in which the longest of some texts fits into a width. [pixel]"""
    wanted = round(min(max(width / 14.0, _SMALLEST_LETTERS), _LARGEST_LETTERS) * larger)
    widest = max(text_width(text, wanted) for text in texts)
    return max(_SMALLEST_LETTERS, min(wanted, int(wanted * width / max(widest, 1))))


def _tile(thumbnail: Picture, label: str, size: int) -> Picture:
    """Return a thumbnail with the lines of its label below."""
    width = thumbnail.shape[1]
    return np.vstack([thumbnail, *(_strip(line, width, size) for line in label.split("\n"))])


def _strip_height(size: int) -> int:
    return math.ceil(size * _LINE_SPACING)


def _strip(text: str, width: int, size: int) -> Picture:
    """Return a line of text in a picture of a width."""
    strip = np.full((_strip_height(size), width, 3), BACKGROUND, np.uint8)
    draw_text(strip, text, 0, round(size * 1.1), size, _INK)
    return strip


def _joined(pictures: Sequence[Picture], gap: int) -> Picture:
    """Return pictures in a row with gaps between."""
    between = np.full((len(pictures[0]), gap, 3), BACKGROUND, np.uint8)
    parts = [part for picture in pictures for part in (between, picture)]
    return np.concatenate(parts[1:], axis=1)


def _margins(picture: Picture, gap: int, above: int) -> Picture:
    edges = ((above, 0), (gap, gap), (0, 0))
    return np.pad(picture, edges, constant_values=BACKGROUND)
