"""Layers of clouds as presets have them, and their fields."""

import functools
import math
from dataclasses import replace

from skybake.cloud_fields.build import build_field
from skybake.preset.cloud_kinds import DEFAULTS
from skybake.preset.clouds_model import CloudLayer
from skybake.preset.load import load_preset

KINDS = tuple(DEFAULTS)
PHASE = load_preset("earth-fair").clouds[0].phase


def layer(like, **changes):
    """A layer as it is unless a preset says otherwise."""
    values = DEFAULTS[like]
    plain = CloudLayer(
        "low",
        like,
        values.base,
        values.depth,
        values.size,
        values.cover,
        values.optical_depth,
        PHASE,
        1,
        values.wind * 1e-3,
        math.radians(270.0),
    )
    return replace(plain, **changes)


@functools.lru_cache(8)
def field(kind, **changes):
    """The field of such a layer."""
    return build_field(layer(kind, **changes))
