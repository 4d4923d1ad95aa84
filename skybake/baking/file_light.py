"""What the picture in a file tells of its light: exposure, and the white of its world."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from skybake.angles import direction_from_angles
from skybake.colour.exposure import auto_ev
from skybake.colour.space import ColourSpace, find_colour_space, luminance_weights, rgb_from_xyz
from skybake.colour.white_balance import Array, automatic_white, white_from_kelvin
from skybake.environment.environment import charts_on
from skybake.image.layers import Pixels
from skybake.image.picture_settings import PictureSettings, WhiteBalance, has_size_of_earth
from skybake.projection.chart import Canvas, Chart
from skybake.projection.of_file import file_recipe

_DISC = math.radians(1.0)
_DISC_PIXELS = 2.5
"""A disc in a file is kept out of the metering up to this far from the sun: its own
radius, and the pixels that reductions have spread it over."""

_ALL = 0.99
"""Share of the hemisphere above, by its illuminance, that a map of all of it shows."""

_DARK = 1e-7
"""Illuminance of darkness, whose colour is rounding. [lx]"""


class FileLight:
    """Light of the picture in a file.

    Parameters
    ----------
    attributes : mapping
        Of the file.
    pixels : ndarray of float32, shape (row, column, 3)
        All of the picture, in its own size or smaller.
    canvas : Canvas or None
        Where these pixels look, if that is known.
    space : ColourSpace
        Their space.
    white_luminance : float
        Luminance that RGB (1, 1, 1) stands for. [cd m⁻²]
    """

    def __init__(
        self,
        attributes: Mapping[str, Any],
        pixels: Pixels,
        canvas: Canvas | None,
        space: ColourSpace,
        white_luminance: float,
    ) -> None:
        self.canvas = canvas
        self._attributes, self._pixels, self._space = attributes, pixels, space
        self._luminance = luminance_weights(space) * white_luminance
        self._xyz_from_rgb: Array = np.asarray(
            np.linalg.inv(rgb_from_xyz(space)) * white_luminance, np.float64
        )
        self._recipe = file_recipe(attributes)

    def ev(self, pixels: Pixels, canvas: Canvas | None) -> float:
        """Exposure value for a view of the picture, see `skybake.colour.exposure.auto_ev`.

        Where it is not known where pixels look, all of them count the same, as sky.
        """
        if canvas is None:
            return auto_ev(pixels @ self._luminance)
        sun = None if self._disc() == "only" else self._sun_direction()
        found = [
            (here @ self._luminance, size, vectors[..., 1] >= 0.0)
            for chart, here in charts_on(canvas, pixels)
            for vectors in (_vectors(chart),)
            for size in (self._without_disc(chart, vectors, sun),)
        ]
        luminance, size, above = (
            np.concatenate([each.ravel() for each in one]) for one in zip(*found, strict=True)
        )
        return auto_ev(luminance, size, above)

    def white_balance(self, settings: PictureSettings) -> WhiteBalance:
        """Return what a picture takes as white, by what the file says of its world."""
        if settings.white_balance is not None:
            return settings.white_balance
        return "auto" if self._is_of_another_world() else "none"

    def white(self, white_balance: WhiteBalance) -> Array | None:
        """XYZ of the light that is shown as white; None for D65.

        By auto, that is the light on the horizontal, or, where the picture shows none, that
        of the sun's disc as the file states it.
        """
        if white_balance == "none":
            return None
        if white_balance != "auto":
            return white_from_kelvin(float(white_balance))
        light = self._on_the_horizontal()
        if not (light[1] > _DARK and np.isfinite(light).all()):
            colour = self._sun_colour()
            if colour is None:
                return None
            light = colour
        return automatic_white(light)

    def _on_the_horizontal(self) -> Array:
        """XYZ on a horizontal plane; of a part of the sky as if all of it were like that part."""
        if self.canvas is None:
            mean = self._pixels.reshape(-1, 3).mean(axis=0, dtype=np.float64)
            whole: Array = self._xyz_from_rgb @ mean
            return whole
        light, seen = self._sum_over_sky(self.canvas, sun=None)
        if seen > _ALL * math.pi:
            # The disc is in the pixels, unless it was left out.
            return light + self._direct() if self._disc() in {"exclude", "separate"} else light
        part, _ = self._sum_over_sky(self.canvas, self._sun_direction())
        sky = self._figure("skybake:skyIlluminance")
        if sky is None or not part[1] > 0.0:
            return part
        light = part * float(sky / part[1])
        return light + self._direct()

    def _sum_over_sky(self, canvas: Canvas, sun: Array | None) -> tuple[Array, float]:
        """XYZ on the horizontal by what is seen above it without the sun's disc.

        Also the illuminance by as much of a sky of luminance 1.
        """
        rgb, seen = np.zeros(3), 0.0
        for chart, here in charts_on(canvas, self._pixels):
            vectors = _vectors(chart)
            upward = np.maximum(vectors[..., 1], 0.0) * self._without_disc(chart, vectors, sun)
            rgb += np.einsum("rcx,rc->x", here.astype(np.float64), upward)
            seen += float(upward.sum())
        return self._xyz_from_rgb @ rgb, seen

    def _without_disc(self, chart: Chart, vectors: Array, sun: Array | None) -> Array:
        """Solid angles of a chart's pixels, 0 where the sun's disc is."""
        size = _sizes(chart)
        if sun is None or self.canvas is None:
            return size
        widest = max(float(_sizes(part.chart).max()) for part in self.canvas.parts)
        reach = _DISC + _DISC_PIXELS * math.sqrt(widest)
        return np.where(vectors @ sun > math.cos(min(reach, math.pi)), 0.0, size)

    def _direct(self) -> Array:
        """XYZ by the sun's disc on the horizontal, as the file states it. [lx]"""
        colour, illuminance = self._sun_colour(), self._figure("skybake:directIlluminance")
        return np.zeros(3) if colour is None or illuminance is None else illuminance * colour

    def _sun_colour(self) -> Array | None:
        """XYZ of the sun's light, of luminance 1, if the file states it."""
        colour = np.array(_numbers(self._attributes.get("skybake:sunColour")))
        if len(colour) != 3 or not (np.isfinite(colour).all() and colour.min() >= 0.0):
            return None
        rec709 = np.linalg.inv(rgb_from_xyz(find_colour_space("lin_rec709")))
        xyz: Array = rec709 @ colour
        return xyz if xyz[1] > 0.0 else None

    def _sun_direction(self) -> Array | None:
        direction = _numbers(self._attributes.get("skybake:sunDirection"))
        length = float(np.linalg.norm(direction)) if len(direction) == 3 else 0.0
        return np.array(direction) / length if math.isfinite(length) and length > 0.0 else None

    def _figure(self, name: str) -> float | None:
        values = _numbers(self._attributes.get(name))
        return values[0] if len(values) == 1 and math.isfinite(values[0]) else None

    def _disc(self) -> str:
        shown = self._recipe.get("map")
        return str(shown.get("sun_disc")) if isinstance(shown, dict) else ""

    def _is_of_another_world(self) -> bool:
        """Whether the file says that it shows one; others say nothing of their world."""
        preset = self._recipe.get("preset")
        try:
            radius = float(preset["planet"]["radius_km"])  # type: ignore[index]
            star_radius = float(preset["star"]["radius_km"])  # type: ignore[index]
        except (KeyError, TypeError, ValueError):
            name = self._attributes.get("skybake:preset")
            return name is not None and not str(name).startswith("earth")
        return not has_size_of_earth(radius, star_radius)


def _vectors(chart: Chart) -> Array:
    """Return unit vectors of a chart's pixels, shape (row, column, 3)."""
    zenith, bearing = chart.angles(0, chart.height)
    return direction_from_angles(bearing, math.pi / 2.0 - zenith)


def _sizes(chart: Chart) -> Array:
    sizes = chart.solid_angles(0, chart.height)
    return np.broadcast_to(sizes, (chart.height, chart.width))


def _numbers(value: Any) -> tuple[float, ...]:
    """Numbers of an attribute, which a Radiance picture holds as text; none of another."""
    try:
        values = value.split() if isinstance(value, str) else np.atleast_1d(value).tolist()
        return tuple(map(float, values))
    except (TypeError, ValueError):
        return ()
