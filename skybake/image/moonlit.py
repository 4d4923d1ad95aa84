"""The Moon in maps: its light in the air and on the ground, and its disc."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property

import numpy as np
import numpy.typing as npt

from skybake.colour.observer import xyz_weights
from skybake.colour.space import rgb_from_xyz
from skybake.ephemeris.lit_moon import LitMoon
from skybake.image.discs import CELLS_AT_ONCE
from skybake.image.layers import Pixels
from skybake.image.luminous import luminous_weights
from skybake.image.scene import Scene
from skybake.image.stages import Stages
from skybake.night.earth_shadow import EarthShadow, is_reached
from skybake.night.moon_disc import MoonDisc
from skybake.optics.medium import Array
from skybake.optics.moonlight import earthshine, moon_share
from skybake.optics.spectrum import star_at, star_spectrum
from skybake.projection.cells import Cells
from skybake.sky.disc import RINGS, SPOKES, Disc
from skybake.sky.sky import Sky
from skybake.sky.table import FoldedTable

SEEN_SHARE = 1e-4
"""Share of the darkest light of the sky that moonlight must be to be scattered."""

ZENITH_SHARE = 0.06
"""Luminance of the sky, away from what lights it, over the illuminance that lights it. [sr⁻¹]"""

HIGH, DARKEST_SHARE = math.radians(10.0), 0.005
"""Elevation from which on the Moon lights all of the sky, and of that the darkest part [sr⁻¹]."""

LOWEST = math.radians(-9.0)
"""Elevation below which the Moon lights the air less than the night's sky does a thousandfold."""


