"""Maps that hold other channels than those of an eye: a spectrum, or a camera's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from skybake.baking.pixel_type import value_range
from skybake.colour.space import ColourSpace
from skybake.errors import InputError
from skybake.formats.spec import CAMERA, Attribute, MapSpec
from skybake.formats.spectral_exr import spectral_attributes, stokes_channel
from skybake.image.bands import BandScene, camera_scene, check_sensor, spectral_scenes
from skybake.image.layers import RGB, Pixels
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.sensor import Sensor
from skybake.image.settings import MapSettings
from skybake.projection.chart import Canvas

CAMERA_SPACE = ColourSpace("camera", "unknown", (), (0.0, 0.0))
"""The space of a camera's own channels, which has no chromaticities."""


class SpectralRaster(Raster):
    """A picture in R, G and B and at wavelengths.

    Parameters
    ----------
    scene, canvas
        As of `Raster`.
    spectrum : sequence of (BandScene, tuple of float)
        As of `spectral_scenes`.
    """

    def __init__(
        self, scene: Scene, canvas: Canvas, spectrum: Sequence[tuple[BandScene, tuple[float, ...]]]
    ) -> None:
        super().__init__(scene, canvas)
        self._bands = [(Raster(band, canvas), len(some)) for band, some in spectrum]
        self.peak = max([self.peak, *(raster.peak for raster, _ in self._bands)])

    def rows(self, first: int, last: int) -> Pixels:
        """Light of the rows first..last, shape (last - first, width, channel)."""
        channels = len(RGB) + sum(count for _, count in self._bands)
        pixels = np.empty((last - first, self.canvas.width, channels), np.float32)
        pixels[..., : len(RGB)] = super().rows(first, last)
        begin = len(RGB)
        for raster, count in self._bands:
            pixels[..., begin : begin + count] = raster.rows(first, last)[..., :count]
            begin += count
        return pixels


@dataclass(frozen=True)
class Bands:
    """What a map holds besides what an eye sees, or instead.

    Attributes
    ----------
    scene : Scene
        What its R, G and B show.
    spectrum : list of (BandScene, tuple of float)
        As of `spectral_scenes`.
    """

    scene: Scene
    spectrum: list[tuple[BandScene, tuple[float, ...]]] = field(default_factory=list)

    def rasters(self, canvases: Sequence[Canvas]) -> list[Raster]:
        """Return the pictures of the map."""
        if not self.spectrum:
            return [Raster(self.scene, canvas) for canvas in canvases]
        return [SpectralRaster(self.scene, canvas, self.spectrum) for canvas in canvases]

    def value_range(self, peak: float) -> tuple[float, float]:
        """Bounds of all values, as of `skybake.baking.pixel_type.value_range`."""
        scenes = (self.scene, *(band for band, _ in self.spectrum))
        largest, smallest = zip(*(value_range(each, peak) for each in scenes), strict=True)
        return max(largest), min(smallest)

    def spec(self, spec: MapSpec, sensor: Sensor) -> MapSpec:
        """Return what a file of the map holds, of that of an eye's."""
        attributes: dict[str, Attribute] = {}
        channels: tuple[str, ...] = RGB
        if self.spectrum:
            attributes |= spectral_attributes(is_polarised=False)
            wavelengths = [each for _, some in self.spectrum for each in some]
            channels = (*channels, *(stokes_channel(0, each) for each in wavelengths))
        if sensor.response is not None:
            attributes[CAMERA] = sensor.response.text
            spec = replace(spec, colour_space=CAMERA_SPACE)
        return replace(spec, channels=channels, attributes={**spec.attributes, **attributes})


def bands_of(scene: Scene) -> Bands:
    """Return what the map of a scene holds besides what an eye sees, or instead.

    Raises
    ------
    InputError
        If the world, the sun or the night cannot be shown so.
    """
    check_sensor(scene.planet, scene.settings)
    sensor = scene.settings.sensor
    seen = scene if sensor.response is None else camera_scene(scene, sensor.response)
    return Bands(seen, [] if sensor.wavelengths is None else spectral_scenes(scene))


def check_bands(path: Path, settings: MapSettings) -> None:
    """Refuse files that do not hold such channels.

    Raises
    ------
    InputError
        Unless it is an OpenEXR file and, of a spectral map, without parts and smaller copies.
    """
    is_spectral = settings.sensor.wavelengths is not None
    what = "a spectral map" if is_spectral else "a camera's map"
    if path.suffix.lower() != ".exr":
        raise InputError(f"{path}: {what} must be in .exr, got {path.suffix!r}")
    if not is_spectral:
        return
    encoding, lighting = settings.encoding, settings.lighting
    parts = {
        "mips": encoding.mips,
        "layers": encoding.layers,
        "a separate disc": lighting.sun_disc == "separate",
    }
    for name, is_asked in parts.items():
        if is_asked:
            raise InputError(f"{path}: {what} must be without {name}")
