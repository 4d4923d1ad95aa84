"""The sky of a planet for users of Python: rays, images, pictures in a notebook."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from skybake.image.image import Image, image_of_scene
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.pipeline.stages import KeptStages
from skybake.projection import Projection
from skybake.sky import sky

NOTEBOOK_WIDTH = 512


class Sky(sky.Sky):
    """Light from any direction, for one observer and one sun, and images of it.

    Parameters and errors are those of `skybake.sky.sky.Sky`.
    """

    def image(
        self,
        projection: Projection | str = "equirect",
        width: int | tuple[int, ...] | None = None,
        **values: Any,
    ) -> Image:
        """Return an image of the sky without writing a file.

        Parameters
        ----------
        projection : Projection or str, optional
            A name of `skybake.projection.PROJECTIONS`, such as "fisheye", or an object of these.
        width : int or tuple of int, optional
            Of the image, or width and height of a perspective picture. [pixel]
        **values
            What `skybake.map_settings` takes besides, such as ``colorspace="acescg"``,
            ``units="nits"``, ``sun_disc="exclude"``, or ``fov`` of a perspective picture. [rad]

        Raises
        ------
        InputError
            If a value is out of its range, or the sky has other wavelengths than those that
            colours are made of.
        """
        settings = map_settings(
            projection,
            width,
            sun_elevation=self.sun_elevation,
            sun_azimuth=self.sun_azimuth,
            sun_distance=self.sun_distance,
            method=self.method,
            altitude=self.altitude,
            **values,
        )
        return image_of_scene(Scene(self.planet, settings, self.workers, self._stages))

    def _repr_png_(self) -> bytes:
        """Return what a notebook shows."""
        return self.image(width=NOTEBOOK_WIDTH)._repr_png_()

    @cached_property
    def _stages(self) -> KeptStages:
        return KeptStages(1)
