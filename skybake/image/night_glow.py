"""The light of the sky between the stars, in maps."""

from __future__ import annotations

import numpy as np

from skybake.colour.space import rgb_from_xyz
from skybake.ephemeris.celestial import CelestialFrame
from skybake.image.layers import Pixels
from skybake.image.scene import Scene
from skybake.jit.arguments import flatten
from skybake.night.air import ABOVE, BEARINGS
from skybake.night.dome import NightDome
from skybake.night.dome_pixels import fill_dome
from skybake.optics.medium import Array

ROWS_AT_ONCE = 16


def glow_over(scene: Scene, frame: CelestialFrame) -> NightGlow:
    """Return the glow of a scene's night, whose stars stand in a frame."""
    night = scene.settings.night
    airglow = night.airglow if frame.planet == "earth" else 0.0
    air = scene.night_air(has_airglow=airglow > 0.0, has_city=night.city > 0.0)
    dome = NightDome(
        scene.sky,
        frame,
        air,
        airglow=airglow,
        zodiacal=night.zodiacal,
        city=night.city,
        city_azimuth=night.city_azimuth,
    )
    return NightGlow(scene, dome, airglow)


class NightGlow:
    """Pixel values of the night's sky.

    Parameters
    ----------
    scene : Scene
        What is shown.
    dome : NightDome
        Its light.
    airglow : float
        Factor of airglow in it.

    Attributes
    ----------
    dome : NightDome
        As given.
    airglow : float
        As given.
    illuminance : float
        Of a horizontal plane, without clouds. [lx]
    zenith_luminance : float
        [cd m⁻²]
    """

    def __init__(self, scene: Scene, dome: NightDome, airglow: float) -> None:
        self.airglow = airglow
        self.illuminance, self.zenith_luminance = dome.illuminance, dome.zenith_luminance
        encoding = scene.settings.encoding
        to_rgb = rgb_from_xyz(encoding.space).T / encoding.white_luminance
        self._table = (dome.xyz @ to_rgb).astype(np.float32)
        self._horizon, self._workers = dome.zenith_horizon, scene.workers
        self.dome = dome
        self._sun_azimuth = scene.settings.lighting.sun_azimuth

    def add(self, zenith: Array, azimuth: Array, footprint: Array | float, out: Pixels) -> None:
        """Add it to pixels, of which azimuths are counted from the sun; see `Scene.evaluate`."""
        extent = np.atleast_2d(np.asarray(footprint, dtype=float))
        bearing = np.ascontiguousarray(azimuth + self._sun_azimuth)
        places = [
            flatten(each)
            for each in (np.ascontiguousarray(zenith), bearing, np.ascontiguousarray(extent))
        ]
        table = flatten(self._table)

        def work(first: int, last: int) -> None:
            spare = np.empty((BEARINGS + 1, 3), np.float32)
            fill_dome(table, ABOVE, self._horizon, *places, first, last, spare, out[first:last])

        self._workers.run_rows(len(out), work, chunk=ROWS_AT_ONCE)
