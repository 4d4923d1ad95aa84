"""The field of a layer that a preset describes, at a moment."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from skybake.cloud_fields.cirrus import cirrus
from skybake.cloud_fields.cumulus import cumulus
from skybake.cloud_fields.deck import ALTOCUMULUS, STRATOCUMULUS, STRATUS, deck
from skybake.cloud_fields.empty import empty_field
from skybake.cloud_fields.field import SURFACE, CloudField
from skybake.cloud_fields.generations import field_of_age
from skybake.cloud_fields.kept import kept_field
from skybake.cloud_fields.near_clearance import with_near_clearance
from skybake.cloud_fields.patching import with_patches
from skybake.cloud_fields.tiles import read_tile, tile_field
from skybake.preset.clouds_model import CloudLayer, Tile

EVOLUTION = 1800.0
"""Time after which the details of clouds are the same again, and clouds are others. [s]"""

_RISING = 6e-4
"""Speed of details relative to their cloud, about. [km s⁻¹]"""

_RECENT = 6
"""Fields that a process holds for its next frame."""

_SHAPES: dict[str, Callable[..., CloudField]] = {
    "stratus": functools.partial(deck, STRATUS),
    "stratocumulus": functools.partial(deck, STRATOCUMULUS),
    "altocumulus": functools.partial(deck, ALTOCUMULUS),
    "cumulus": cumulus,
    "cirrus": cirrus,
}


_DRAWN_OUT = ("cirrus",)
"""Kinds whose shape depends on where the wind comes from."""


def build_field(layer: CloudLayer, time_s: float = 0.0) -> CloudField:
    """Return a layer's field.

    Parameters
    ----------
    layer : CloudLayer
        What the preset says.
    time_s : float
        Since the moment at which the layer is as its seed makes it: clouds drift with the wind,
        their details rise, and others take their place, within `EVOLUTION` everywhere. [s]

    Raises
    ------
    InputError
        If the file of a tile cannot be used.
    """
    return _at_time(_field_of_age(layer, time_s / EVOLUTION), layer, time_s)


def _field_of_age(layer: CloudLayer, age: float) -> CloudField:
    if layer.tile is not None:
        return _tile(layer.tile, layer.base)
    if layer.is_empty:
        return empty_field()
    shape = layer.cover, layer.base, layer.depth, layer.size, layer.optical_depth
    wind = (layer.wind_from,) if layer.kind in _DRAWN_OUT else ()

    def build(seed: int) -> CloudField:
        return _shaped(layer.kind, *shape, seed, *wind)

    return field_of_age(build, layer.seed, age)


@functools.lru_cache(_RECENT)
def _shaped(kind: str, *shape: float) -> CloudField:
    def build(*shape: float) -> CloudField:
        return with_patches(_SHAPES[kind](*shape), int(shape[5]))

    return kept_field(kind, shape, build)


@functools.lru_cache(1)
def _tile(tile: Tile, base: float) -> CloudField:
    path = Path(tile.path)
    return tile_field(read_tile(path, path.name), base, tile.interpolation, tile.origin)


def _at_time(field: CloudField, layer: CloudLayer, time_s: float) -> CloudField:
    east = -layer.wind_speed * math.sin(layer.wind_from) * time_s
    north = -layer.wind_speed * math.cos(layer.wind_from) * time_s
    origin = field.origin - np.array([east, north])
    displacement = field.displacement.copy()
    cycles = np.maximum(np.rint(_RISING * EVOLUTION * displacement[:, 5]), 1.0)
    # Of the phase only the fraction counts, which is exact for whole periods.
    phase = math.fmod(time_s, EVOLUTION) / EVOLUTION
    displacement[:, 8] = np.mod(displacement[:, 8] - cycles * phase, 1.0)
    if field.patch == 0.0:
        origin = np.mod(origin, field.period)
    moved = field._replace(origin=origin, displacement=displacement)
    if field.kind != SURFACE or time_s == 0.0:
        return moved
    return with_near_clearance(moved)
