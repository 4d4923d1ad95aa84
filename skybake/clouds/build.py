"""A world's layers of clouds, ready to be looked at."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.cloud_fields.build import build_field
from skybake.cloud_fields.field import LINEAR, SURFACE, CloudField
from skybake.cloud_fields.light_grid import light_grid
from skybake.clouds.air import ClearAir
from skybake.clouds.cloudscape import Cloudscape
from skybake.clouds.directions import sun_vector
from skybake.clouds.layer import Grid
from skybake.clouds.unlit import Layer
from skybake.jit.workers import Workers
from skybake.optics.medium import Array
from skybake.optics.phase import build_phase
from skybake.preset.clouds_model import CloudLayer
from skybake.sky.sky import Sky


class Quality(NamedTuple):
    """How finely clouds are resolved.

    Attributes
    ----------
    columns : int
        Voxels of light across the tile of a generated layer.
    work : float
        Of the ordinates, for the order that is chosen: voxels times `_WORK`.
    depth : float
        Optical depth of a step of the eye's rays, without forward peaks.
    """

    columns: int
    work: float
    depth: float


QUALITIES = {
    "draft": Quality(96, 3e8, 0.6),
    "normal": Quality(160, 9e8, 0.4),
    "high": Quality(224, 8e9, 0.2),
}

_WORK = {2: 624, 3: 1280, 5: 5760, 7: 17408}
"""By order: directions times what each costs."""

LAYERS_OF_DECK = 512
VOXEL_DEPTH = 0.05
"""Optical depth, without forward peaks, of the voxels of a deck that is the same everywhere."""

MIDDLE = 550.0
"""Wavelength whose phase function holds for what is scattered more than once. [nm]"""


def build_cloudscape(
    clouds: tuple[CloudLayer, ...],
    sky: Sky,
    weights: Array,
    *,
    time: float = 0.0,
    quality: str = "normal",
    workers: Workers,
) -> Cloudscape | None:
    """Build what an observer sees of a world's clouds.

    Parameters
    ----------
    clouds : tuple of CloudLayer
        The world's.
    sky : Sky
        The observer, the air and the sun.
    weights : ndarray of float64, shape (wavelength, channel)
        By which radiance per unit irradiance becomes the light of a channel, at least 0.
    time : float, optional
        For which clouds have drifted. [s]
    quality : {"draft", "normal", "high"}, optional
        How finely their light is resolved.
    workers : Workers
        Threads that do the work.

    Returns
    -------
    Cloudscape or None
        None where there is no cloud.

    Raises
    ------
    InputError
        If a layer cannot be used.
    """
    fields = [(layer, build_field(layer, time)) for layer in clouds]
    fields = [(layer, field) for layer, field in fields if field.top > field.base]
    if not fields:
        return None
    chosen = QUALITIES[quality]
    layers = [_layer(layer, field, sky, weights, chosen, workers) for layer, field in fields]
    air = ClearAir(sky.atmosphere, sky.source.angular_radius, workers, sky.table_method)
    sun = sun_vector(sky.sun_azimuth, sky.sun_elevation)
    return Cloudscape(layers, air, sky.altitude, sun, weights, chosen.depth, workers)


def _layer(
    layer: CloudLayer,
    field: CloudField,
    sky: Sky,
    weights: Array,
    quality: Quality,
    workers: Workers,
) -> Layer:
    middle = build_phase(layer.phase, np.array([MIDDLE]))[:, 0]
    share = weights / weights.sum(axis=0)
    phase = build_phase(layer.phase, sky.wavelengths) @ share
    grid = _grid(field, quality, workers)
    if is_same_everywhere(grid):
        return Layer(field, _deck(grid), phase, middle, max(_WORK))
    work = grid.extinction.size / quality.work
    orders = [order for order, cost in _WORK.items() if cost * work <= 1.0]
    return Layer(field, grid, phase, middle, max(orders, default=min(_WORK)))


def _grid(field: CloudField, quality: Quality, workers: Workers) -> Grid:
    if field.kind != SURFACE:
        # Values between voxels are linear again when they are looked up, not twice.
        beyond = 0.5 * field.spacing[0] if field.kind == LINEAR else 0.0
        return Grid(field.values, field.spacing, field.base + float(beyond))
    across = field.period / quality.columns
    height = min(0.5 * float(across.min()), (field.top - field.base) / 12.0)
    made = light_grid(field, np.array([height, across[1], across[0]]), workers)
    return Grid(made.values, made.spacing, made.base)


def is_same_everywhere(grid: Grid) -> bool:
    """Whether a layer is a deck without structure."""
    column = grid.extinction[:, :1, :1]
    return bool((grid.extinction == column).all())


def _deck(grid: Grid) -> Grid:
    """Resolve a deck that is the same everywhere: one column of thin voxels."""
    column = grid.extinction[:, :1, :1]
    thickest = float(column.max()) * float(grid.spacing[0])
    least = math.ceil(thickest / VOXEL_DEPTH)
    parts = max(1, min(least, LAYERS_OF_DECK // len(column)))
    spacing = grid.spacing / np.array([parts, 1.0, 1.0])
    return Grid(np.repeat(column, parts, axis=0), spacing, grid.base)
