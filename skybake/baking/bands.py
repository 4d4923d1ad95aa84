"""Maps that hold other channels than those of an eye: a spectrum, or a camera's."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from skybake.baking.pixel_type import value_range
from skybake.colour.space import ColourSpace
from skybake.errors import InputError
from skybake.formats.spec import CAMERA, POLARIZER, Attribute, MapSpec
from skybake.formats.spectral_exr import spectral_attributes, stokes_channel
from skybake.image.bands import (
    BandScene,
    camera_scene,
    check_sensor,
    moon_lights_air,
    spectral_scenes,
)
from skybake.image.layers import RGB, Pixels
from skybake.image.polarised import (
    REFERENCE,
    check_polarisation,
    polarisation_warnings,
    through_filter,
)
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.sensor import Sensor
from skybake.image.settings import MapSettings
from skybake.projection.chart import Canvas

STOKES = 4
STOKES_REFERENCE = "skybake:stokesReference"

CAMERA_SPACE = ColourSpace("camera", "unknown", (), (0.0, 0.0))
"""The space of a camera's own channels, which has no chromaticities."""


class SensorRaster(Raster):
    """A picture in R, G and B, at wavelengths, and in Stokes components.

    Parameters
    ----------
    scene, canvas
        As of `Raster`.
    spectrum : sequence of (BandScene, tuple of float)
        As of `spectral_scenes`.
    sensor : Sensor
        What it records.
    """

    def __init__(
        self,
        scene: Scene,
        canvas: Canvas,
        spectrum: Sequence[tuple[BandScene, tuple[float, ...]]],
        sensor: Sensor,
    ) -> None:
        super().__init__(scene, canvas)
        self._sensor = sensor
        self._bands = [(Raster(band, canvas), len(some)) for band, some in spectrum]
        self.peak = max([self.peak, *(raster.peak for raster, _ in self._bands)])

    def rows(self, first: int, last: int) -> Pixels:
        """All channels of the rows first..last, in the order of `channel_names`."""
        rasters: list[tuple[Raster, int]] = [(self, len(RGB)), *self._bands]
        light = [Raster.rows(raster, first, last)[..., :count] for raster, count in rasters]
        angle = self._sensor.polarizer
        if angle is not None:
            light = [
                through_filter(each, raster.band("stokes", first, last), angle)
                for each, (raster, _) in zip(light, rasters, strict=True)
            ]
        if not self._sensor.stokes:
            return np.concatenate(light, axis=2)
        polarised = rasters[1:] or rasters
        both = [(raster.band("stokes", first, last), count) for raster, count in polarised]
        even = [each[..., :count] for each, count in both]
        odd = [each[..., len(RGB) : len(RGB) + count] for each, count in both]
        circular = [np.zeros_like(each) for each in odd]
        components = [*(light[1:] or light), *even, *odd, *circular]
        return np.concatenate([light[0], *components], axis=2)


def channel_names(sensor: Sensor) -> tuple[str, ...]:
    """Return the channels of a map in the order of its arrays' last axis."""
    components = range(STOKES) if sensor.stokes else range(1)
    if sensor.wavelengths is not None:
        return (*RGB, *(stokes_channel(i, w) for i in components for w in sensor.wavelengths))
    if sensor.stokes:
        return (*RGB, *(f"S{i}.{name}" for i in components for name in RGB))
    return RGB


@dataclass(frozen=True)
class Bands:
    """What a map holds besides what an eye sees, or instead.

    Attributes
    ----------
    scene : Scene
        What its R, G and B show.
    sensor : Sensor
        What is recorded.
    spectrum : list of (BandScene, tuple of float)
        As of `spectral_scenes`.
    """

    scene: Scene
    sensor: Sensor
    spectrum: list[tuple[BandScene, tuple[float, ...]]]

    def rasters(self, canvases: Sequence[Canvas]) -> list[Raster]:
        """Return the pictures of the map."""
        if self.sensor.wavelengths is None and not self.sensor.is_polarised:
            return [Raster(self.scene, canvas) for canvas in canvases]
        return [SensorRaster(self.scene, canvas, self.spectrum, self.sensor) for canvas in canvases]

    def value_range(self, peak: float) -> tuple[float, float]:
        """Bounds of all values, as of `skybake.baking.pixel_type.value_range`."""
        scenes = (self.scene, *(band for band, _ in self.spectrum))
        largest, smallest = zip(*(value_range(each, peak) for each in scenes), strict=True)
        return max(largest), min(smallest)

    def spec(self, spec: MapSpec) -> MapSpec:
        """Return what a file of the map holds, of that of an eye's."""
        sensor = self.sensor
        attributes: dict[str, Attribute] = {}
        if sensor.wavelengths is not None:
            attributes |= spectral_attributes(is_polarised=sensor.stokes)
        if sensor.stokes:
            attributes[STOKES_REFERENCE] = REFERENCE
        if sensor.polarizer is not None:
            attributes[POLARIZER] = math.degrees(sensor.polarizer)
        if sensor.response is not None:
            attributes[CAMERA] = sensor.response.text
            spec = replace(spec, colour_space=CAMERA_SPACE)
        attributes = {**spec.attributes, **attributes}
        return replace(spec, channels=channel_names(sensor), attributes=attributes)

    def warnings(self) -> list[str]:
        """Return what is to know of the map, a line each."""
        return polarisation_warnings(self.scene.planet) if self.sensor.is_polarised else []


def bands_of(scene: Scene) -> Bands:
    """Return what the map of a scene holds besides what an eye sees, or instead.

    Raises
    ------
    InputError
        If the world, the sun or the night cannot be shown so.
    """
    sensor = scene.settings.sensor
    check_sensor(scene.planet, scene.settings)
    if sensor.is_polarised:
        what = "stokes" if sensor.stokes else "polarizer"
        check_polarisation(scene.settings, what)
        if moon_lights_air(scene):
            raise InputError(f"{what}: needs a sky that the Moon does not light, got moonlight")
    seen = scene if sensor.response is None else camera_scene(scene, sensor.response)
    return Bands(seen, sensor, [] if sensor.wavelengths is None else spectral_scenes(scene))


def check_bands(path: Path, settings: MapSettings) -> None:
    """Refuse files that do not hold such channels.

    Raises
    ------
    InputError
        Unless it is an OpenEXR file and, but for a camera's three channels, without parts and
        smaller copies.
    """
    sensor, encoding, lighting = settings.sensor, settings.encoding, settings.lighting
    is_camera = sensor.wavelengths is None and not sensor.is_polarised
    what = "a camera's map" if is_camera else "a map of spectra or polarisation"
    if path.suffix.lower() != ".exr":
        raise InputError(f"{path}: {what} must be in .exr, got {path.suffix!r}")
    if is_camera:
        return
    parts = {
        "mips": encoding.mips,
        "layers": encoding.layers,
        "a separate disc": lighting.sun_disc == "separate",
    }
    for name, is_asked in parts.items():
        if is_asked:
            raise InputError(f"{path}: {what} must be without {name}")
