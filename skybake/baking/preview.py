"""Display-referred pictures of maps, exposed by the light that they hold."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.colour.exposure import auto_ev, luminance_from_ev
from skybake.colour.space import ColourSpace, colour_space_from_tags, luminance_weights
from skybake.formats.preview import write_preview
from skybake.formats.reader import read_image

# A file that does not say what its values mean is shown as if 1.0 were EV 15's white.
UNKNOWN_WHITE = luminance_from_ev(15.0)


def preview_pixels(
    path: Path,
    pixels: npt.NDArray[np.float32],
    space: ColourSpace,
    white_luminance: float,
    *,
    ev: float | None = None,
    view: str = "aces2",
) -> float:
    """Write a picture of pixels and return the exposure value that it was taken with.

    Parameters
    ----------
    path : Path
        ``.png``.
    pixels : ndarray of float32, shape (row, column, 3)
        Scene-linear.
    space : ColourSpace
        Their space.
    white_luminance : float
        Luminance that RGB (1, 1, 1) stands for. [cd m⁻²]
    ev : float, optional
        Exposure value at ISO 100; by default such that the sky is legible.
    view : {"aces2", "aces1"}, optional
        Display transform.
    """
    if ev is None:
        luminance = np.maximum(pixels @ luminance_weights(space), 0.0) * white_luminance
        ev = auto_ev(luminance)
    write_preview(path, pixels, space, gain=white_luminance / luminance_from_ev(ev), view=view)
    return ev


def preview_file(
    source: Path, path: Path, *, ev: float | None = None, view: str = "aces2"
) -> float:
    """Write a picture of an image file and return its exposure value.

    Raises
    ------
    InputError
        If the file is no image, or its tags name a space that is not known.
    OutputError
        If the picture cannot be written.
    """
    pixels, attributes = read_image(source)
    chromaticities: Any = attributes.get("chromaticities")
    space = colour_space_from_tags(str(source), attributes.get("colorInteropID"), chromaticities)
    white = float(attributes.get("whiteLuminance", UNKNOWN_WHITE))
    return preview_pixels(path, pixels, space, white, ev=ev, view=view)
