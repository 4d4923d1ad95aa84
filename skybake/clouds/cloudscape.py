"""All layers of clouds over an observer, with their light."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import SURFACE, CloudField
from skybake.clouds.air import ClearAir
from skybake.clouds.airlight import AirTable, Dimming, build_table, fill_lit
from skybake.clouds.compose import compose
from skybake.clouds.layer import Grid, SolvedLayer, channels_to_wavelengths, solve_layer
from skybake.clouds.march import Marching, allocate_march, fill_march
from skybake.clouds.particles import divide_phase
from skybake.clouds.quadrature import double_gauss
from skybake.clouds.shadow import dim_visibility
from skybake.jit.arguments import flatten
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

AT_ONCE = 4096
TAPS = 8
REACH = 2.0


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer: where its clouds are, the voxels of its light, and how it scatters.

    Attributes
    ----------
    field : CloudField
        Where clouds are.
    grid : Grid
        Mean extinction on the voxels of its light.
    phase : ndarray of float64, shape (SCATTERING_ANGLES, channel)
        Phase function of what is scattered once. [sr⁻¹]
    middle : ndarray of float64, shape (SCATTERING_ANGLES,)
        Of what is scattered more often. [sr⁻¹]
    order : int
        Degree to which its light is resolved.
    """

    field: CloudField
    grid: Grid
    phase: Array
    middle: Array
    order: int


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
        Toward the sun: x east, y north, z up.
    weights : ndarray of float64, shape (wavelength, channel)
        See `solve_layer`.
    depth : float
        Optical depth of a step of the eye's rays.
    workers : Workers
        Threads that do the work.
    """

    def __init__(
        self,
        layers: Sequence[Layer],
        air: ClearAir,
        altitude: float,
        sun: Array,
        weights: Array,
        depth: float,
        workers: Workers,
    ) -> None:
        self.layers = sorted(layers, key=lambda each: -each.grid.top)
        self.air = air
        self.altitude = altitude
        self.sun = sun
        self.weights = weights
        self.depth = depth
        self.workers = workers

    @cached_property
    def solved(self) -> list[SolvedLayer]:
        """The light of each layer, from the highest down."""
        out = []
        for layer in self.layers:
            particles = divide_phase(layer.phase, layer.middle, layer.order)
            out.append(
                solve_layer(
                    layer.grid, particles, self.air, self.weights, self.suns(layer), self.workers
                )
            )
        return out

    def suns(self, layer: Layer) -> Array:
        """Heights of the sun that are needed where the observer sees a layer, shape (sun, 3)."""
        del layer
        return self.sun[None]

    @property
    def top(self) -> float:
        """Altitude above which there are no clouds. [km]"""
        return max(layer.field.top for layer in self.layers)

    @cached_property
    def dimming(self) -> Dimming:
        """How clouds change the diffuse light in and below them."""
        quadrature = double_gauss(7, 0.0)
        altitudes, ratios = [], []
        for layer, solved in zip(self.layers, self.solved, strict=True):
            levels = layer.grid.levels
            edges = np.array([layer.grid.base, layer.grid.top])
            clear = []
            for altitude in edges.tolist():
                light = self.air.light_at(altitude, -quadrature.direction, self.sun)
                clear.append(quadrature.weight @ ((light.single + light.diffuse) @ self.weights))
            share = ((levels - edges[0]) / (edges[1] - edges[0]))[:, None]
            between = np.maximum(clear[0] + share * (clear[1] - clear[0]), 1e-300)
            altitudes.append(levels)
            ratios.append(solved.mean_radiance[self._nearest(solved)] / between)
        altitude, ratio = np.concatenate(altitudes), np.concatenate(ratios)
        order = np.argsort(altitude, kind="stable")
        lowest = self.solved[-1]
        at = self._nearest(lowest)
        ground = lowest.down[at] / np.maximum(lowest.down_clear[at], 1e-300)
        return Dimming(altitude[order] + 1e-9 * np.arange(order.size), ratio[order], ground)

    def _nearest(self, solved: SolvedLayer) -> int:
        return int(np.argmin(np.abs(solved.light.sun_mu - self.sun[2])))

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
            given = [
                flatten(each)
                for each in (layer.field, solved.light, solved.leaving)
            ]
            rays = flatten(directions), flatten(distance), flatten(self.sun)

            def work(first: int, last: int, given=given, rays=rays) -> None:  # type: ignore[no-untyped-def]
                dim_visibility(
                    *given,
                    self.air.radius,
                    self.altitude,
                    *rays,
                    first,
                    last,
                    np.empty(3),
                    out,
                )

            self.workers.run_rows(len(directions), work, chunk=AT_ONCE)
        return out

    def lit(
        self, table: AirTable, row: np.ndarray, weight: Array, directions: Array, visible: Floats
    ) -> tuple[Floats, Floats]:
        """Light of the air with clouds around, see `fill_lit`."""
        channels, stretches = self.weights.shape[1], visible.shape[1] - 1
        lit = np.empty((len(directions), stretches + 2, channels), np.float32)
        through = np.empty((len(directions), stretches + 1, channels), np.float32)
        given = [flatten(each) for each in (table, row, weight, self.dimming)]
        rays = flatten(directions), flatten(visible)

        def work(first: int, last: int) -> None:
            fill_lit(
                *given, self.air.radius, self.altitude, *rays, first, last, lit, through
            )

        self.workers.run_rows(len(directions), work, chunk=AT_ONCE)
        return lit, through

    def see(self, directions: Array, pixel: float) -> tuple[Floats, Floats]:
        """Follow rays through every layer, see `fill_march`.

        Returns
        -------
        seen : ndarray of float32, shape (layer, ray, channel)
        passing : ndarray of float32, shape (layer, ray, 3)
        """
        channels = self.weights.shape[1]
        seen = np.empty((len(self.layers), len(directions), channels), np.float32)
        passing = np.empty((len(self.layers), len(directions), 3), np.float32)
        rays, sun = flatten(directions), flatten(self.sun)
        for k, (layer, solved) in enumerate(zip(self.layers, self.solved, strict=True)):
            is_surface = layer.field.kind == SURFACE
            marching = Marching(
                depth=self.depth,
                shortest=0.008 if is_surface else 0.2 * float(layer.grid.spacing[0]),
                longest=0.5 * float(layer.grid.spacing[2]),
                taps=TAPS,
                reach=REACH * float(layer.grid.spacing[2]),
                pixel=pixel,
            )
            given = flatten(layer.field), flatten(solved.light)

            def work(first: int, last: int, given=given, marching=marching, k=k) -> None:  # type: ignore[no-untyped-def]
                fill_march(
                    *given,
                    self.air.radius,
                    self.altitude,
                    rays,
                    sun,
                    marching,
                    first,
                    last,
                    allocate_march(channels, given[1].value.order),
                    seen[k],
                    passing[k],
                )

            self.workers.run_rows(len(directions), work, chunk=AT_ONCE // 8)
        return seen, passing

    def radiance(self, directions: Array) -> Array:
        """Radiance by channel of single rays, shape (ray, channel); each with its own air."""
        table = self.table(directions)
        count = len(directions)
        row = np.zeros((count, 4), np.int64)
        row[:, 0] = np.arange(count)
        weight = np.zeros((count, 4))
        weight[:, 0] = 1.0
        visible = self.visible(directions, table.distance)
        lit, through = self.lit(table, row, weight, directions, visible)
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


def sun_vector(azimuth: float, elevation: float) -> Array:
    """Unit vector toward a compass bearing and an elevation: x east, y north, z up."""
    flat = math.cos(elevation)
    return np.array(
        [flat * math.sin(azimuth), flat * math.cos(azimuth), math.sin(elevation)]
    )
