"""Display-referred pictures of scenes, which need no file of the map."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.baking.panel import CrossPanel, EquirectPanel, Panel
from skybake.baking.preview import SURVEY_ROWS, legible_ev
from skybake.baking.scene import Scene
from skybake.colour.exposure import luminance_from_ev
from skybake.formats.preview import Show, display_values

PREVIEW_WIDTH = 1024


def scene_ev(scene: Scene) -> float:
    """Exposure value at which a scene is legible, whatever the map's projection and size."""
    survey = EquirectPanel(scene, 2 * SURVEY_ROWS).rows(0, SURVEY_ROWS)
    settings = scene.settings
    return legible_ev(survey, settings.space, settings.white_luminance)


def show_scene(scene: Scene, show: Show, ev: float) -> None:
    """Make the preview of a scene, in the map's own projection."""
    settings = scene.settings
    if settings.projection == "equirect":
        panel: Panel = EquirectPanel(scene, min(settings.width, PREVIEW_WIDTH))
    else:
        panel = CrossPanel(scene, min(settings.width, PREVIEW_WIDTH // 4))
    pixels = panel.rows(0, panel.height)
    show(pixels, settings.space, _gain(scene, ev))


def thumbnail(scene: Scene, ev: float, view: str, width: int) -> npt.NDArray[np.uint8]:
    """Equirect picture of a scene, code values of sRGB, shape (width // 2, width, 3)."""
    panel = EquirectPanel(scene, width)
    exposed = panel.rows(0, panel.height) * np.float32(_gain(scene, ev))
    values = display_values(exposed, scene.settings.space, view)
    code_values: npt.NDArray[np.uint8] = np.rint(values * 255.0).astype(np.uint8)
    return code_values


def _gain(scene: Scene, ev: float) -> float:
    return scene.settings.white_luminance / luminance_from_ev(ev)
