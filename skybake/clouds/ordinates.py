"""Diffuse light through a layer of voxels along discrete directions."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.clouds.beam import mean_passing
from skybake.jit.kernel import kernel
from skybake.transport.exponential import fast_exp32

Floats = npt.NDArray[np.float32]


class Sweep(NamedTuple):
    """Directions of one hemisphere as `sweep` takes them.

    Attributes
    ----------
    direction : ndarray of float64, shape (direction, 3)
        Of travel.
    scatter : ndarray of float32, shape (direction, harmonic)
        What of the moments of radiance a voxel scatters into each direction. [sr⁻¹]
    sunlight : ndarray of float32, shape (direction,)
        The same of a beam of 1.
    project : ndarray of float32, shape (direction, harmonic)
        What radiance along each direction adds to the moments. [sr]
    along, parts : ndarray, shape (direction, 2) and (direction,)
        Voxels by which a ray moves in x and y while it crosses a plane, and in how many parts.
    length : ndarray of float64, shape (direction,)
        Of a ray within a plane. [km]
    """

    direction: npt.NDArray[np.float64]
    scatter: Floats
    sunlight: Floats
    project: Floats
    along: npt.NDArray[np.float64]
    parts: npt.NDArray[np.int64]
    length: npt.NDArray[np.float64]


class SweepScratch(NamedTuple):
    """Work space of `sweep`.

    Attributes
    ----------
    place : ndarray of int32, shape (cell,)
        Of the rays that meet the cells of a chunk.
    source, entering : ndarray of float32, shape (cell,)
        In these cells.
    value : ndarray of float32, shape (direction, cell)
        Mean radiances in these cells.
    active : ndarray of int64, shape (direction,)
        Directions of these.
    """

    place: npt.NDArray[np.int32]
    source: Floats
    entering: Floats
    value: Floats
    active: npt.NDArray[np.int64]


def allocate_sweep(directions: int, cells: int) -> SweepScratch:
    """Make the work space for directions of a hemisphere and the most cells of a chunk."""
    return SweepScratch(
        place=np.empty(cells, np.int32),
        source=np.empty(cells, np.float32),
        entering=np.empty(cells, np.float32),
        value=np.empty((directions, cells), np.float32),
        active=np.empty(directions, np.int64),
    )


@kernel
def sweep(cells, hemisphere, is_upward, light, known, radiance, scratch, moments):
    """Carry light along all directions of a hemisphere, plane by plane.

    Parameters
    ----------
    cells : Cells
        Voxels in which light is gathered, of a tile that is periodic in y and x. Others are empty.
    hemisphere : Sweep
        Directions, which all go down or all go up.
    is_upward : bool
        Which.
    light : ndarray of float32, shape (z,)
        Irradiance of that beam above the layer, by altitude.
    known : ndarray of float32, shape (cell * harmonic,)
        Moments of the diffuse radiance, as known so far, see `take_moments`.
    radiance : ndarray of float32, shape (direction, y * x)
        What enters, on the lattice of rays; receives what leaves.
    scratch : SweepScratch
        Work space.
    moments : ndarray of float32, shape (cell * harmonic,)
        To which the moments of the radiance are added.

    Notes
    -----
    A lattice of rays goes with each direction, and at each part of a plane a ray is whole in the
    voxel that is nearest: no interpolation, so nothing is smeared, and energy is kept. Rows of a
    plane stay in the cache while all directions pass.
    """
    levels = cells.chunks.size - 1
    rows, columns = cells.rows, cells.columns
    directions, harmonics = hemisphere.scatter.shape
    source, entering, active = scratch.source, scratch.entering, scratch.active
    most = np.int64(1)
    for d in range(directions):
        most = max(most, hemisphere.parts[d])
    for q in range(levels):
        k = q if is_upward else levels - 1 - q
        for part in range(most):
            for chunk in range(cells.chunks[k], cells.chunks[k + 1]):
                begin, end = cells.first[chunk], cells.first[chunk + 1]
                row, column = cells.row[begin:end], cells.column[begin:end]
                met, beam = cells.extinction[begin:end], cells.beam[begin:end]
                lit = known[begin * harmonics : end * harmonics]
                count = 0
                for d in range(directions):
                    parts = hemisphere.parts[d]
                    if part >= parts:
                        continue
                    along = q + (part + 0.5) / parts
                    shift_x = math.floor(along * hemisphere.along[d, 0] + 0.5) % columns
                    shift_y = math.floor(along * hemisphere.along[d, 1] + 0.5) % rows
                    _scatter(
                        beam, hemisphere.sunlight[d] * light[k], lit, hemisphere.scatter[d], source
                    )
                    step = np.float32(hemisphere.length[d] / parts)
                    share = np.float32(1.0 / parts)
                    value = scratch.value[count]
                    if cells.is_whole:
                        at = row[0] - shift_y
                        at += rows if at < 0 else 0
                        ray = radiance[d, at * columns : (at + 1) * columns]
                        rest = columns - shift_x
                        _cross(met[shift_x:], source[shift_x:], ray, step, share, value[shift_x:])
                        _cross(met[:shift_x], source[:shift_x], ray[rest:], step, share, value)
                    else:
                        ray = radiance[d]
                        _place(row, column, shift_y, shift_x, rows, columns, scratch.place)
                        for n in range(row.size):
                            entering[n] = ray[scratch.place[n]]
                        _cross(met, source, entering, step, share, value)
                        for n in range(row.size):
                            ray[scratch.place[n]] = entering[n]
                    active[count] = d
                    count += 1
                gathered = moments[begin * harmonics : end * harmonics]
                _gather(scratch.value, active[:count], hemisphere.project, gathered, row.size)


@kernel
def _place(row, column, shift_y, shift_x, rows, columns, place):
    """Write where on a lattice that is shifted by so many voxels rays are that meet cells."""
    down, left, height, width = (
        np.int32(shift_y),
        np.int32(shift_x),
        np.int32(rows),
        np.int32(columns),
    )
    for n in range(row.size):
        j, i = row[n] - down, column[n] - left
        j += height if j < 0 else np.int32(0)
        i += width if i < 0 else np.int32(0)
        place[n] = np.int32(j * width + i)


@kernel
def _scatter(beam, sunlight, known, scatter, source):
    """Write what a row of voxels scatters into a direction."""
    size, harmonics = beam.size, scatter.size
    for i in range(size):
        source[i] = sunlight * beam[i]
    # Four at a time, so that few sums go through memory.
    whole = harmonics // 4 * 4
    for p in range(0, whole, 4):
        a, b, c, d = scatter[p], scatter[p + 1], scatter[p + 2], scatter[p + 3]
        k, m, n, o = (
            known[p * size :],
            known[(p + 1) * size :],
            known[(p + 2) * size :],
            known[(p + 3) * size :],
        )
        for i in range(size):
            source[i] += a * k[i] + b * m[i] + c * n[i] + d * o[i]
    for p in range(whole, harmonics):
        a, k = scatter[p], known[p * size :]
        for i in range(size):
            source[i] += a * k[i]


@kernel
def _gather(value, active, project, moments, size):
    """Add the moments of radiances along some directions to those of a row of voxels."""
    harmonics = project.shape[1]
    whole = active.size // 4 * 4
    for first in range(0, whole, 4):
        w, x = active[first], active[first + 1]
        y, z = active[first + 2], active[first + 3]
        k, m, n, o = value[first], value[first + 1], value[first + 2], value[first + 3]
        for p in range(harmonics):
            a, b, c, d = project[w, p], project[x, p], project[y, p], project[z, p]
            total = moments[p * size :]
            for i in range(size):
                total[i] += a * k[i] + b * m[i] + c * n[i] + d * o[i]
    for first in range(whole, active.size):
        w, k = active[first], value[first]
        for p in range(harmonics):
            a, total = project[w, p], moments[p * size :]
            for i in range(size):
                total[i] += a * k[i]


@kernel
def _cross(met, source, ray, step, share, value):
    """Take rays through one voxel each; write `share` of their mean radiance to `value`."""
    for i in range(met.size):
        depth = met[i] * step
        passes = fast_exp32(-depth)
        excess = ray[i] - source[i]
        ray[i] = source[i] + excess * passes
        value[i] = share * (source[i] + excess * mean_passing(depth, passes))
