"""Scenes whose three channels are others than those of an eye: wavelengths, or a camera's."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from skybake.colour.camera import CameraResponse
from skybake.colour.response import CameraChannels, Response, Wavelengths
from skybake.errors import InputError
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings
from skybake.image.shared_stages import SharedStages, SpectralStages
from skybake.optics.medium import Array
from skybake.optics.spectrum import hat_means, star_spectrum
from skybake.preset import Planet
from skybake.sky.disc import Disc
from skybake.sky.drawn_disc import DrawnDisc
from skybake.sky.sky import Sky

if TYPE_CHECKING:
    from skybake.image.moonlit import Moonlit
    from skybake.image.night_glow import NightGlow
    from skybake.night.air import NightAir
    from skybake.night.stars import Stars

CHANNELS = 3


def check_sensor(planet: Planet, settings: MapSettings) -> None:
    """Refuse what a map in other channels than an eye's cannot show.

    Raises
    ------
    InputError
        Of a world of three wavelengths.
    """
    sensor = settings.sensor
    if sensor.wavelengths is None and sensor.response is None:
        return
    what = "camera" if sensor.wavelengths is None else "spectral"
    if planet.rendering != "spectral":
        raise InputError(f"{what}: needs a preset of rendering spectral, got {planet.rendering}")


class BandScene(Scene):
    """A scene in three channels that are any sums over the spectrum.

    Parameters
    ----------
    scene : Scene
        The same for an eye, which judges what is seen.
    sky : Sky
        Its sky, at the wavelengths of the sums.
    response : Response
        How channels respond to light.
    weights : ndarray of float64, shape (wavelength, 3)
        Values of channels are the radiance per unit irradiance times these.
    stages : SharedStages
        What makes tables of the sky.
    """

    def __init__(
        self, scene: Scene, sky: Sky, response: Response, weights: Array, stages: SharedStages
    ) -> None:
        # Channels stand in the place of X, Y and Z, which no matrix mixes.
        encoding = replace(scene.settings.encoding, colorspace="xyz", units="nits", ev=None)
        settings = replace(scene.settings, encoding=encoding)
        super().__init__(scene.planet, settings, scene.workers, stages, sky)
        self._seen, self._response, self._weights = scene, response, weights
        self._shared = stages

    @property
    def response(self) -> Response:
        """How its three channels respond to light."""
        return self._response

    @property
    def xyz_weights(self) -> Array:
        """Values of channels are the radiance per unit irradiance times these."""
        return self._weights

    @cached_property
    def is_sunless(self) -> bool:
        """Whether no light of the sun is seen by an eye."""
        return self._seen.is_sunless

    @cached_property
    def stars(self) -> Stars | None:
        """The stars that an eye sees."""
        return None if self._seen.stars is None else self._shared.stars(self)

    @cached_property
    def night_glow(self) -> NightGlow | None:
        """The light between the stars that an eye sees."""
        frame = self.settings.night.frame
        if self._seen.night_glow is None or frame is None:
            return None
        from skybake.image.night_glow import glow_over

        return glow_over(self, frame)

    def night_air(self, *, has_airglow: bool, has_city: bool) -> NightAir:
        """Return what of the night over the observer no hour changes."""
        own = self._shared.night_air(self.sky, has_airglow=has_airglow, has_city=False)
        city = None
        if has_city:
            city = self._seen.night_air(has_airglow=has_airglow, has_city=True)
        return own.seen_by(self._response, city)

    @cached_property
    def moonlit(self) -> Moonlit | None:
        """The Moon that an eye sees."""
        seen = self._seen.moonlit
        if seen is None:
            return None
        from skybake.image.moonlit import Moonlit

        return Moonlit(self, seen.moon, self.stages, seen, self._shared.moon_sky(self, seen.moon))

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
        If the camera sees other wavelengths than the scene has.
    """
    weights = response.weights(scene.sky.wavelengths, *star_spectrum(scene.sky.star))
    white = scene.settings.encoding.white_luminance
    channels = CameraChannels(response, white)
    return BandScene(scene, scene.sky, channels, weights / white, SharedStages(scene.stages))


def spectral_scenes(scene: Scene) -> list[tuple[BandScene, tuple[float, ...]]]:
    """Return the scene at the wavelengths of its spectrum, three at a time.

    Returns
    -------
    list of (BandScene, tuple of float)
        Scenes in spectral radiance [W m⁻² sr⁻¹ nm⁻¹], and the wavelengths of their first
        channels, one to three, ascending. [nm]
    """
    stages = SpectralStages(scene.stages)
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
            for channel in range(CHANNELS):
                # Channels that are left over repeat the last one: clouds need light in all.
                at = min(channel, len(some) - 1)
                weights[first + at, channel] = irradiance[some[at]]
            shown = np.array([*some, *[some[-1]] * (CHANNELS - len(some))])
            response = Wavelengths(wavelengths, shown)
            found.append((BandScene(scene, sky, response, weights, stages), tuple(some)))
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


def moon_lights_air(scene: Scene) -> bool:
    """Whether moonlight that the air scatters is in a map."""
    return scene.moonlit is not None and scene.moonlit.lights_air
