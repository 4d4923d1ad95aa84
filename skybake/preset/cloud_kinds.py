"""Kinds of clouds, and what they are like unless a preset says otherwise."""

from __future__ import annotations

from typing import NamedTuple


class Kind(NamedTuple):
    """What a kind of cloud is like unless a preset says otherwise.

    Attributes
    ----------
    base, depth, size : float
        [km]
    cover, optical_depth : float
        As of `CloudLayer`.
    phase : str
        One of `skybake.preset.particles.PARTICLES`.
    wind : float
        [m s⁻¹]
    """

    base: float
    depth: float
    size: float
    cover: float
    optical_depth: float
    phase: str
    wind: float


DEFAULTS = {
    "stratus": Kind(0.6, 0.4, 1.2, 1.0, 20.0, "water", 5.0),
    "stratocumulus": Kind(1.0, 0.35, 1.1, 0.85, 12.0, "water", 8.0),
    "cumulus": Kind(1.2, 0.9, 1.3, 0.4, 25.0, "water", 8.0),
    "altocumulus": Kind(3.8, 0.18, 0.45, 0.5, 5.0, "water", 15.0),
    "cirrus": Kind(8.0, 1.2, 3.0, 0.4, 0.3, "ice", 25.0),
}
"""By kind; winds, which nobody measured for them all, grow with altitude as they usually do."""

DEFAULT_SEED = 1
DEFAULT_WIND_FROM = 270.0
"""Bearing: the west wind of middle latitudes. [deg]"""
