"""Scenes whose three channels are others than those of an eye: wavelengths, or a camera's."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from skybake.colour.camera import CameraResponse
from skybake.errors import InputError
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings
from skybake.image.stages import Stages
from skybake.optics.medium import Array
from skybake.optics.spectrum import hat_means, star_spectrum
from skybake.preset import Planet
from skybake.sky.disc import Disc
from skybake.sky.drawn_disc import DrawnDisc
from skybake.sky.sky import Sky
from skybake.sky.spectral_table import SpectralTable

if TYPE_CHECKING:
    from skybake.sky.stokes_table import StokesTable

CHANNELS = 3


def check_sensor(planet: Planet, settings: MapSettings) -> None:
    """Refuse what a map in other channels than an eye's cannot show.

    Raises
    ------
    InputError
        Of a world of three wavelengths, clouds, or lights of the night.
    """
    sensor = settings.sensor
    if sensor.wavelengths is None and sensor.response is None:
        return
    what = "camera" if sensor.wavelengths is None else "spectral"
    if planet.rendering != "spectral":
        raise InputError(f"{what}: needs a preset of rendering spectral, got {planet.rendering}")
    if sensor.wavelengths is not None and not all(layer.is_empty for layer in planet.clouds):
        raise InputError(
            f"{what}: needs a world without clouds, whose light is known in three channels, "
            f"got {len(planet.clouds)} layers"
        )


class BandScene(Scene):
    """A scene in three channels that are any sums over the spectrum.

    Parameters
    ----------
    scene : Scene
        The same for an eye.
    sky : Sky
        Its sky, at the wavelengths of the sums.
    weights : ndarray of float64, shape (wavelength, 3)
        Values of channels are the radiance per unit irradiance times these.
    stages : Stages
        What makes tables of the sky.
    """

    def __init__(self, scene: Scene, sky: Sky, weights: Array, stages: Stages) -> None:
        # Channels stand in the place of X, Y and Z, which no matrix mixes.
        encoding = replace(scene.settings.encoding, colorspace="xyz", units="nits", ev=None)
        settings = replace(scene.settings, encoding=encoding)
        super().__init__(scene.planet, settings, scene.workers, stages, sky)
        self._seen, self._weights = scene, weights

    @property
    def xyz_weights(self) -> Array:
        """Values of channels are the radiance per unit irradiance times these."""
        return self._weights

    @property
    def moonlit(self) -> None:
        """No Moon, whose light is known to an eye alone."""

    @property
    def luminance(self) -> Array:
        """Weights by which it is judged whether values are below 0, shape (3,)."""
        return np.full(CHANNELS, 1.0 / CHANNELS)

    @cached_property
    def sun(self) -> Disc:
        """The sun's disc, of the size that it has for an eye."""
        seen, skylight, source = self._seen.sun, self.sky.skylight, self.sky.source
        if not isinstance(seen, DrawnDisc):
            return Disc(skylight, source)
        is_soft = self.settings.lighting.sun_soft
        return DrawnDisc(skylight, source, angular_radius=seen.angular_radius, is_soft=is_soft)

    def evaluate_clear(self, zenith: Array, azimuth: Array, footprint: Array | float) -> np.ndarray:
        """Values of the sky without clouds, none of them below 0."""
        values = super().evaluate_clear(zenith, azimuth, footprint)
        values[values < 0.0] = 0.0
        return values


def camera_scene(scene: Scene, response: CameraResponse) -> BandScene:
    """Return a scene as a camera sees it, in the scale of the map.

    Raises
    ------
    InputError
        If the camera sees other wavelengths than the scene has, or there are lights of the night.
    """
    _check_night("camera", scene)
    weights = response.weights(scene.sky.wavelengths, *star_spectrum(scene.sky.star))
    weights = weights / scene.settings.encoding.white_luminance
    return BandScene(scene, scene.sky, weights, _SharedTables(scene.stages))


def spectral_scenes(scene: Scene) -> list[tuple[BandScene, tuple[float, ...]]]:
    """Return the scene at the wavelengths of its spectrum, three at a time.

    Returns
    -------
    list of (BandScene, tuple of float)
        Scenes in spectral radiance [W m⁻² sr⁻¹ nm⁻¹], and the wavelengths of their first
        channels, one to three, ascending. [nm]

    Raises
    ------
    InputError
        If there are lights of the night.
    """
    _check_night("spectral", scene)
    stages = _SharedTables(scene.stages)
    found = []
    wavelengths = np.concatenate(scene.settings.sensor.groups())
    irradiance = dict(
        zip(
            wavelengths.tolist(),
            scene.sky.star.dilution * hat_means(scene.sky.star.irradiance, wavelengths),
            strict=True,
        )
    )
    for group in scene.settings.sensor.groups():
        sky = _sky_at(scene, group)
        for first in range(0, group.size, CHANNELS):
            some = group[first : first + CHANNELS].tolist()
            weights = np.zeros((group.size, CHANNELS))
            for channel, wavelength in enumerate(some):
                weights[first + channel, channel] = irradiance[wavelength]
            found.append((BandScene(scene, sky, weights, stages), tuple(some)))
    return found


def _sky_at(scene: Scene, wavelengths: Array) -> Sky:
    if np.array_equal(scene.sky.wavelengths, wavelengths):
        return scene.sky
    view, lighting = scene.settings.view, scene.settings.lighting
    return Sky(
        scene.planet,
        lighting.sun_elevation,
        view.altitude,
        sun_azimuth=lighting.sun_azimuth,
        sun_distance=lighting.sun_distance,
        moon=lighting.moon,
        wavelengths=wavelengths,
        method=lighting.method,
        workers=scene.workers,
    )


def _check_night(what: str, scene: Scene) -> None:
    """Refuse lights that are known to an eye alone."""
    lights = {
        "stars": scene.stars is not None,
        "a glow of the night": scene.night_glow is not None,
        "the Moon": "moon" in scene.layer_names or moon_lights_air(scene),
    }
    for name, is_there in lights.items():
        if is_there:
            raise InputError(
                f"{what}: needs a map without lights of the night, which are known to an eye "
                f"alone, got {name}; night off and moon exclude leave them out"
            )


def moon_lights_air(scene: Scene) -> bool:
    """Whether moonlight that the air scatters is in a map."""
    return scene.moonlit is not None and scene.moonlit.lights_air


class _SharedTables(Stages):
    """Stages that trace the rays of a sky once for all of its channels."""

    def __init__(self, stages: Stages) -> None:
        super().__init__(keeps_light_of_clouds=stages.keeps_light_of_clouds)
        self._stages = stages
        self._tables: dict[tuple[int, bool], SpectralTable] = {}
        self._stokes: dict[int, StokesTable] = {}

    def spectral_table(self, sky: Sky, *, finely: bool = False) -> SpectralTable:
        """Light around the observer in all wavelengths."""
        key = id(sky), finely
        if key not in self._tables:
            self._tables[key] = self._stages.spectral_table(sky, finely=finely)
        return self._tables[key]

    def stokes_table(self, sky: Sky) -> StokesTable:
        """Linear polarisation around the observer in all wavelengths."""
        if id(sky) not in self._stokes:
            self._stokes[id(sky)] = super().stokes_table(sky)
        return self._stokes[id(sky)]
