"""The scale of maps of a night, whose light half floats do not hold at that of a day."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from skybake.image.settings import MapSettings

NIGHT_EV = -3.0
"""1.0 stands for 0.15 cd/m2: dark ground of 1e-5 cd/m2 and the disc of a full moon, 5e3 cd/m2, are
both normal half floats."""

DARK = math.radians(-8.0)
"""Elevation of the sun below which a map is of a night; above it twilight is brighter. [rad]"""


def night_scaled(maps: Sequence[MapSettings]) -> list[MapSettings]:
    """Return the settings of maps whose scale was left open.

    Parameters
    ----------
    maps : sequence of MapSettings
        All frames of a sequence, or one map.

    Returns
    -------
    list of MapSettings
        At `NIGHT_EV` if all are of a night with its lights or the Moon, or else as they were.
    """
    if not all(_is_of_night(each) for each in maps):
        return list(maps)
    return [replace(each, encoding=replace(each.encoding, ev=NIGHT_EV)) for each in maps]


def has_night_scale(settings: MapSettings) -> bool:
    """Whether a map is of a night, and at the scale of one."""
    return _is_of_night(settings) and settings.encoding.ev == NIGHT_EV


def _is_of_night(settings: MapSettings) -> bool:
    is_moonlit = settings.moonlight.moon is not None and settings.moonlight.shown != "exclude"
    return (settings.night.is_lit or is_moonlit) and settings.lighting.sun_elevation < DARK
