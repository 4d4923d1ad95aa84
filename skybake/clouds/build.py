"""A world's layers of clouds, ready to be looked at."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.cloud_fields.build import build_field
from skybake.cloud_fields.field import SURFACE, CloudField
from skybake.cloud_fields.light_grid import light_grid
from skybake.clouds.air import ClearAir
from skybake.clouds.cloudscape import Cloudscape
from skybake.clouds.directions import sun_vector
from skybake.clouds.layer import Floats, Grid
from skybake.clouds.suns import suns_over
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
    voxels : int
        Up to which those of a file are divided where they are thick; shared by several heights of
        the sun, each of which takes memory.
    work, work_of_file : float
        Of the ordinates, for the order that is chosen: voxels times `_WORK`; of a generated layer,
        and of a file's voxels.
    depth : float
        Optical depth of a step of the eye's rays, without forward peaks.
    alike : float
        Relative difference of two pixels up to which that between them is their mean.
    """

    columns: int
    voxels: int
    work: float
    work_of_file: float
    depth: float
    alike: float


QUALITIES = {
    "draft": Quality(96, 640_000, 6e8, 2.3e9, 0.6, 0.05),
    "normal": Quality(144, 640_000, 9e8, 2.3e9, 0.4, 0.03),
    "high": Quality(192, 1_300_000, 8e9, 8e9, 0.2, 0.01),
}

_WORK = {2: 624, 3: 1280, 4: 3480, 5: 5760, 7: 17408}
"""By order: directions times what each costs."""

LAYERS_OF_DECK = 512
VOXEL_DEPTH = 0.05
"""Optical depth, without forward peaks, of the voxels of a deck that is the same everywhere."""

THICKEST = 2.5
"""Optical depth of a voxel's side, on average over clouds, above which it is divided."""

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
    keeps_light: bool = False,
    air: ClearAir | None = None,
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
    keeps_light : bool, optional
        Whether light that is solved for is kept on disk, for other processes.
    air : ClearAir, optional
        What lights the clouds from all around in place of the sun, in the channels of `weights`.

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
    sun = np.zeros(3) if air else sun_vector(sky.sun_azimuth, sky.sun_elevation)
    layers = [_layer(*each, sky, sun, weights, chosen, workers) for each in fields]
    if air is None:
        air = ClearAir(sky.atmosphere, sky.source.angular_radius, workers, sky.table_method)
    else:
        weights = np.eye(weights.shape[1])
    given = layers, air, sky.altitude, sun, weights, chosen.depth, chosen.alike, workers
    return Cloudscape(*given, keeps_light=keeps_light)


def _layer(
    layer: CloudLayer,
    field: CloudField,
    sky: Sky,
    sun: Array,
    weights: Array,
    quality: Quality,
    workers: Workers,
) -> Layer:
    middle = build_phase(layer.phase, np.array([MIDDLE]))[:, 0]
    share = weights / weights.sum(axis=0)
    phase = build_phase(layer.phase, sky.wavelengths) @ share
    suns = len(suns_over(sun, sky.atmosphere.medium.r_bottom, sky.altitude, field.top))
    grid = _grid(field, quality, quality.voxels // suns, workers)
    if is_same_everywhere(grid.extinction):
        return Layer(field, _deck(grid), phase, middle, max(_WORK))
    most = quality.work if field.kind == SURFACE else quality.work_of_file
    orders = [order for order, cost in _WORK.items() if cost * grid.extinction.size <= most]
    return Layer(field, grid, phase, middle, max(orders, default=min(_WORK)))


def _grid(field: CloudField, quality: Quality, most: int, workers: Workers) -> Grid:
    across = field.period / quality.columns
    height = min(0.5 * float(across.min()), (field.top - field.base) / 12.0)
    spacing = np.array([height, across[1], across[0]])
    if field.kind != SURFACE:
        spacing = field.spacing / voxel_parts(field, most)
    made = light_grid(field, spacing, workers)
    values = made.values
    if field.kind != SURFACE and is_same_everywhere(field.values):
        # Means of equal columns may differ in their last digits.
        values = np.broadcast_to(values[:, :1, :1], values.shape)
    return Grid(values, made.spacing, made.base)


def voxel_parts(field: CloudField, most: int) -> Array:
    """Into how many parts a file's voxels are divided along z, y and x for their light.

    Light is constant within a voxel while it is solved for, so that thick ones hide the bright
    side of a cloud from those who look at it. Parts are halved along the thickest side until
    they are no thicker than `THICKEST`, or until there would be more than `most` of them.
    """
    parts = np.ones(3)
    values = field.values
    if is_same_everywhere(values):
        return parts
    total = float(values.sum(dtype=float))
    if total <= 0.0:
        return parts
    # The mean that light meets.
    extinction = float((values.astype(float) ** 2).sum()) / total
    while 2.0 * values.size * parts.prod() <= most:
        thickness = extinction * field.spacing / parts
        side = int(np.argmax(thickness))
        if thickness[side] <= THICKEST:
            break
        parts[side] *= 2.0
    return parts


def is_same_everywhere(extinction: Floats) -> bool:
    """Whether voxels (z, y, x) are a deck without structure."""
    return bool((extinction == extinction[:, :1, :1]).all())


def _deck(grid: Grid) -> Grid:
    """Resolve a deck that is the same everywhere: one column of thin voxels."""
    column = grid.extinction[:, :1, :1]
    thickest = float(column.max()) * float(grid.spacing[0])
    least = math.ceil(thickest / VOXEL_DEPTH)
    parts = max(1, min(least, LAYERS_OF_DECK // len(column)))
    spacing = grid.spacing / np.array([parts, 1.0, 1.0])
    return Grid(np.repeat(column, parts, axis=0), spacing, grid.base)
