"""All layers of clouds over an observer, with their light."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import SURFACE
from skybake.clouds.air import GROUNDED, ClearAir
from skybake.clouds.airlight import (
    AirRays,
    AirTable,
    build_table,
    shadowed_stretch,
    stretch_ends,
)
from skybake.clouds.compose import compose
from skybake.clouds.dimming import Dimming, dimming_by
from skybake.clouds.directions import fill_places, node_directions, unit_vectors
from skybake.clouds.footprint import rays_per_side, see_pixels
from skybake.clouds.kept_light import KeptLight, keep_light, light_key, read_light
from skybake.clouds.layer import SolvedLayer, channels_to_wavelengths
from skybake.clouds.march import Marching
from skybake.clouds.sight import Eye, dim_rays, light_rays
from skybake.clouds.solve import nearest_sun, solve_layers
from skybake.clouds.sunlit import sunlit_share
from skybake.clouds.unlit import Layer
from skybake.jit.arguments import flatten
from skybake.jit.workers import Workers
from skybake.optics.medium import Array
from skybake.sky.table import horizon_angles

Floats = npt.NDArray[np.float32]

AT_ONCE = 4096
TAPS, REACH = (4, 8), (1.0, 2.0)
"""Samples of the detailed field on the first way to the sun, and its length in voxels of light: of
surfaces, and of voxels whose light is on themselves."""

SHORTEST = 0.012
"""Step through a surface where nothing is known. [km]"""

TABLE_ROWS, TABLE_COLUMNS = 28, 17
"""Rays of clear air: above the horizon and below it each, and from the sun to its opposite."""

NODE_ROWS, NODE_COLUMNS = 96, 256
"""The same, all around, of places for which shadows are looked up."""

SUN_POINTS = 32


class Cloudscape:
    """Layers of clouds, lit, in the air.

    Parameters
    ----------
    layers : sequence of Layer
        In any order.
    air : ClearAir
        What surrounds them.
    altitude : float
        Of the observer. [km]
    sun : ndarray of float64, shape (3,)
        Toward the sun: x east, y north, z up; 0 where the air alone sends light.
    weights : ndarray of float64, shape (wavelength, channel)
        See `solve_layer`.
    depth : float
        Optical depth of a step of the eye's rays.
    alike : float
        As the tolerance of `skybake.clouds.rows.see_rows`.
    workers : Workers
        Threads that do the work.
    keeps_light : bool, optional
        Whether light is kept on disk.
    """

    def __init__(
        self,
        layers: Sequence[Layer],
        air: ClearAir,
        altitude: float,
        sun: Array,
        weights: Array,
        depth: float,
        alike: float,
        workers: Workers,
        *,
        keeps_light: bool = False,
    ) -> None:
        self.layers = sorted(layers, key=lambda each: -each.grid.top)
        self.air = air
        # At the ground itself a ray to the horizon would count as one that hits it.
        self.altitude = max(altitude, GROUNDED)
        self.sun = sun
        self.weights = weights
        self.depth = depth
        self.alike = alike
        self.workers = workers
        self._keeps_light = keeps_light

    @cached_property
    def solved(self) -> list[SolvedLayer]:
        """The light of each layer, from the highest down."""
        if self._kept is not None:
            return self._kept.layers
        given = self.altitude, self.sun, self.weights
        return solve_layers(self.layers, self.air, *given, self.workers)

    @cached_property
    def _kept(self) -> KeptLight | None:
        return read_light(self._key) if self._keeps_light else None

    @cached_property
    def _key(self) -> str:
        return light_key(self.layers, self.air, self.altitude, self.sun, self.weights)

    @property
    def eye(self) -> Eye:
        """Where the observer is."""
        return Eye(self.air.radius, self.altitude, self.sun)

    @property
    def top(self) -> float:
        """Altitude above which there are no clouds. [km]"""
        return max(layer.field.top for layer in self.layers)

    @cached_property
    def dimming(self) -> Dimming:
        """How clouds change the diffuse light in and below them."""
        at = [nearest_sun(solved, self.sun) for solved in self.solved]
        grids = [layer.grid for layer in self.layers]
        return dimming_by(grids, self.solved, at, self.air, self.weights, self.sun)

    @property
    def reflectance(self) -> Array:
        """Of clouds and ground, seen from above, shape (wavelength,)."""
        return channels_to_wavelengths(self.solved[0].reflectance, self.weights)

    def table(self, directions: Array) -> AirTable:
        """Light of clear air along rays, see `build_table`."""
        return build_table(
            self.air,
            self.altitude,
            directions,
            self.sun,
            self.top,
            self.weights,
            self.reflectance,
        )

    def visible(self, directions: Array, distance: Array) -> Floats:
        """Share of the sun along rays, see `dim_visibility`."""
        out = np.ones(distance.shape, np.float32)
        for layer, solved in zip(self.layers, self.solved, strict=True):
            dim_rays(layer.field, solved, self.eye, directions, distance, out, self.workers)
        return out

    def lit(self, rays: AirRays, dimming: Dimming) -> tuple[Floats, Floats]:
        """Light of the air along rays with clouds around, see `fill_lit`."""
        given = rays.table, rays.row, rays.weight, dimming, self.eye
        return light_rays(*given, rays.directions, rays.visible, self.workers)

    def see(
        self, directions: Array, pixel: float, ends: Array | None = None
    ) -> tuple[Floats, Floats]:
        """Follow rays through every layer, up to `ends` if there are any, see `fill_march`.

        Parameters
        ----------
        directions : ndarray of float64, shape (ray, 3)
            Unit vectors.
        pixel : float
            Angle below which nothing needs to be resolved. [rad]

        Returns
        -------
        seen : ndarray of float32, shape (layer, ray, channel)
        passing : ndarray of float32, shape (layer, ray, 3)
        """
        channels = self.weights.shape[1]
        seen = np.empty((len(self.layers), len(directions), channels), np.float32)
        passing = np.empty((len(self.layers), len(directions), 3), np.float32)
        for k, (layer, solved) in enumerate(zip(self.layers, self.solved, strict=True)):
            is_surface = layer.field.kind == SURFACE
            # Voxels of light are finer than those of the field there.
            is_deck = layer.grid.extinction.shape[1:] == (1, 1)
            across = float(layer.grid.spacing[2])
            count = rays_per_side(layer.field, self.altitude, pixel)
            marching = Marching(
                depth=self.depth,
                shortest=SHORTEST if is_surface else 0.2 * float(layer.grid.spacing[0]),
                longest=0.5 * across,
                taps=0 if is_deck or not self.sun.any() else TAPS[not is_surface],
                reach=REACH[not is_surface] * across,
                pixel=pixel,
            )
            given = layer.field, solved.light, self.eye, directions, marching
            see_pixels(*given, (seen[k], passing[k]), self.workers, count, ends)
        return seen, passing

    @cached_property
    def nodes(self) -> tuple[Floats, Floats, Array]:
        """Light of the air in all directions: `lit`, `through` and distances at nodes."""
        if self._kept is not None:
            return self._kept.lit, self._kept.through, self._kept.distance
        rays, distance = self.node_rays
        made = *self.lit(rays, self.dimming), distance
        if self._keeps_light:
            keep_light(self._key, KeptLight(self.solved, *made))
        return made

    @cached_property
    def sunlit_air(self) -> Floats:
        """Light that the air scattered once, as `lit` at the nodes, see `sunlit_share`."""
        rays, _ = self.node_rays
        return self.lit(rays._replace(table=sunlit_share(rays.table)), self.dimming)[0]

    @cached_property
    def node_rays(self) -> tuple[AirRays, Array]:
        """Rays of the nodes, and the distances along them."""
        sun_azimuth = math.atan2(self.sun[0], self.sun[1])
        given = self.first, self.horizon, TABLE_ROWS, TABLE_COLUMNS
        zenith, azimuth = node_directions(*given, is_half=True)
        table = self.table(unit_vectors(zenith, azimuth + sun_azimuth))
        zenith, azimuth = node_directions(
            self.first, self.horizon, NODE_ROWS, NODE_COLUMNS, is_half=False
        )
        directions = unit_vectors(zenith, azimuth)
        row, weight = np.empty((zenith.size, 4), np.int64), np.empty((zenith.size, 4))
        fill_places(zenith, azimuth - sun_azimuth, *given, True, row, weight)
        begin, end, _ = shadowed_stretch(self.altitude, directions, self.air.radius, self.top)
        distance = stretch_ends(begin, end)
        visible = self.visible(directions, distance)
        return AirRays(table, row, weight, directions, visible), distance

    def find_places(
        self, zenith: Array, bearing: Array, row: npt.NDArray[np.int64], weight: Array
    ) -> None:
        """Write the nodes between which rays are, and their weights, both (ray, 4)."""
        angles = [flatten(np.require(each, float, ["C", "A", "W"])) for each in (zenith, bearing)]
        given = self.first, self.horizon, NODE_ROWS, NODE_COLUMNS
        fill_places(*angles, *given, False, row, weight)

    @property
    def horizon(self) -> float:
        """Zenith angle of the ground's edge. [rad]"""
        return horizon_angles(self._place, self.air.radius, self._roof)[1]

    @property
    def first(self) -> float:
        """Zenith angle at which the atmosphere begins. [rad]"""
        return horizon_angles(self._place, self.air.radius, self._roof)[0]

    @property
    def _place(self) -> float:
        return self.air.radius + self.altitude

    @property
    def _roof(self) -> float:
        return self.air.atmosphere.medium.r_top

    def put_into(
        self, total: Floats, zenith: Array, bearing: Array, seen: Floats, passing: Floats
    ) -> tuple[Floats, Floats]:
        """Put clouds into the light of a clear sky.

        Parameters
        ----------
        total : ndarray of float32, shape (ray, channel)
            Radiance without clouds.
        zenith, bearing : ndarray of float64, shape (ray,)
            Directions. [rad]
        seen, passing : ndarray of float32
            What is seen of clouds there, see `see`.

        Returns
        -------
        light : ndarray of float32, shape (ray, channel)
        opacity : ndarray of float32, shape (ray,)
            Share of what is behind that clouds hide.
        """
        lit, through, distance = self.nodes
        row, weight = np.empty((zenith.size, 4), np.int64), np.empty((zenith.size, 4))
        out = np.empty_like(total)
        opacity = np.empty(zenith.size, np.float32)
        self.find_places(zenith, bearing, row, weight)
        flat = [flatten(each) for each in (total, row, weight, distance, lit, through, seen)]

        def work(first: int, last: int) -> None:
            compose(*flat, passing, first, last, out, opacity)

        self.workers.run_rows(zenith.size, work, chunk=AT_ONCE)
        return out, opacity

    def transmittance(self, zenith: Array, bearing: Array) -> Floats:
        """Share of a sharp image, such as the sun's disc, that all layers let through."""
        _, passing = self.see(unit_vectors(zenith, bearing), 0.0)
        through: Floats = passing[:, :, 1].prod(axis=0)
        return through

    def sun_transmittance(self) -> float:
        """Share of the sun's disc that all layers let through, on average over it."""
        radius = self.air.sun_radius * np.sqrt((np.arange(SUN_POINTS) + 0.5) / SUN_POINTS)
        turn = 2.4 * np.arange(SUN_POINTS)
        zenith = math.acos(float(np.clip(self.sun[2], -1.0, 1.0)))
        bearing = math.atan2(self.sun[0], self.sun[1])
        beside = radius * np.sin(turn) / max(math.sin(zenith), 1e-3)
        points = self.transmittance(zenith + radius * np.cos(turn), bearing + beside)
        return float(points.mean())

    def radiance(self, directions: Array) -> Array:
        """Radiance by channel of single rays, shape (ray, channel); each with its own air."""
        table = self.table(directions)
        count = len(directions)
        row = np.zeros((count, 4), np.int64)
        row[:, 0] = np.arange(count)
        weight = np.zeros((count, 4))
        weight[:, 0] = 1.0
        visible = self.visible(directions, table.distance)
        rays = AirRays(table, row, weight, directions, visible)
        lit, through = self.lit(rays, self.dimming)
        seen, passing = self.see(directions, 0.0)
        out = np.empty((count, self.weights.shape[1]), np.float32)
        compose(
            table.total.astype(np.float32),
            row,
            weight,
            table.distance,
            lit,
            through,
            seen,
            passing,
            0,
            count,
            out,
            np.empty(count, np.float32),
        )
        return out.astype(float)
