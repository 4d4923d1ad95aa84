"""Display-referred pictures of scenes and images, which need no file of the map."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.colour.exposure import auto_ev, luminance_from_ev
from skybake.formats.preview import Show, display_values
from skybake.image.layers import Pixels
from skybake.image.raster import Raster
from skybake.image.scene import SURVEY_ROWS, Scene
from skybake.image.settings import Encoding
from skybake.projection import Projection
from skybake.projection.chart import Canvas

PREVIEW_WIDTH = 1024

CodeValues = npt.NDArray[np.uint8]


def scene_ev(scene: Scene) -> float:
    """Exposure value at which a scene is legible, whatever the size of the map.

    A map of the whole sphere is exposed for all of it, a picture of a part for what it shows.
    """
    (canvas,) = scene.settings.view.projection.glance(2 * SURVEY_ROWS).canvases()
    (part,) = canvas.parts
    luminance = _rows(scene, canvas) @ scene.luminance
    zenith, _ = part.chart.angles(0, canvas.height)
    weights = part.chart.solid_angles(0, canvas.height)
    return auto_ev(np.maximum(luminance, 0.0), weights, zenith <= np.pi / 2.0)


def show_scene(scene: Scene, show: Show, ev: float) -> None:
    """Make the preview of a scene, in the map's own projection."""
    pixels = _single(scene, scene.settings.view.projection.smaller(PREVIEW_WIDTH))
    show(pixels, scene.settings.encoding.space, gain(scene.settings.encoding, ev))


def thumbnail(scene: Scene, ev: float, view: str, width: int) -> CodeValues:
    """Picture of a scene in code values of sRGB; of the whole sphere an equirect map."""
    glance = _single(scene, scene.settings.view.projection.glance(width))
    return code_values(glance, scene.settings.encoding, ev, view)


def code_values(pixels: Pixels, encoding: Encoding, ev: float, view: str) -> CodeValues:
    """Code values of sRGB of scene-linear pixels, shape (row, column, 3)."""
    exposed = pixels * np.float32(gain(encoding, ev))
    values = display_values(exposed, encoding.space, view)
    shown: CodeValues = np.rint(values * 255.0).astype(np.uint8)
    return shown


def gain(encoding: Encoding, ev: float) -> float:
    """Factor from pixels to the scene-linear values of ACES at an exposure value."""
    return encoding.white_luminance / luminance_from_ev(ev)


def _single(scene: Scene, projection: Projection) -> Pixels:
    """Light of a scene in the one picture of a projection."""
    (canvas,) = projection.canvases()
    return _rows(scene, canvas)


def _rows(scene: Scene, canvas: Canvas) -> Pixels:
    return Raster(scene, canvas).rows(0, canvas.height)
