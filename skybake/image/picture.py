"""Display-referred pictures of scenes, which need no file of the map."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.colour.exposure import auto_ev, luminance_from_ev
from skybake.formats.preview import Show, display_values
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.projection import Projection

PREVIEW_WIDTH = 1024

SURVEY_ROWS = 256
"""Rows of an equirect map by which the light of a scene is judged."""


def scene_ev(scene: Scene) -> float:
    """Exposure value at which a scene is legible, whatever the size of the map."""
    (canvas,) = scene.settings.view.projection.glance(2 * SURVEY_ROWS).canvases()
    (part,) = canvas.parts
    luminance = Raster(scene, canvas).rows(0, canvas.height) @ scene.luminance
    zenith, _ = part.chart.angles(0, canvas.height)
    weights = part.chart.solid_angles(0, canvas.height)
    return auto_ev(np.maximum(luminance, 0.0), weights, zenith <= np.pi / 2.0)


def show_scene(scene: Scene, show: Show, ev: float) -> None:
    """Make the preview of a scene, in the map's own projection."""
    pixels = _pixels(scene, scene.settings.view.projection.smaller(PREVIEW_WIDTH))
    show(pixels, scene.settings.encoding.space, _gain(scene, ev))


def thumbnail(scene: Scene, ev: float, view: str, width: int) -> npt.NDArray[np.uint8]:
    """Picture of a scene, so wide, code values of sRGB; an equirect map of the whole sphere."""
    glance = _pixels(scene, scene.settings.view.projection.glance(width))
    exposed = glance * np.float32(_gain(scene, ev))
    values = display_values(exposed, scene.settings.encoding.space, view)
    code_values: npt.NDArray[np.uint8] = np.rint(values * 255.0).astype(np.uint8)
    return code_values


def _pixels(scene: Scene, projection: Projection) -> npt.NDArray[np.float32]:
    """Light of a scene in the one picture of a projection."""
    (canvas,) = projection.canvases()
    return Raster(scene, canvas).rows(0, canvas.height)


def _gain(scene: Scene, ev: float) -> float:
    return scene.settings.encoding.white_luminance / luminance_from_ev(ev)
