"""Whether half floats hold a map."""

from __future__ import annotations

from typing import Literal, cast

import numpy as np

from skybake.image.raster import Raster
from skybake.image.scene import Scene

HALF_LARGEST = 60000.0
HALF_SMALLEST = 2.0**-14

PixelType = Literal["half", "float", "rgb9e5", "r11g11b10"]


def pixel_type(scene: Scene) -> PixelType:
    """Type in which no value of a scene's map overflows and no sky value loses bits."""
    canvases = scene.settings.view.projection.canvases()
    peak = max(Raster(scene, canvas).peak for canvas in canvases)
    return fitting_pixel(scene.settings.encoding.pixel, *value_range(scene, peak))


def value_range(scene: Scene, peak: float) -> tuple[float, float]:
    """Return bounds of a map's values, of which the survey's texels are coarser than the map's.

    Parameters
    ----------
    scene : Scene
        What the map shows.
    peak : float
        Largest value of the sun's disc and of stars.

    Returns
    -------
    largest, smallest : float
        Of all magnitudes; of the sky's luminance, relative to white, where there is any.
    """
    if "sky" not in scene.layer_names:
        # The edges of stars fade to nothing.
        return peak, 0.0 if "stars" in scene.layer_names else 1.0
    toward_sun = scene.evaluate(np.array([[scene.sun_zenith]]), np.zeros((1, 1)), 1e-9)
    luminance = scene.survey @ (scene.luminance / scene.settings.encoding.white_luminance)
    lit = luminance[luminance > 0.0]
    largest = 1.1 * max(np.abs(scene.survey).max(), np.abs(toward_sun).max()) + peak
    return float(largest), 0.5 * float(lit.min()) if lit.size else 1.0


def fitting_pixel(wanted: str, largest: float, smallest: float) -> PixelType:
    """Return the type of stored values that is wanted, where auto is the smallest that holds all.

    Parameters
    ----------
    wanted : str
        As of `skybake.image.settings.Encoding`.
    largest, smallest : float
        As of `value_range`.
    """
    if wanted != "auto":
        return cast(PixelType, wanted)
    return "half" if largest < HALF_LARGEST and smallest >= HALF_SMALLEST else "float"
