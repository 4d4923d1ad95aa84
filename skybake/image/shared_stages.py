"""Stages of skies that are seen in many channels, three at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skybake.image.scene import Scene
from skybake.image.settings import Clouds
from skybake.image.stages import Stages
from skybake.optics.medium import Array
from skybake.sky.sky import Sky
from skybake.sky.spectral_table import SpectralTable

if TYPE_CHECKING:
    from skybake.clouds.at_wavelengths import CloudsAtNodes
    from skybake.clouds.cloudscape import Cloudscape
    from skybake.ephemeris.lit_moon import LitMoon
    from skybake.night.air import NightAir
    from skybake.night.stars import Stars
    from skybake.sky.stokes_table import StokesTable


class SharedStages(Stages):
    """Stages that do for all channels of a sky what these share, once."""

    def __init__(self, stages: Stages) -> None:
        super().__init__(keeps_light_of_clouds=stages.keeps_light_of_clouds)
        self._stages = stages
        self._tables: dict[tuple[int, bool], SpectralTable] = {}
        self._stokes: dict[int, StokesTable] = {}
        self._stars: dict[int, Stars] = {}
        self._night_air: dict[int, NightAir] = {}
        self._moon_skies: dict[int, Sky] = {}

    def spectral_table(self, sky: Sky, *, finely: bool = False) -> SpectralTable:
        """Light around the observer in all wavelengths."""
        key = id(sky), finely
        if key not in self._tables:
            self._tables[key] = self._stages.spectral_table(sky, finely=finely)
        return self._tables[key]

    def stars(self, scene: Scene) -> Stars | None:
        """Return the stars over a scene's observer."""
        frame, key = scene.settings.night.frame, id(scene.sky)
        if key not in self._stars and frame is not None:
            from skybake.image.starry import stars_over

            self._stars[key] = stars_over(scene, frame)
        return self._stars.get(key)

    def night_air(self, sky: Sky, *, has_airglow: bool, has_city: bool) -> NightAir:
        """Return what of the night over the observer no hour changes."""
        if id(sky) not in self._night_air:
            self._night_air[id(sky)] = self._stages.night_air(
                sky, has_airglow=has_airglow, has_city=has_city
            )
        return self._night_air[id(sky)]

    def moon_sky(self, scene: Scene, moon: LitMoon) -> Sky:
        """Return the sky of a scene with the Moon in the place of the sun."""
        from skybake.image.moonlit import moon_sky

        key = id(scene.sky)
        if key not in self._moon_skies:
            self._moon_skies[key] = moon_sky(scene, moon)
        return self._moon_skies[key]

    def stokes_table(self, sky: Sky) -> StokesTable:
        """Linear polarisation around the observer in all wavelengths."""
        if id(sky) not in self._stokes:
            self._stokes[id(sky)] = super().stokes_table(sky)
        return self._stokes[id(sky)]


class SpectralStages(SharedStages):
    """Stages that solve for the light of clouds at few of a sky's wavelengths."""

    def __init__(self, stages: Stages) -> None:
        super().__init__(stages)
        self._clouds: dict[int, CloudsAtNodes | None] = {}

    def cloudscape(self, sky: Sky, weights: Array, clouds: Clouds) -> Cloudscape | None:
        """Return clouds in some wavelengths, whose light is solved for once for all of them."""
        if id(sky) not in self._clouds:
            self._clouds[id(sky)] = self._clouds_at_nodes(sky, clouds)
        at_nodes = self._clouds[id(sky)]
        return None if at_nodes is None else at_nodes.with_channels(weights)

    def _clouds_at_nodes(self, sky: Sky, clouds: Clouds) -> CloudsAtNodes | None:
        # Clear skies do not wait for kernels of clouds.
        from skybake.clouds.at_wavelengths import CloudsAtNodes, nodes_among

        nodes = nodes_among(sky.wavelengths)
        cloudscape = super().cloudscape(sky, np.eye(sky.wavelengths.size)[:, nodes], clouds)
        if cloudscape is None:
            return None
        return CloudsAtNodes(cloudscape, sky.wavelengths, nodes)
