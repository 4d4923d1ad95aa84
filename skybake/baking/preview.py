"""Display-referred pictures of maps, exposed by the light that they hold."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.colour.exposure import auto_ev, luminance_from_ev
from skybake.colour.space import ColourSpace, colour_space_from_tags, luminance_weights
from skybake.errors import InputError
from skybake.formats.preview import check_preview, write_preview
from skybake.formats.reader import ImageFile
from skybake.formats.shrink import Shrinking
from skybake.projection import cubemap, equirect

Pixels = npt.NDArray[np.float32]

SURVEY_ROWS = 256
"""Rows of an equirect map that an exposure is chosen from; of larger ones texels are skipped."""

SURVEY_EDGE = 128

MAX_WIDTH = 1024
"""Largest width of pictures; larger maps are reduced. [pixel]"""

_CHROMATICITIES = 8

# From darker than any sensor sees to brighter than the surface of any star.
_DARKEST_WHITE = 1e-9
_BRIGHTEST_WHITE = 1e15

# A file that does not state its scale is shown as if 1.0 were the white of EV 15.
UNKNOWN_WHITE = luminance_from_ev(15.0)


def legible_ev(pixels: Pixels, space: ColourSpace, white_luminance: float) -> float:
    """Exposure value at which a map is legible, see `skybake.colour.exposure.auto_ev`.

    Parameters
    ----------
    pixels : ndarray of float32, shape (row, column, 3)
        Scene-linear. An equirect map by its shape of 1:2, a cross of 3:4, a column of
        OpenEXR's faces of 6:1; in any other picture each pixel counts the same.
    space : ColourSpace
        Their space.
    white_luminance : float
        Luminance that RGB (1, 1, 1) stands for. [cd m⁻²]
    """
    height, width = pixels.shape[:2]
    return _ev_of_survey(pixels[_survey_rows(width, height)], height, space, white_luminance)


def _survey_rows(width: int, height: int) -> npt.NDArray[np.int64]:
    """Rows of a picture that its exposure is chosen from, ascending."""
    edge = _edge(width, height)
    if not edge:
        return _steps(height, SURVEY_ROWS)
    upright = _steps(edge, SURVEY_EDGE)
    if height != 6 * width:
        return np.concatenate([origin * edge + upright for origin in range(height // edge)])
    upside_down = (edge - 1 - upright)[::-1]
    return np.concatenate(
        [
            i * edge + (upside_down if cubemap.openexr_flip(face) == "rows" else upright)
            for i, face in enumerate(cubemap.FACES)
        ]
    )


def _edge(width: int, height: int) -> int:
    """Edge of the faces of a cubemap in one picture; 0 of another picture."""
    if height == 6 * width:
        return width
    return width // 4 if 4 * height == 3 * width and width % 4 == 0 else 0


def _steps(count: int, wanted: int) -> npt.NDArray[np.int64]:
    """Return indices of some of many rows or columns, evenly spread."""
    step = max(1, count // wanted)
    return np.arange(step // 2, count, step)


def _ev_of_survey(rows: Pixels, height: int, space: ColourSpace, white_luminance: float) -> float:
    """Exposure value of a picture of a height, of which these are the `_survey_rows`."""
    weights = luminance_weights(space) * white_luminance
    width = rows.shape[1]
    edge = _edge(width, height)
    if edge:
        columns = _steps(edge, SURVEY_EDGE)
        faces = _faces(rows, edge, len(columns))
        sample = np.stack([face[:, columns] for face in faces.values()])
        small = sample.shape[1]
        above = [cubemap.face_directions(face, small)[..., 1] > 0.0 for face in faces]
        return auto_ev(_luminance(sample, weights), cubemap.solid_angles(small), np.stack(above))
    step = max(1, height // SURVEY_ROWS)
    sample = rows[:, step // 2 :: step]
    if width != 2 * height:
        return auto_ev(_luminance(sample, weights))
    zenith = equirect.row_zeniths(len(sample))[:, None]
    # A map of one row has its middle on the horizon.
    return auto_ev(_luminance(sample, weights), np.sin(zenith), zenith <= np.pi / 2.0)


def _faces(rows: Pixels, edge: int, count: int) -> dict[str, Pixels]:
    """Return the faces of a cubemap by name, equally many rows and all columns of each."""
    if rows.shape[1] == 4 * edge:
        return {
            face: rows[row * count : (row + 1) * count, column * edge : (column + 1) * edge]
            for face, (row, column) in cubemap.CROSS_ORIGINS.items()
        }
    # Mirroring is its own inverse.
    return {
        name: cubemap.openexr_face(name, face).astype(np.float32, copy=False)
        for name, face in zip(cubemap.FACES, rows.reshape(6, count, edge, 3), strict=True)
    }


def _luminance(pixels: Pixels, weights: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    luminance: npt.NDArray[np.float64] = np.maximum(pixels @ weights, 0.0)
    return luminance


def preview_file(
    source: Path, path: Path, *, ev: float | None = None, view: str = "aces2"
) -> float:
    """Write a picture of an image file and return its exposure value.

    Parameters
    ----------
    source : Path
        An EXR or Radiance picture.
    path : Path
        ``.png``.
    ev : float, optional
        Exposure value at ISO 100; by default one at which the sky is legible.
    view : {"aces2", "aces1"}, optional
        Display transform.

    Raises
    ------
    InputError
        If the file is no image, or its tags name a space that is not known.
    OutputError
        If the picture cannot be written.
    """
    check_preview(path, view)
    image = ImageFile(source)
    space, white = _scale(source, image.attributes)
    wanted = _survey_rows(image.width, image.height)
    survey: list[Pixels] = []
    picture = Shrinking(image.width, image.height, MAX_WIDTH)
    first = 0
    for rows in image.bands():
        here = (wanted >= first) & (wanted < first + len(rows))
        survey.append(rows[wanted[here] - first])
        picture.add(rows)
        first += len(rows)
    if ev is None:
        ev = _ev_of_survey(np.concatenate(survey), image.height, space, white)
    write_preview(path, picture.result(), space, gain=white / luminance_from_ev(ev), view=view)
    return ev


def _scale(source: Path, attributes: dict[str, Any]) -> tuple[ColourSpace, float]:
    """Return the space of a file's pixels, and the luminance of 1."""
    chromaticities = attributes.get("chromaticities")
    if chromaticities is not None:
        chromaticities = _numbers(f"{source}: chromaticities", chromaticities, _CHROMATICITIES)
    name = attributes.get("colorInteropID")
    space = colour_space_from_tags(str(source), None if name is None else str(name), chromaticities)
    where = f"{source}: whiteLuminance"
    (white,) = _numbers(where, attributes.get("whiteLuminance", UNKNOWN_WHITE), 1)
    if not _DARKEST_WHITE <= white <= _BRIGHTEST_WHITE:
        raise InputError(
            f"{where}: must be from {_DARKEST_WHITE:g} to {_BRIGHTEST_WHITE:g} cd/m2, got {white:g}"
        )
    return space, white


def _numbers(where: str, value: Any, count: int) -> tuple[float, ...]:
    values = value if isinstance(value, tuple) else (value,)
    is_right = len(values) == count and all(isinstance(one, int | float) for one in values)
    if not is_right or not all(math.isfinite(one) for one in values):
        kind = "a number" if count == 1 else f"{count} numbers"
        raise InputError(f"{where}: must be {kind}, got {' '.join(repr(value).split())}")
    return tuple(map(float, values))
