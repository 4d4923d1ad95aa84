"""Stars in maps."""

from __future__ import annotations

import math

import numpy as np

from skybake.angles import zenith_azimuth
from skybake.colour.observer import load_observer, xyz_weights
from skybake.colour.response import weights_of_radiance
from skybake.colour.space import find_colour_space, rgb_from_xyz
from skybake.ephemeris.celestial import CelestialFrame
from skybake.image.layers import Pixels
from skybake.image.scene import Scene
from skybake.night.stars import Stars
from skybake.optics.medium import Array
from skybake.projection.chart import Chart
from skybake.projection.points import spread_points


def stars_over(scene: Scene, frame: CelestialFrame) -> Stars:
    """Return the stars of a scene that stand in a frame."""
    night = scene.settings.night
    return Stars(scene.sky, frame, night.faintest_star, is_refracted=night.is_refracted)


def star_xyz(scene: Scene, stars: Stars) -> Array:
    """XYZ by each star on a plane that faces it, shape (n, 3). [lx]"""
    sky = scene.sky
    if sky.planet.rendering == "spectral":
        light: Array = stars.irradiance @ weights_of_radiance(scene.response, sky.wavelengths)
    else:
        # Three wavelengths stand for R, G and B, and dim these.
        nodes, _ = load_observer()
        flat = np.ones_like(nodes)
        to_rgb = rgb_from_xyz(find_colour_space("lin_rec709"))
        above = stars.above_air(nodes) @ xyz_weights(nodes, nodes, flat)
        light = (above @ to_rgb.T * stars.transmittance) @ np.linalg.inv(to_rgb).T
    if scene.moonlit is not None:
        light[scene.moonlit.hides(stars.vectors)] = 0.0
    if scene.cloudscape is not None:
        zenith, azimuth = zenith_azimuth(stars.vectors)
        light = light * scene.cloudscape.transmittance(zenith, azimuth)[:, None]
    return light


def star_illuminance(scene: Scene, stars: Stars) -> float:
    """Illuminance of the horizontal by stars. [lx]"""
    cosine = np.maximum(stars.vectors[:, 1], 0.0)
    return float(cosine @ star_xyz(scene, stars)[:, 1])


class StarSpots:
    """Pixel values of the stars of a scene, sparse.

    Parameters
    ----------
    scene : Scene
        Whose stars they are.
    chart : Chart
        Where the pixels look.

    Attributes
    ----------
    peak : float
        Largest value of a pixel.
    """

    def __init__(self, scene: Scene, chart: Chart) -> None:
        self._width = chart.width
        self._texel, self._values = np.zeros(0, np.int64), np.zeros((0, 3))
        self.peak = 0.0
        stars = scene.stars
        if stars is None:
            return
        encoding = scene.settings.encoding
        to_rgb = rgb_from_xyz(encoding.space).T / encoding.white_luminance
        light = star_xyz(scene, stars) @ to_rgb
        spots = spread_points(chart, turned(stars.vectors, scene.settings.view.rotation))
        order = np.argsort(spots.texel, kind="stable")
        texel = spots.texel[order]
        values = spots.weight[order, None] * light[spots.point[order]]
        self._texel, first = np.unique(texel, return_index=True)
        self._values = np.add.reduceat(values, first, axis=0) if len(values) else values
        self.peak = float(np.abs(self._values).max(initial=0.0))

    def rows(self, first: int, last: int) -> tuple[int, Pixels]:
        """Return where in the rows first..last stars begin, and the pixels from there on."""
        begin, end = np.searchsorted(self._texel, (first * self._width, last * self._width))
        if begin == end:
            return 0, np.zeros((0, self._width, 3), np.float32)
        texel = self._texel[begin:end]
        top, bottom = int(texel[0]) // self._width, int(texel[-1]) // self._width + 1
        pixels = np.zeros(((bottom - top) * self._width, 3), np.float32)
        pixels[texel - top * self._width] = self._values[begin:end]
        return top - first, pixels.reshape(bottom - top, self._width, 3)


def turned(vectors: Array, rotation: float) -> Array:
    """Vectors in the axes of a map whose -Z looks to a bearing. [rad]"""
    if rotation == 0.0:
        return vectors
    sine, cosine = math.sin(rotation), math.cos(rotation)
    x, y, z = vectors.T
    return np.stack([cosine * x + sine * z, y, cosine * z - sine * x], axis=-1)
