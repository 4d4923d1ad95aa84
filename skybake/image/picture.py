"""Display-referred pictures of scenes and images, which need no file of the map."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.colour.exposure import luminance_from_ev
from skybake.colour.space import ColourSpace
from skybake.colour.white_balance import Array, balance
from skybake.formats.preview import DEFAULT_VIEW, Show, display_values
from skybake.image.layers import Pixels
from skybake.image.meter import scene_ev, scene_white
from skybake.image.picture_settings import PictureSettings
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.settings import Encoding, View
from skybake.image.vision import as_seen
from skybake.projection import Perspective, Projection

PREVIEW_WIDTH = 1024

CodeValues = npt.NDArray[np.uint8]

_WHITE = 1e30


def picture_projection(view: View, shot: Perspective | None) -> Projection:
    """Return what the preview of a map shows: a shot, or all of the map in a size that suits it."""
    if shot is None:
        return view.projection.smaller(PREVIEW_WIDTH)
    return shot.on_map(view.rotation)


def picture_ev(scene: Scene, settings: PictureSettings) -> float:
    """Exposure value of a picture of a scene: the given one, or what a camera meters."""
    if settings.fixed_ev is not None:
        return settings.fixed_ev
    view, shot = scene.settings.view, settings.shot
    return scene_ev(scene, view.projection if shot is None else shot.on_map(view.rotation))


def show_scene(
    scene: Scene,
    show: Show,
    ev: float,
    white: Array | None,
    projection: Projection,
    vision: str = "camera",
    pixels: Pixels | None = None,
) -> None:
    """Make the preview of a scene, of its pixels in the projection if they are known."""
    encoding = scene.settings.encoding
    shown = _single(scene, projection) if pixels is None else pixels
    shown = as_seen(shown, encoding.space, encoding.white_luminance, vision)
    show(balanced(shown, encoding.space, white), encoding.space, gain(encoding, ev))


def thumbnail(scene: Scene, ev: float, settings: PictureSettings, width: int) -> CodeValues:
    """Picture of a scene in code values of sRGB; of the whole sphere an equirect map."""
    view, shot = scene.settings.view, settings.shot
    shown = view.projection if shot is None else shot.on_map(view.rotation)
    glance = _single(scene, shown.glance(width))
    white = scene_white(scene, settings)
    encoding = scene.settings.encoding
    return code_values(glance, encoding, ev, settings.view, white, settings.vision)


def code_values(
    pixels: Pixels,
    encoding: Encoding,
    ev: float,
    view: str = DEFAULT_VIEW,
    white: Array | None = None,
    vision: str = "camera",
) -> CodeValues:
    """Code values of sRGB of scene-linear pixels, shape (row, column, 3).

    Light whose XYZ is `white` has no colour in them; None is D65.
    """
    seen = as_seen(pixels, encoding.space, encoding.white_luminance, vision)
    exposed = balanced(seen, encoding.space, white) * np.float32(gain(encoding, ev))
    values = display_values(exposed, encoding.space, view)
    shown: CodeValues = np.rint(values * 255.0).astype(np.uint8)
    return shown


def balanced(pixels: Pixels, space: ColourSpace, white: Array | None) -> Pixels:
    """Pixels in which light whose XYZ is `white` looks as D65 does; None leaves them."""
    if white is None:
        return pixels
    turned: Pixels = np.clip(pixels @ balance(space, white).T, -_WHITE, _WHITE).astype(np.float32)
    return turned


def gain(encoding: Encoding, ev: float) -> float:
    """Factor from pixels to the scene-linear values of ACES at an exposure value."""
    return encoding.white_luminance / luminance_from_ev(ev)


def _single(scene: Scene, projection: Projection) -> Pixels:
    """Light of a scene in the one picture of a projection."""
    (canvas,) = projection.canvases()
    raster = Raster(scene, canvas)
    light = raster.rows(0, canvas.height)
    angle = scene.settings.sensor.polarizer
    if angle is None:
        return light
    from skybake.image.polarised import through_filter

    return through_filter(light, raster.band("stokes", 0, canvas.height), angle)
