"""The field of a layer that a preset describes, at a moment."""

from __future__ import annotations

import math

import numpy as np

from skybake.cloud_fields.cirrus import cirrus
from skybake.cloud_fields.cumulus import cumulus
from skybake.cloud_fields.deck import ALTOCUMULUS, STRATOCUMULUS, STRATUS, deck
from skybake.cloud_fields.field import CONSTANT, CloudField
from skybake.preset.clouds_model import CloudLayer

EVOLUTION = 1800.0
"""Time after which the details of clouds are the same again. [s]"""

_RISING = 6e-4
"""Speed of details relative to their cloud, about. [km s⁻¹]"""

_DECKS = {"stratus": STRATUS, "stratocumulus": STRATOCUMULUS, "altocumulus": ALTOCUMULUS}


def build_field(layer: CloudLayer, time_s: float = 0.0) -> CloudField:
    """Return a layer's field.

    Parameters
    ----------
    layer : CloudLayer
        What the preset says.
    time_s : float
        Since the moment at which the layer is as its seed makes it: clouds drift with the wind,
        and their details rise and are the same again after `EVOLUTION`. [s]

    Raises
    ------
    InputError
        If the file of a tile cannot be used.
    """
    return _at_time(_still_field(layer), layer, time_s)


def empty_field() -> CloudField:
    """Return a field without clouds."""
    return CloudField(
        kind=CONSTANT,
        values=np.zeros((1, 1, 1), np.float32),
        distance=np.zeros((1, 1, 1), np.int16),
        spacing=np.ones(3),
        period=np.ones(2),
        origin=np.zeros(2),
        base=0.0,
        top=0.0,
        extinction=np.zeros(1),
        edge=0.0,
        widest_edge=0.0,
        condensation=0.0,
        shift=np.zeros(1),
        largest_blur=0.0,
        displacement=np.zeros((0, 9)),
        noise=np.zeros((1, 1, 1), np.int8),
        clearance=np.full((1, 1, 1), 1e3, np.float32),
        block=np.ones(3),
        steepness=1.0,
    )


def _still_field(layer: CloudLayer) -> CloudField:
    if layer.cover <= 0.0 or layer.optical_depth <= 0.0:
        return empty_field()
    shape = layer.cover, layer.base, layer.depth, layer.size, layer.optical_depth, layer.seed
    if layer.kind == "cumulus":
        return cumulus(*shape)
    if layer.kind == "cirrus":
        return cirrus(*shape)
    return deck(_DECKS[layer.kind], *shape)


def _at_time(field: CloudField, layer: CloudLayer, time_s: float) -> CloudField:
    east = -layer.wind_speed * math.sin(layer.wind_from) * time_s
    north = -layer.wind_speed * math.cos(layer.wind_from) * time_s
    origin = field.origin - np.array([east, north])
    displacement = field.displacement.copy()
    cycles = np.maximum(np.rint(_RISING * EVOLUTION * displacement[:, 5]), 1.0)
    # Of the phase only the fraction counts, which is exact for whole periods.
    phase = math.fmod(time_s, EVOLUTION) / EVOLUTION
    displacement[:, 8] = np.mod(displacement[:, 8] - cycles * phase, 1.0)
    return field._replace(origin=np.mod(origin, field.period), displacement=displacement)
