"""What a camera would set before it takes a picture of a scene: exposure and white."""

from __future__ import annotations

import numpy as np

from skybake.colour.exposure import auto_ev
from skybake.colour.white_balance import Array, automatic_white, white_from_kelvin
from skybake.image.picture_settings import PictureSettings, white_balance_of
from skybake.image.raster import Raster, sky_pixels
from skybake.image.scene import Scene
from skybake.image.survey import SURVEY_ROWS
from skybake.projection import Projection

DARKEST_NIGHT = -10.5
"""Least exposure value of a picture with stars: that for a natural sky without a moon."""

NO_LIGHT = 1e-12
"""Of the star's illuminance above the atmosphere, below which what falls on the ground is
darkness or rounding and has no colour."""


def scene_ev(scene: Scene, projection: Projection | None = None) -> float:
    """Exposure value for a picture of a scene, whatever its size, without the sun's disc.

    Parameters
    ----------
    scene : Scene
        What is shown.
    projection : Projection, optional
        What of it; the map's own by default. A map of the whole sphere is exposed for all of
        it, a picture of a part for what it shows.
    """
    shown = projection or scene.settings.view.projection
    (canvas,) = shown.glance(2 * SURVEY_ROWS).canvases()
    (part,) = canvas.parts
    chart, height = part.chart, canvas.height
    if "sky" in scene.layer_names:
        pixels = sky_pixels(scene, chart, 0, height)
    else:
        pixels = Raster(scene, canvas).rows(0, height)
    zenith, _ = chart.angles(0, height)
    ev = auto_ev(pixels @ scene.luminance, chart.solid_angles(0, height), zenith <= np.pi / 2.0)
    return ev if scene.stars is None else max(ev, DARKEST_NIGHT)


def scene_white(scene: Scene, settings: PictureSettings) -> Array | None:
    """XYZ of the light that a picture of a scene shows as white; None for D65.

    By auto, that is the light which falls on the horizontal, or, where none does, the light
    of the star above the atmosphere.
    """
    wanted = white_balance_of(settings, scene.planet)
    if wanted == "none":
        return None
    if wanted != "auto":
        return white_from_kelvin(float(wanted))
    star: Array = scene.xyz_weights.sum(axis=0)
    _, direct = scene.sun_xyz()
    light = direct + scene.sky_xyz()
    if scene.moonlit is not None:
        light = light + scene.moonlit.xyz()[1]
    return automatic_white(light if light[1] > NO_LIGHT * star[1] else star)
