"""A map in memory: pixels with what they mean."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from skybake.errors import InputError
from skybake.formats.preview import DEFAULT_VIEW, png_bytes
from skybake.image.layers import Pixels
from skybake.image.light import (
    Light,
    attributes_from_light,
    eclipse_attributes,
    light_of_scene,
    moon_attributes,
    night_attributes,
)
from skybake.image.meter import scene_ev, scene_white
from skybake.image.picture import PREVIEW_WIDTH, CodeValues, code_values
from skybake.image.picture_settings import PictureSettings, WhiteBalance
from skybake.image.raster import Raster
from skybake.image.recipe import recipe_attributes
from skybake.image.scene import Scene
from skybake.image.settings import Encoding
from skybake.projection import Projection
from skybake.projection.cubemap import CROSS_ORIGINS, FACES

BAND_ROWS = 128


@dataclass(frozen=True, eq=False)
class Image:
    """A map, or another picture of a sky.

    Attributes
    ----------
    pixels : ndarray of float32, shape (row, column, 3) or (face, row, column, 3)
        Linear and scene-referred. Row 0 is at the top; of a cubemap in six pictures the faces
        come in the order +X -X +Y -Y +Z -Z.
    scene : Scene
        What they show; its settings say where pixels look and what the numbers mean.
    light : Light
        Directions and illuminances.
    metadata : mapping of str to Any
        Attributes of the file of the map, see docs/formats.md.
    """

    pixels: Pixels
    scene: Scene = field(repr=False)
    light: Light
    metadata: Mapping[str, Any]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        """Return the pixels, so that `numpy.asarray` of the image returns them."""
        return np.array(self.pixels, dtype=dtype, copy=copy)

    @property
    def projection(self) -> Projection:
        """Where pixels look."""
        return self.scene.settings.view.projection

    @property
    def encoding(self) -> Encoding:
        """What the numbers mean."""
        return self.scene.settings.encoding

    def picture(
        self,
        ev: float | None = None,
        view: str = DEFAULT_VIEW,
        white_balance: WhiteBalance | None = None,
    ) -> CodeValues:
        """Return the image as a screen shows it.

        Parameters
        ----------
        ev : float, optional
            Exposure value at ISO 100; by default as a camera meters it.
        view : {"aces1", "aces2"}, optional
            Display transform.
        white_balance : float, "auto" or "none", optional
            As of `PictureSettings`.

        Returns
        -------
        ndarray of uint8, shape (row, column, 3)
            Code values of sRGB; six faces form a cross.
        """
        settings = PictureSettings(ev, view, white_balance)
        ev = scene_ev(self.scene) if ev is None else ev
        white = scene_white(self.scene, settings)
        return code_values(self._joined(), self.encoding, ev, view, white)

    def _repr_png_(self) -> bytes:
        """Return what a notebook shows."""
        picture = self.picture()
        step = -(-picture.shape[1] // PREVIEW_WIDTH)
        return png_bytes(picture[step // 2 :: step, step // 2 :: step])

    def _joined(self) -> Pixels:
        if self.pixels.ndim == 3:
            return self.pixels
        edge = self.pixels.shape[1]
        cross = np.zeros((3 * edge, 4 * edge, 3), np.float32)
        for face, pixels in zip(FACES, self.pixels, strict=True):
            row, column = (edge * each for each in CROSS_ORIGINS[face])
            cross[row : row + edge, column : column + edge] = pixels
        return cross


def image_of_scene(scene: Scene, progress: Callable[[float], None] | None = None) -> Image:
    """Evaluate a scene at all pixels of its map.

    Parameters
    ----------
    scene : Scene
        What is shown.
    progress : callable, optional
        Called with the share that is done, from 0 to 1.

    Raises
    ------
    CancelledError
        If the scene's workers were stopped.
    InputError
        If other channels than those of an eye are asked for.
    """
    if not scene.settings.sensor.is_eye:
        raise InputError("sensor: an image holds what an eye sees; other channels are in files")
    light = light_of_scene(scene)
    pictures = []
    canvases = scene.settings.view.projection.canvases()
    total = sum(canvas.height for canvas in canvases)
    done = 0
    for canvas in canvases:
        raster = Raster(scene, canvas)
        pixels = np.empty((canvas.height, canvas.width, 3), np.float32)
        for first in range(0, canvas.height, BAND_ROWS):
            scene.workers.check()
            last = min(first + BAND_ROWS, canvas.height)
            pixels[first:last] = raster.rows(first, last)
            done += last - first
            if progress is not None:
                progress(done / total)
        pictures.append(pixels)
    return Image(
        pixels=pictures[0] if len(pictures) == 1 else np.stack(pictures),
        scene=scene,
        light=light,
        metadata={
            **attributes_from_light(light),
            **eclipse_attributes(scene),
            **night_attributes(scene),
            **moon_attributes(scene),
            **recipe_attributes(scene.planet, scene.settings),
        },
    )
