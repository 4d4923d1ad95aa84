"""Compiles half of a render's kernels, in a process beside the one that renders.

Compiling keeps one CPU busy, and a first render spends most of its time on it. The
kernels here are those that a render needs last. Arguments only have to be of the
right types: no pixel and no ray is computed.
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext

import numpy as np

from skybake.formats.half import fill_halves, half_rows
from skybake.jit.background_compiler import compile_in_background, end_with_parent
from skybake.jit.cache import is_warm
from skybake.optics.delta_m import scale_medium
from skybake.optics.medium import build_medium, pad_wavelengths
from skybake.preset import load_preset
from skybake.scattering.fans import group_rays
from skybake.scattering.grid import ORDER, empty_field, sun_angles
from skybake.scattering.harmonics import fill_each, harmonics_at
from skybake.scattering.horizon_peaks import no_horizon_peaks
from skybake.scattering.multiple import add_diffuse, allocate_scratch, side_by_side
from skybake.sky.disc import fill_sight_columns
from skybake.sky.pixels import allocate_pixels, fill_directions
from skybake.sky.sky import WAVELENGTHS
from skybake.sky.table import FoldedTable
from skybake.transport.samples import allocate_samples

KERNELS = (fill_each, add_diffuse, fill_sight_columns, fill_directions, fill_halves)


def compiled_in_background() -> AbstractContextManager[None]:
    """Run this module in the background of a process that finds no kernels, while it renders."""
    if is_warm():
        return nullcontext()
    return compile_in_background(__name__, frozenset(kernel.py_func.__name__ for kernel in KERNELS))


def compile_kernels() -> None:
    """Call each of `KERNELS` without work."""
    seen = build_medium(load_preset("earth"), WAVELENGTHS)
    scaled = scale_medium(pad_wavelengths(seen), ORDER)
    field = empty_field(scaled, np.array([0.0, 1.0]), sun_angles(2.0), ORDER)
    harmonics_at(field.harmonics, np.zeros(1))
    light = np.zeros((0, scaled.medium.ground_albedo.size), np.float32)
    rays = group_rays(np.zeros((1, 4)))
    samples, scratch = allocate_samples(scaled.medium), allocate_scratch(field, rays)
    sources = field, side_by_side(field), no_horizon_peaks(scaled), scaled
    stokes = np.zeros((0, 2 * light.shape[1]), np.float32)
    add_diffuse(*sources, rays, 0, 0, samples, scratch, light, stokes)
    table, mu = np.zeros((1, 1, 1)), np.zeros(0)
    columns, visible = np.zeros((0, seen.density.shape[1])), np.zeros(0, np.bool_)
    fill_sight_columns(seen, table, seen.r_bottom, mu, columns, visible)
    rows, curves = np.zeros((2, 4, 12), np.float32), np.zeros((2, 1), np.float32)
    view = FoldedTable(0.0, 1.5, 1.0, rows, curves, False)
    pixels = np.zeros((0, 1, 3), np.float32)
    place = np.zeros((1, 1))
    fill_directions(view, place, place, place, 0, 0, allocate_pixels(view, 1), pixels)
    half_rows(np.zeros((1, 1, 3), np.float32))


if __name__ == "__main__":
    end_with_parent(compile_kernels)
