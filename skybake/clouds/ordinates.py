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


@kernel
def sweep(extinction, hemisphere, is_upward, beam, light, total, radiance, source, value, moments):
    """Carry light along all directions of a hemisphere, plane by plane.

    Parameters
    ----------
    extinction : ndarray of float32, shape (z, y, x)
        Without forward peaks; periodic in y and x. [km⁻¹]
    hemisphere : Sweep
        Directions, which all go down or all go up.
    is_upward : bool
        Which.
    beam : ndarray of float32, shape (z, y, x)
        Mean of the sun's beam.
    light : ndarray of float32, shape (z,)
        Irradiance of that beam above the layer, by altitude.
    total : ndarray of float32, shape (z, y, harmonic, x)
        Moments of the diffuse radiance, as known so far.
    radiance : ndarray of float32, shape (direction, y, x)
        What enters, on the lattice of rays; receives what leaves.
    source, value : ndarray of float32, shape (x,)
        Work space.
    moments : ndarray of float32, shape (z, y, harmonic, x)
        To which the moments of the radiance are added.

    Notes
    -----
    A lattice of rays goes with each direction, and at each part of a plane a ray is whole in the
    voxel that is nearest: no interpolation, so nothing is smeared, and energy is kept. Rows of a
    plane stay in the cache while all directions pass.
    """
    levels, rows, columns = extinction.shape
    directions, harmonics = hemisphere.scatter.shape
    most = np.int64(1)
    for d in range(directions):
        most = max(most, hemisphere.parts[d])
    for q in range(levels):
        k = q if is_upward else levels - 1 - q
        for part in range(most):
            for j in range(rows):
                for d in range(directions):
                    parts = hemisphere.parts[d]
                    if part >= parts:
                        continue
                    along = q + (part + 0.5) / parts
                    shift_x = math.floor(along * hemisphere.along[d, 0] + 0.5) % columns
                    shift_y = math.floor(along * hemisphere.along[d, 1] + 0.5) % rows
                    row = j - shift_y
                    if row < 0:
                        row += rows
                    step = np.float32(hemisphere.length[d] / parts)
                    share = np.float32(1.0 / parts)
                    weight = hemisphere.sunlight[d] * light[k]
                    for i in range(columns):
                        source[i] = weight * beam[k, j, i]
                    for p in range(harmonics):
                        weight = hemisphere.scatter[d, p]
                        known = total[k, j, p]
                        for i in range(columns):
                            source[i] += weight * known[i]
                    ray = radiance[d, row]
                    met = extinction[k, j]
                    _cross(met[shift_x:], source[shift_x:], ray, step, share, value[shift_x:])
                    rest = columns - shift_x
                    _cross(met[:shift_x], source[:shift_x], ray[rest:], step, share, value)
                    for p in range(harmonics):
                        weight = hemisphere.project[d, p]
                        gathered = moments[k, j, p]
                        for i in range(columns):
                            gathered[i] += weight * value[i]


@kernel
def _cross(met, source, ray, step, share, value):
    """Take rays through one voxel each; write `share` of their mean radiance to `value`."""
    for i in range(met.size):
        depth = met[i] * step
        passes = fast_exp32(-depth)
        excess = ray[i] - source[i]
        ray[i] = source[i] + excess * passes
        value[i] = share * (source[i] + excess * mean_passing(depth, passes))
