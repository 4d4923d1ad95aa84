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

# A file that does not say what its values mean is shown as if 1.0 were EV 15's white.
UNKNOWN_WHITE = luminance_from_ev(15.0)


def legible_ev(
    pixels: npt.NDArray[np.float32], space: ColourSpace, white_luminance: float
) -> float:
    """Exposure value at which a map is legible, see `skybake.colour.exposure.auto_ev`.

    Parameters
    ----------
    pixels : ndarray of float32, shape (row, column, 3)
        Scene-linear.
    space : ColourSpace
        Their space.
    white_luminance : float
        Luminance that RGB (1, 1, 1) stands for. [cd m⁻²]
    """
    luminance = np.maximum(pixels @ luminance_weights(space), 0.0) * white_luminance
    return auto_ev(luminance)


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
