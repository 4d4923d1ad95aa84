"""A sequence as an animated picture. Needs Pillow, the extra ``skybake[animate]``."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.formats.targets import check_target, write_error
from skybake.formats.whole_files import replace_when_whole

if TYPE_CHECKING:
    from PIL.Image import Image

Picture = npt.NDArray[np.uint8]

STILL_WIDTH = 512
"""Width of the thumbnails of an animated picture. [pixel]"""


class _Kind(NamedTuple):
    tick: int  # ms that a frame's duration is a multiple of
    fastest: float  # frames per second that players keep up with


_KINDS = {".webp": _Kind(1, 60.0), ".gif": _Kind(10, 50.0)}
_SLOWEST = 0.1

_PALETTE = 256
_SURVEY = 400_000
"""Pixels, of all frames, that a palette is chosen from."""

# Ranks of a 2x2 ordered dither, by row and column.
_RANKS = np.array([[0, 2], [3, 1]])
_REC709 = np.array([0.2126, 0.7152, 0.0722])


def check_animation(path: Path, fps: float) -> None:
    """Raise the errors of an animated picture that can be found before anything is computed.

    Raises
    ------
    InputError
        If the suffix is not ``.webp`` or ``.gif``, the format cannot
        hold the speed, or Pillow is absent.
    OutputError
        If a file cannot be written under that name.
    """
    kind = _KINDS.get(path.suffix.lower())
    if kind is None:
        raise InputError(
            f"{path}: suffix of an animated picture must be one of {', '.join(_KINDS)}, "
            f"got {path.suffix!r}"
        )
    if not _SLOWEST <= fps <= kind.fastest:
        raise InputError(
            f"{path}: frames per second must be from {_SLOWEST:g} to {kind.fastest:g}, got {fps:g}"
        )
    if find_spec("PIL") is None:
        raise InputError(f"{path}: needs Pillow; try pip install Pillow")
    check_target(path)


def write_animation(path: Path, thumbnails: Sequence[Picture], fps: float) -> None:
    """Write an animated picture that loops.

    Parameters
    ----------
    path : Path
        ``.webp``, or ``.gif`` with one palette for all frames and a dither that
        stays fixed.
    thumbnails : sequence of ndarray of uint8, shape (row, column, 3)
        At least one, code values of sRGB, all of one shape.
    fps : float
        Frames per second.

    Raises
    ------
    InputError, OutputError
        As `check_animation`, or if the file cannot be written.
    """
    check_animation(path, fps)
    kind = _KINDS[path.suffix.lower()]
    if kind is _KINDS[".gif"]:
        palette = _common_palette(thumbnails)
        first, *others = [_dithered(thumbnail, palette) for thumbnail in thumbnails]
    else:
        first, others = _film(thumbnails), []
    with replace_when_whole(path) as temporary:
        try:
            first.save(
                temporary,
                save_all=True,
                append_images=others,
                duration=_durations(len(thumbnails), fps, kind.tick),
                loop=0,
                quality=90,
            )
        except RuntimeError as error:
            raise write_error(path, temporary, str(error)) from error


def _film(thumbnails: Sequence[Picture]) -> Image:
    """Return a picture of many frames, of which one is in memory."""
    from PIL import Image

    class Film(Image.Image):
        """Frames as Pillow's writers ask for those of a file."""

        def __init__(self) -> None:
            super().__init__()
            self.n_frames = len(thumbnails)
            self.seek(0)

        def seek(self, frame: int) -> None:
            """Select a frame."""
            still = Image.fromarray(thumbnails[frame])
            self.im, self._mode, self._size = still.im, still.mode, still.size
            self._frame = frame

        def tell(self) -> int:
            """Return which frame it is at."""
            return self._frame

    return Film()


def _durations(count: int, fps: float, tick: int) -> list[int]:
    """Duration of each frame, such that rounding errors do not accumulate. [ms]"""
    ends = [tick * round(1000.0 * frame / fps / tick) for frame in range(count + 1)]
    return [after - before for before, after in pairwise(ends)]


def _common_palette(thumbnails: Sequence[Picture]) -> Image:
    from PIL import Image

    step = max(1, len(thumbnails) * thumbnails[0].size // 3 // _SURVEY)
    pixels = np.concatenate([thumbnail.reshape(-1, 3)[::step] for thumbnail in thumbnails])
    survey = Image.fromarray(np.ascontiguousarray(pixels[None]))
    return survey.quantize(_PALETTE, method=Image.Quantize.MEDIANCUT)


def _dithered(thumbnail: Picture, palette: Image) -> Image:
    """Map to a palette by an ordered dither, so that no pixel depends on its neighbours.

    Diffusing errors would change the grain of the whole picture with each frame. For
    every pixel, as many colours are found as the pattern has ranks, whose mean is
    closest to it, and the pattern selects which of them, from dark to light, is taken
    (Knoll, US patent 6606166, expired).
    """
    from PIL import Image

    colours = np.array(palette.getpalette(), np.float32).reshape(-1, 3)
    error = np.zeros(thumbnail.shape, np.float32)
    found = []
    for _ in range(_RANKS.size):
        wanted = np.clip(thumbnail + error, 0.0, 255.0).astype(np.uint8)
        nearest = Image.fromarray(wanted).quantize(palette=palette, dither=Image.Dither.NONE)
        found.append(np.asarray(nearest))
        error += thumbnail - colours[found[-1]]
    candidates = np.stack(found)
    by_luma = np.argsort((colours @ _REC709)[candidates], axis=0, kind="stable")
    rows, columns = np.indices(thumbnail.shape[:2])
    rank = _RANKS[rows % 2, columns % 2][None]
    taken = np.take_along_axis(candidates, np.take_along_axis(by_luma, rank, 0), 0)[0]
    picture = Image.fromarray(taken)
    picture.putpalette(palette.getpalette() or [])
    return picture
