"""A sky and its sun in the colour space and the scale of a map."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from skybake.colour.response import EyeResponse, Response
from skybake.colour.space import luminance_weights, rgb_from_xyz
from skybake.image.discs import drawn_sun
from skybake.image.horizontal import horizontal_irradiance
from skybake.image.layers import wanted_layers
from skybake.image.luminous import luminous_weights
from skybake.image.outshone import glow_is_outshone, stars_are_outshone, sun_is_outshone
from skybake.image.settings import MapSettings
from skybake.image.stages import Stages
from skybake.image.survey import SURVEY_ROWS, Survey, Unlit, survey_directions, unlit
from skybake.jit.arguments import flatten
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array
from skybake.preset import Planet
from skybake.sky.disc import Disc
from skybake.sky.pixels import allocate_pixels, blacken_negative, fill_directions
from skybake.sky.sky import Sky
from skybake.sky.table import FoldedTable

if TYPE_CHECKING:
    from skybake.clouds.cloudscape import Cloudscape
    from skybake.image.clouded import LitClouds
    from skybake.image.eclipsed import LeftShare
    from skybake.image.moonlit import Moonlit
    from skybake.image.night_glow import NightGlow
    from skybake.night.air import NightAir
    from skybake.night.stars import Stars
    from skybake.sky.stokes_table import FoldedStokes


class Scene:
    """What a map shows, ready to be evaluated at pixels.

    Parameters
    ----------
    planet : Planet
        The world.
    settings : MapSettings
        The observer, the sun, the colour space and the scale.
    workers : Workers, optional
        Threads that do the work.
    stages : Stages, optional
        What makes the table that pixels read, and may keep it.
    sky : Sky, optional
        What is seen, if it is known.
    """

    def __init__(
        self,
        planet: Planet,
        settings: MapSettings,
        workers: Workers = ALL_CPUS,
        stages: Stages | None = None,
        sky: Sky | None = None,
    ) -> None:
        self.planet = planet
        self.settings = settings
        self.workers = workers
        self.stages = stages or Stages()
        self.sky = sky or Sky(
            planet,
            settings.lighting.sun_elevation,
            settings.view.altitude,
            sun_azimuth=settings.lighting.sun_azimuth,
            sun_distance=settings.lighting.sun_distance,
            moon=settings.lighting.moon,
            wavelengths=settings.sensor.colour_wavelengths(),
            method=settings.lighting.method,
            workers=workers,
        )
        self.sky.check_clouds()
        medium = self.sky.medium
        settings.night.check_altitude(settings.view.altitude, medium.r_top - medium.r_bottom)
        if settings.view.below_horizon == "extend":
            from skybake.image.below_horizon import check_horizon

            check_horizon(settings.view, self.sky.medium)
        self.sun_zenith = math.pi / 2.0 - settings.lighting.sun_elevation
        # Of maps that are not rotated, the compass bearing.
        self.sun_bearing = settings.lighting.sun_azimuth - settings.view.rotation

    @cached_property
    def sun(self) -> Disc:
        """The sun's disc, as it is drawn.

        Raises
        ------
        InputError
            If it is to be soft and no such disc fits half floats.
        """
        return drawn_sun(self)

    @property
    def response(self) -> Response:
        """How its three channels respond to light."""
        return EyeResponse()

    @cached_property
    def xyz_weights(self) -> Array:
        """XYZ [cd m⁻²] is the radiance per unit irradiance times these, (wavelength, 3)."""
        return luminous_weights(self.sky)

    @cached_property
    def rgb_weights(self) -> Array:
        """Pixel values are the radiance per unit irradiance times these, (wavelength, 3)."""
        encoding = self.settings.encoding
        to_rgb = rgb_from_xyz(encoding.space).T
        weights: Array = self.xyz_weights @ to_rgb / encoding.white_luminance
        return weights

    @property
    def table(self) -> FoldedTable:
        """The sky as a table of pixel values."""
        return self._surveyed.table

    @cached_property
    def lit_clouds(self) -> tuple[LitClouds, ...]:
        """The world's clouds over the observer in each of the lights that they have."""
        if not self.planet.clouds:
            return ()
        from skybake.image.clouded import lit_clouds

        return lit_clouds(self)

    @property
    def cloudscape(self) -> Cloudscape | None:
        """The clouds in the first of their lights, the sun's unless it is outshone, or None."""
        return self.lit_clouds[0].cloudscape if self.lit_clouds else None

    @cached_property
    def stars(self) -> Stars | None:
        """The stars over the observer, or None where none are seen."""
        night = self.settings.night
        if night.frame is None or not night.shows_stars or self.settings.moonlight.is_alone:
            return None
        if night.stars == "include" and stars_are_outshone(self):
            return None
        from skybake.image.starry import stars_over

        return stars_over(self, night.frame)

    @cached_property
    def night_glow(self) -> NightGlow | None:
        """The light of the sky between the stars, or None where none is seen."""
        night = self.settings.night
        if night.frame is None or not night.shows_glow or self.settings.moonlight.is_alone:
            return None
        if glow_is_outshone(self):
            return None
        from skybake.image.night_glow import glow_over

        return glow_over(self, night.frame)

    def night_air(self, *, has_airglow: bool, has_city: bool) -> NightAir:
        """Return what of the night over the observer no hour changes."""
        return self.stages.night_air(self.sky, has_airglow=has_airglow, has_city=has_city)

    @cached_property
    def stokes(self) -> FoldedStokes:
        """Linear polarisation of the sky, as tables of pixel values."""
        from skybake.sky.stokes_table import fold_stokes

        return fold_stokes(self.stages.stokes_table(self.sky), self.rgb_weights)

    @cached_property
    def moonlit(self) -> Moonlit | None:
        """The Moon over the observer, or None where there is none."""
        shown = self.settings.moonlight
        if shown.moon is None or shown.shown == "exclude" or self.settings.night.is_plate:
            return None
        from skybake.image.moonlit import Moonlit

        return Moonlit(self, shown.moon, self.stages)

    def light_clouds(self) -> None:
        """Solve for the light of clouds, which takes longest, before pixels show them."""
        for lit in self.lit_clouds:
            _ = lit.cloudscape.nodes

    @property
    def clear_survey(self) -> np.ndarray:
        """As `survey`, without clouds and lights of the night."""
        return self._surveyed.pixels

    @cached_property
    def survey(self) -> np.ndarray:
        """Pixel values of a small equirect map of the sky, shape (SURVEY_ROWS, column, 3).

        Raises
        ------
        UnsolvableError
            If its luminance is negative beyond rounding, or not finite.
        """
        if self.cloudscape is None and not self._is_lit_by_night:
            return self.clear_survey
        if self.cloudscape is None:
            return self.evaluate(*survey_directions())
        coarse = self.evaluate(*survey_directions(SURVEY_ROWS // 2))
        return np.repeat(np.repeat(coarse, 2, axis=0), 2, axis=1)

    @property
    def _is_lit_by_night(self) -> bool:
        """Whether the sky has other light than the sun's."""
        has_moonlight = self.moonlit is not None and self.moonlit.lights_air
        return has_moonlight or self.night_glow is not None

    @cached_property
    def is_sunless(self) -> bool:
        """Whether no light of the sun is seen: it is left out, or far below the horizon."""
        return self.settings.moonlight.is_alone or sun_is_outshone(self)

    @cached_property
    def _surveyed(self) -> Survey | Unlit:
        if self.is_sunless:
            return unlit(self.sky)
        return Survey(
            self.sky,
            self.stages,
            rgb_weights=self.rgb_weights,
            xyz_weights=self.xyz_weights,
            luminance=self.luminance,
            evaluate=self._evaluate,
        )

    @property
    def layer_names(self) -> tuple[str, ...]:
        """Layers that a map of the scene holds."""
        wanted = wanted_layers(self.settings)
        if len(wanted) == 1:
            return wanted
        has_moon = self.moonlit is not None and self.moonlit.is_up
        is_there = {"moon": has_moon, "stars": self.stars is not None}
        return tuple(name for name in wanted if is_there.get(name, True))

    @property
    def luminance(self) -> Array:
        """Luminance [cd m⁻²] of pixel values is their product with these, (3,)."""
        encoding = self.settings.encoding
        return encoding.white_luminance * luminance_weights(encoding.space)

    def sun_xyz(self) -> tuple[Array, Array]:
        """XYZ by the sun's disc, on a plane that faces it and on the horizontal. [lx]"""
        normal, horizontal = self.sun.irradiance_per_irradiance()
        weights = self.settings.lighting.sun_strength * self.xyz_weights
        if self.cloudscape is not None:
            weights = weights * self.cloudscape.sun_transmittance()
        return normal @ weights, horizontal @ weights

    def sun_illuminance(self) -> tuple[float, float]:
        """Illuminance by the sun's disc, facing it and on the horizontal. [lx]"""
        normal, horizontal = self.sun_xyz()
        return float(normal[1]), float(horizontal[1])

    def sky_illuminance(self) -> float:
        """Illuminance of a horizontal plane by the sky without the sun's disc. [lx]"""
        return float(self.sky_on_horizontal @ self.luminance)

    @cached_property
    def sky_on_horizontal(self) -> Array:
        """Irradiance of the horizontal by the sky, in pixel values, shape (3,). [sr]"""
        # Without clouds, an eclipse or a night both sides of the sun are alike.
        is_even = self.cloudscape is None and self.sky.eclipse is None and not self._is_lit_by_night
        return horizontal_irradiance(self.evaluate, is_even=is_even)

    def evaluate(self, zenith: Array, azimuth: Array, footprint: Array | float) -> np.ndarray:
        """Pixel values of the sky, see `fill_directions`, shape (row, column, 3).

        Raises
        ------
        UnsolvableError
            As of `survey`.
        """
        if self.cloudscape is None:
            return self.evaluate_clear(zenith, azimuth, footprint)
        return self.evaluate_clouded(zenith, azimuth, footprint)[0]

    def evaluate_clouded(
        self, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Pixel values with clouds, and the share of what is behind them that these hide."""
        from skybake.image.clouded import evaluate_clouded

        return evaluate_clouded(self, zenith, azimuth, footprint)

    def evaluate_clear(self, zenith: Array, azimuth: Array, footprint: Array | float) -> np.ndarray:
        """Pixel values of the sky without clouds, see `evaluate`."""
        if self.is_sunless:
            shape = np.broadcast_shapes(zenith.shape, azimuth.shape)
            pixels = np.zeros((*shape, 3), np.float32)
        else:
            pixels = self.evaluate_sunlight(zenith, azimuth, footprint)
        for light in (self.night_glow, self.moonlit):
            if light is not None:
                light.add(zenith, azimuth, footprint, pixels)
        return pixels

    def evaluate_sunlight(
        self, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> np.ndarray:
        """Pixel values of the light of the sun alone without clouds, see `evaluate`."""
        return self.without_negative(self._evaluate(self.table, zenith, azimuth, footprint))

    def without_negative(self, pixels: np.ndarray) -> np.ndarray:
        """Set pixels of negative luminance, which are rounding, to 0, and return them."""
        weights = self.luminance.astype(np.float32)
        # The least value is found faster than luminances are.
        if pixels.min(initial=0.0) < 0.0 or weights.min() < 0.0:
            blacken_negative(weights, pixels)
        return pixels

    def _evaluate(
        self, table: FoldedTable, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> np.ndarray:
        """Light of the sun, which an eclipse dims."""
        out = self.evaluate_table(table, zenith, azimuth, footprint)
        if self._left_share is not None:
            self._left_share.dim(zenith, azimuth, out, self.workers)
        return out

    def evaluate_table(
        self, table: FoldedTable, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> np.ndarray:
        """Pixel values of a table, of which azimuths are counted from its source."""
        rows, columns = np.broadcast_shapes(zenith.shape, azimuth.shape)
        out = np.empty((rows, columns, 3), np.float32)
        extent = np.atleast_2d(np.asarray(footprint, dtype=float))
        pixels = flatten(table), flatten(zenith), flatten(azimuth), flatten(extent)

        def work(first: int, last: int) -> None:
            scratch = allocate_pixels(table, columns)
            fill_directions(*pixels, first, last, scratch, out[first:last])

        self.workers.run_rows(rows, work, chunk=128 // self.workers.shares(8))
        return out

    @cached_property
    def _left_share(self) -> LeftShare | None:
        """What an eclipse leaves of the light in each direction, if there is one."""
        if self.sky.eclipse is None:
            return None
        from skybake.image.eclipsed import left_share

        return left_share(self.sky.eclipse, self.xyz_weights, self.settings.encoding.space)