class Moonlit:
    """The Moon over a scene.

    Parameters
    ----------
    scene : Scene
        What is shown.
    moon : LitMoon
        The Moon.
    stages : Stages
        What makes tables.
    eye : Moonlit, optional
        The same for an eye, of a scene in other channels; that judges what is seen.
    sky : Sky, optional
        With the Moon in the place of the sun, if it is known.

    Attributes
    ----------
    moon : LitMoon
        As given.
    bearing, zenith, angular_radius : float
        Of its disc, on a map that may be rotated. [rad]
    sky : Sky
        With the Moon in the place of the sun.
    is_eclipsed : bool
        Whether Earth's shadow is on it.
    """

    def __init__(
        self,
        scene: Scene,
        moon: LitMoon,
        stages: Stages,
        eye: Moonlit | None = None,
        sky: Sky | None = None,
    ) -> None:
        self._scene, self.moon, self._stages, self._eye = scene, moon, stages, eye
        settings = scene.settings
        self.bearing = moon.azimuth - settings.view.rotation
        self.zenith = math.pi / 2.0 - moon.elevation
        self.angular_radius = moon.angular_radius
        self.sky = sky or moon_sky(scene, moon)
        self.is_eclipsed = is_reached(moon, self.sky.star.angular_radius)
        self._disc = MoonDisc(moon, EarthShadow(self.sky, moon) if self.is_eclipsed else None)

    @cached_property
    def xyz_weights(self) -> Array:
        """XYZ [cd m⁻²] is the radiance per unit irradiance of the whole Moon times these."""
        return self._weights(self._share)

    @cached_property
    def irradiance(self) -> Array:
        """Above the air, dimmed by an eclipse, shape (wavelength,). [W m⁻² nm⁻¹]"""
        share = self._share(self.sky.wavelengths) * self._disc.eclipsed_share
        light: Array = share * self.sky.irradiance
        return light

    def _share(self, wavelengths: Array) -> Array:
        """Irradiance by the whole Moon over that of the sun at it."""
        moon = self.moon
        longitude, latitude = moon.sub_observer
        sun_longitude, _ = moon.sub_solar
        share: Array = moon_share(
            moon.phase_angle,
            wavelengths,
            moon.distance,
            sun_longitude=sun_longitude,
            latitude=latitude,
            longitude=longitude,
        )
        return share

    @cached_property
    def _earthshine_weights(self) -> Array:
        """XYZ [cd m⁻²] of the disc in the light of Earth is the transmittance times these."""
        moon = self.moon
        return self._weights(lambda nodes: earthshine(moon.phase_angle, nodes, moon.distance))

    def _weights(self, share: Callable[[Array], Array]) -> Array:
        """Weights for light that is a share of the sunlight at the Moon, (wavelength, 3)."""
        sky = self.sky
        nodes, sunlight = star_spectrum(star_at(sky.planet.star, sky.sun_distance))
        lit = share(nodes) * sunlight
        if sky.planet.rendering == "spectral":
            return self._scene.response.weights(sky.wavelengths, nodes, lit)
        # Three wavelengths stand for R, G and B of the sun: as much of it as is left in sum.
        whole = np.sort(np.array(sky.planet.wavelengths, dtype=float))
        left = xyz_weights(whole, nodes, lit)[:, 1].sum()
        share_of_light = left / xyz_weights(whole, nodes, sunlight)[:, 1].sum()
        weights: Array = luminous_weights(sky) * share_of_light
        return weights

    @property
    def _to_rgb(self) -> Array:
        encoding = self._scene.settings.encoding
        return rgb_from_xyz(encoding.space).T / encoding.white_luminance

    @cached_property
    def air_weights(self) -> Array:
        """XYZ of light by the Moon as a whole, dimmed by an eclipse."""
        weights: Array = self.xyz_weights * self._disc.eclipsed_share[:, None]
        return weights

    @cached_property
    def illuminance_above(self) -> float:
        """Of a plane above the air that faces it. [lx]"""
        return float(self.air_weights[:, 1].sum())

    @property
    def eclipsed_share(self) -> float:
        """Share of its light that Earth's shadow leaves."""
        if not self.is_eclipsed:
            return 1.0
        return self.illuminance_above / float(self.xyz_weights[:, 1].sum())

    @property
    def least_luminance(self) -> float:
        """Luminance that a clear sky has everywhere by it, or a bound below. [cd m⁻²]"""
        return DARKEST_SHARE * self.illuminance_above if self.moon.elevation > HIGH else 0.0

    @cached_property
    def lights_air(self) -> bool:
        """Whether its scattered light can be seen beside that of sun and night."""
        if self._eye is not None:
            return self._eye.lights_air
        if self._scene.settings.moonlight.is_alone:
            return True
        if self.moon.elevation < LOWEST and self._scene.sky.skylight.radius < self._top:
            return False
        least = float((self._scene.clear_survey @ self._scene.luminance).min())
        return ZENITH_SHARE * self.illuminance_above > SEEN_SHARE * least

    @cached_property
    def rgb_weights(self) -> Array:
        """As `Scene.rgb_weights`, of what scatters the light of the Moon."""
        weights: Array = self.air_weights @ self._to_rgb
        return weights

    @property
    def _top(self) -> float:
        return self._scene.sky.medium.r_top

    @property
    def is_up(self) -> bool:
        """Whether a part of its disc is above the true horizon."""
        radius = self._scene.sky.skylight.radius
        horizon = math.pi - math.asin(min(self._scene.sky.medium.r_bottom / radius, 1.0))
        return self.zenith - self.angular_radius < horizon

    @cached_property
    def _table(self) -> FoldedTable:
        return self._stages.folded_table(self.sky, self.rgb_weights)

    def add(self, zenith: Array, azimuth: Array, footprint: Array | float, out: Pixels) -> None:
        """Add its scattered light to pixels, whose azimuths are counted from the sun."""
        if not self.lights_air:
            return
        turned = azimuth + (self._scene.settings.lighting.sun_azimuth - self.moon.azimuth)
        pixels = self._scene.evaluate_table(self._table, zenith, turned, footprint)
        out += self._scene.without_negative(pixels)

    def disc_flux(self, cells: Cells) -> Array:
        """Pixel value times solid angle that each cell of the disc adds, (cell, 3). [sr]"""
        flux = np.empty((cells.distance.size, 3))
        sunlit, by_earth = self.xyz_weights @ self._to_rgb, self._earthshine_weights @ self._to_rgb
        air = Disc(self.sky.skylight, self.sky.source)
        rotation = self._scene.settings.view.rotation
        for first in range(0, len(flux), CELLS_AT_ONCE):
            part = slice(first, first + CELLS_AT_ONCE)
            zenith, bearing = cells.zenith[part], cells.azimuth[part] + rotation
            size = cells.solid_angle[part]
            light = self._disc.light(zenith, bearing, cells.distance[part], np.sqrt(size))
            passing = air.transmittance(zenith)
            seen = (light.sunlit * passing) @ sunlit
            seen += light.albedo[:, None] * (passing @ by_earth)
            flux[part] = seen * size[:, None]
            if self._scene.cloudscape is not None:
                flux[part] *= self._scene.cloudscape.transmittance(zenith, bearing)[:, None]
        return flux

    def hides(self, vectors: Array) -> npt.NDArray[np.bool_]:
        """Whether its disc is in front of directions, unit vectors of shape (n, 3)."""
        hidden: npt.NDArray[np.bool_] = vectors @ np.array(self.moon.direction) > math.cos(
            self.angular_radius
        )
        return hidden

    def xyz(self) -> tuple[Array, Array]:
        """XYZ by the disc, on a plane that faces it and on the horizontal. [lx]"""
        normal, horizontal = self._passing
        weights = self.air_weights
        if self._scene.cloudscape is not None:
            where = np.array([self.zenith]), np.array([self.moon.azimuth])
            weights = weights * self._scene.cloudscape.transmittance(*where)
        return normal @ weights, horizontal @ weights

    @cached_property
    def _passing(self) -> tuple[Array, Array]:
        """Shares of its light that arrive, facing it and on the horizontal, (wavelength,)."""
        ring = (np.arange(RINGS) + 0.5) / RINGS * self.angular_radius
        spoke = 2.0 * math.pi * (np.arange(SPOKES) + 0.5) / SPOKES
        distance, around = (grid.ravel() for grid in np.meshgrid(ring, spoke, indexing="ij"))
        # Spokes are counted from the one that points away from the zenith.
        mu, sine = math.cos(self.zenith), math.sin(self.zenith)
        cosine = np.cos(distance) * mu - np.sin(distance) * sine * np.cos(around)
        zenith = np.arccos(np.clip(cosine, -1.0, 1.0))
        away = np.cos(distance) * sine + np.sin(distance) * mu * np.cos(around)
        bearing = self.moon.azimuth + np.arctan2(np.sin(distance) * np.sin(around), away)
        size = np.sin(distance)
        extent = np.sqrt(2.0 * math.pi * size / SPOKES * self.angular_radius / RINGS)
        weight = self._disc.light(zenith, bearing, distance, extent).sunlit * size[:, None]
        # Points are too few for the light of a thin crescent, but not for its colour.
        total = weight.sum(axis=0)
        weight = np.where(total > 0.0, weight / np.where(total > 0.0, total, 1.0), 1.0 / size.size)
        light = weight * Disc(self.sky.skylight, self.sky.source).transmittance(zenith)
        return light.sum(axis=0), (light * np.maximum(cosine, 0.0)[:, None]).sum(axis=0)


def moon_sky(scene: Scene, moon: LitMoon) -> Sky:
    """Return the sky of a scene with the Moon in the place of the sun."""
    lighting = scene.settings.lighting
    return Sky(
        scene.planet,
        moon.elevation,
        scene.settings.view.altitude,
        sun_azimuth=moon.azimuth,
        sun_distance=moon.sun_distance or lighting.sun_distance,
        wavelengths=scene.sky.wavelengths,
        method=lighting.method,
        workers=scene.workers,
    )
