"""The sky and the ground all round one observer, without the sun's disc."""

from __future__ import annotations

import math
from collections.abc import Mapping as Values

import numpy as np

from skybake.image.scene import Scene
from skybake.luts.lookup import sample
from skybake.luts.mapping import Mapping
from skybake.luts.table import Table, texels
from skybake.sky.table import EDGE

POINT = 1e-9
"""Extent of what a texel averages in zenith angle: none, so that the horizon stays sharp. [rad]"""

NEAR_SUN = math.radians(2.0)
AWAY, AROUND = 24, 24
"""Places around the sun where the table is compared, by their distances and turns."""


def sky_view_table(
    scene: Scene, mapping: Mapping, size: tuple[int, ...], constants: Values[str, float]
) -> Table:
    """Tabulate the light of the sky, with phase functions applied.

    Parameters
    ----------
    scene : Scene
        The observer, the sun and the scale.
    mapping, size, constants
        Where the texels are, see `Mapping.texels`.
    """
    places = mapping.texels(size, constants)
    zenith, horizon = places["zenith"], constants["HORIZON"]
    above = np.arange(size[1])[:, None] < size[1] // 2
    zenith = np.where(above, np.minimum(zenith, horizon - EDGE), np.maximum(zenith, horizon + EDGE))
    azimuth = np.arccos(np.clip(places["cos_azimuth"], -1.0, 1.0))
    return Table(
        name=mapping.table,
        values=texels(scene.evaluate_clear(zenith, azimuth, POINT)),
        quantity="radiance of sky and ground without the sun's disc",
        unit="white luminance",
        is_radiance=True,
        mapping=mapping,
    )


def error_near_sun(
    scene: Scene, table: Table, constants: Values[str, float]
) -> dict[str, float] | None:
    """Return by how much a linear filter of the table errs around the sun, where light peaks.

    Parameters
    ----------
    scene, constants
        As of `sky_view_table`.
    table : Table
        What it has made.

    Returns
    -------
    dict of str to float or None
        The largest relative error of the luminance ``within_deg`` of the sun's centre, above the
        horizon; None where the sun is below it.
    """
    away = NEAR_SUN * (np.arange(AWAY) + 0.5)[:, None] / AWAY
    turn = math.pi * (np.arange(AROUND) + 0.5) / AROUND
    zenith = scene.sun_zenith + away * np.cos(turn)
    azimuth = away * np.sin(turn) / np.maximum(np.sin(np.abs(zenith)), 1e-9)
    is_seen = (zenith > 0.0) & (zenith < constants["HORIZON"] - EDGE)
    if scene.sun_zenith >= constants["HORIZON"] or not is_seen.any():
        return None
    zenith, azimuth = zenith[is_seen][None], azimuth[is_seen][None]
    inputs = {"zenith": zenith, "cos_azimuth": np.cos(azimuth)}
    places = table.mapping.coordinates(table.size, {**constants, **inputs})
    read = sample(table.values, places) @ scene.luminance
    true = scene.evaluate_clear(zenith, azimuth, POINT) @ scene.luminance
    return {
        "within_deg": math.degrees(NEAR_SUN),
        "largest_relative": float(np.abs(read / true - 1.0).max()),
    }
