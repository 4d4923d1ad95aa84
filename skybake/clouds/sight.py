"""An observer's rays through a layer, by several threads."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.clouds.airlight import AirTable, fill_lit
from skybake.clouds.dimming import Dimming
from skybake.clouds.layer import SolvedLayer
from skybake.clouds.light import LayerLight
from skybake.clouds.march import Marching, allocate_march, fill_march
from skybake.clouds.shadow import dim_visibility
from skybake.jit.arguments import flatten
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

RAYS = 512
"""Rays that a thread takes at a time."""


class Eye(NamedTuple):
    """Where an observer is.

    Attributes
    ----------
    radius, altitude : float
        Of the ground, and of the observer above it. [km]
    sun : ndarray of float64, shape (3,)
        Toward the sun: x east, y north, z up.
    """

    radius: float
    altitude: float
    sun: Array


def see_layer(
    field: CloudField,
    light: LayerLight,
    eye: Eye,
    directions: Array,
    marching: Marching,
    out: tuple[Floats, Floats],
    workers: Workers,
    ends: Array | None = None,
) -> None:
    """Call `fill_march` for all rays, by default to infinity; `out` are its last arguments."""
    ends = np.full(len(directions), np.inf) if ends is None else ends
    given = flatten(field), flatten(light)
    rays, limits, sun = flatten(directions), flatten(ends), flatten(eye.sun)
    seen, through = out

    def work(first: int, last: int) -> None:
        fill_march(
            *given,
            eye.radius,
            eye.altitude,
            rays,
            limits,
            sun,
            marching,
            first,
            last,
            allocate_march(seen.shape[1], light.order),
            seen,
            through,
        )

    workers.run_rows(len(directions), work, chunk=RAYS)


def dim_rays(
    field: CloudField,
    solved: SolvedLayer,
    eye: Eye,
    directions: Array,
    distance: Array,
    out: Floats,
    workers: Workers,
) -> None:
    """Call `dim_visibility` for all rays."""
    given = [flatten(each) for each in (field, solved.light, solved.leaving)]
    rays = flatten(directions), flatten(distance), flatten(eye.sun)

    def work(first: int, last: int) -> None:
        dim_visibility(*given, eye.radius, eye.altitude, *rays, first, last, out)

    workers.run_rows(len(directions), work, chunk=RAYS)


def light_rays(
    table: AirTable,
    row: npt.NDArray[np.int64],
    weight: Array,
    dimming: Dimming,
    eye: Eye,
    directions: Array,
    visible: Floats,
    workers: Workers,
) -> tuple[Floats, Floats]:
    """Call `fill_lit` for all rays; return its `lit` and `through`."""
    channels, stretches = table.total.shape[1], visible.shape[1] - 1
    lit = np.empty((len(directions), stretches + 2, channels), np.float32)
    through = np.empty((len(directions), stretches + 1, channels), np.float32)
    given = [flatten(each) for each in (table, row, weight, dimming)]
    rays = flatten(directions), flatten(visible)

    def work(first: int, last: int) -> None:
        fill_lit(*given, eye.radius, eye.altitude, *rays, first, last, lit, through)

    workers.run_rows(len(directions), work, chunk=RAYS)
    return lit, through
