"""A world's clouds in the light of its sun, its Moon and its night, which add up."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from skybake.clouds.build import build_cloudscape
from skybake.clouds.cloudscape import Cloudscape
from skybake.image.cloudy import CloudsOver
from skybake.image.layers import Pixels
from skybake.optics.medium import Array

if TYPE_CHECKING:
    from skybake.image.scene import Scene
    from skybake.night.glow_air import GlowAir

Evaluate = Callable[[Array, Array, Array | float], np.ndarray]


class LitClouds(NamedTuple):
    """Clouds in one light.

    Attributes
    ----------
    cloudscape : Cloudscape
        The clouds.
    clear : callable
        Pixels of that light without clouds, as of `Scene.evaluate`.
    """

    cloudscape: Cloudscape
    clear: Evaluate


def lit_clouds(scene: Scene) -> tuple[LitClouds, ...]:
    """Return a scene's clouds once for each light that shines on them, none where no cloud is."""
    lit: list[tuple[Cloudscape | None, Evaluate]] = []
    if not scene.is_sunless:
        lit.append((sun_cloudscape(scene), scene.evaluate_sunlight))
    moon, glow = scene.moonlit, scene.night_glow
    if moon is not None and moon.lights_air:
        clouds = scene.stages.cloudscape(moon.sky, moon.air_weights, scene.settings.clouds)
        lit.append((clouds, _added_by(moon.add)))
    if glow is not None:
        from skybake.night.glow_air import GlowAir

        in_glow = _clouds_in_glow(scene, GlowAir(scene.sky, glow.dome))
        lit.append((in_glow, _added_by(glow.add)))
    return tuple(LitClouds(clouds, clear) for clouds, clear in lit if clouds is not None)


def sun_cloudscape(scene: Scene) -> Cloudscape | None:
    """Return a scene's clouds in the light of the sun."""
    # Of no exposure, so that all share the light.
    weights = scene.xyz_weights
    if scene.sky.eclipse is not None:
        weights = weights * scene.sky.eclipse.share_for_clouds[:, None]
    return scene.stages.cloudscape(scene.sky, weights, scene.settings.clouds)


def evaluate_clouded(
    scene: Scene, zenith: Array, azimuth: Array, footprint: Array | float
) -> tuple[Pixels, np.ndarray]:
    """Pixels with clouds, (row, column, 3), and the share of what is behind that these hide.

    Parameters are those of `Scene.evaluate`.
    """
    first, *others = (
        _over(scene, lit).apart(lit.clear(zenith, azimuth, footprint), zenith, azimuth, footprint)
        for lit in scene.lit_clouds
    )
    pixels, hidden = first
    for more, _ in others:
        pixels += more
    return pixels, hidden


def _over(scene: Scene, lit: LitClouds) -> CloudsOver:
    encoding = scene.settings.encoding
    return CloudsOver(
        lit.cloudscape,
        lit.clear,
        scene.settings.lighting.sun_azimuth,
        encoding.space,
        encoding.white_luminance,
    )


def _clouds_in_glow(scene: Scene, air: GlowAir) -> Cloudscape | None:
    return build_cloudscape(
        scene.planet.clouds,
        scene.sky,
        air.colours,
        time=scene.settings.clouds.time,
        quality=scene.settings.clouds.quality,
        workers=scene.workers,
        keeps_light=False,
        air=air,
    )


def _added_by(add: Callable[[Array, Array, Array | float, Pixels], None]) -> Evaluate:
    """Return what makes pixels of a light that is added to others."""

    def evaluate(zenith: Array, azimuth: Array, footprint: Array | float) -> Pixels:
        pixels = np.zeros((*np.broadcast_shapes(zenith.shape, azimuth.shape), 3), np.float32)
        add(zenith, azimuth, footprint, pixels)
        return pixels

    return evaluate
