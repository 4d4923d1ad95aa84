"""Display-referred pictures of maps, exposed by the light that they hold."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.colour.exposure import auto_ev, luminance_from_ev
from skybake.colour.space import ColourSpace, colour_space_from_tags, luminance_weights
from skybake.formats.preview import check_preview, write_preview
from skybake.formats.reader import read_image
from skybake.projection import cubemap, equirect

SURVEY_ROWS = 256
"""Rows of an equirect map that an exposure is chosen from; of larger ones texels are left out."""

SURVEY_EDGE = 128

# A file that does not say what its values mean is shown as if 1.0 were EV 15's white.
UNKNOWN_WHITE = luminance_from_ev(15.0)


def legible_ev(
    pixels: npt.NDArray[np.float32], space: ColourSpace, white_luminance: float
) -> float:
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
    weights = luminance_weights(space) * white_luminance
    rows, columns = pixels.shape[:2]
    faces = _faces(pixels)
    if faces:
        step = max(1, len(faces["px"]) // SURVEY_EDGE)
        sample = np.stack([_every(step, face) for face in faces.values()])
        edge = sample.shape[1]
        above = [cubemap.face_directions(face, edge)[..., 1] > 0.0 for face in faces]
        return auto_ev(_luminance(sample, weights), cubemap.solid_angles(edge), np.stack(above))
    sample = _every(max(1, rows // SURVEY_ROWS), pixels)
    if columns != 2 * rows:
        return auto_ev(_luminance(sample, weights))
    zenith = equirect.row_zeniths(len(sample))[:, None]
    # A map of one row has its middle on the horizon.
    return auto_ev(_luminance(sample, weights), np.sin(zenith), zenith <= np.pi / 2.0)


def _faces(pixels: npt.NDArray[np.float32]) -> dict[str, npt.NDArray[np.float32]]:
    """Return the faces of a cubemap in one picture by name; none of another picture."""
    rows, columns = pixels.shape[:2]
    if 4 * rows == 3 * columns and columns % 4 == 0:
        edge = columns // 4
        return {
            face: pixels[row * edge : (row + 1) * edge, column * edge : (column + 1) * edge]
            for face, (row, column) in cubemap.CROSS_ORIGINS.items()
        }
    if rows == 6 * columns:
        faces = pixels.reshape(6, columns, columns, 3)
        # Mirrored twice, a face is as it was.
        return {
            name: cubemap.openexr_face(name, face).astype(np.float32, copy=False)
            for name, face in zip(cubemap.FACES, faces, strict=True)
        }
    return {}


def _every(step: int, pixels: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    return pixels[step // 2 :: step, step // 2 :: step]


def _luminance(
    pixels: npt.NDArray[np.float32], weights: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]:
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
    pixels, attributes = read_image(source)
    chromaticities: Any = attributes.get("chromaticities")
    space = colour_space_from_tags(str(source), attributes.get("colorInteropID"), chromaticities)
    white = float(attributes.get("whiteLuminance", UNKNOWN_WHITE))
    if ev is None:
        ev = legible_ev(pixels, space, white)
    write_preview(path, pixels, space, gain=white / luminance_from_ev(ev), view=view)
    return ev
