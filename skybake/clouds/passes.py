"""Passes over the voxels of a layer, each of which adds a scattering to what is known."""

from __future__ import annotations

import math

import numpy as np

from skybake.clouds.air_within import air_within
from skybake.clouds.cells import (
    CHUNK,
    all_cells,
    cloudy_cells,
    mean_change,
    put_moments,
    spread_moments,
)
from skybake.clouds.harmonics import degrees, harmonics_of
from skybake.clouds.mixing import Mixing
from skybake.clouds.ordinates import Sweep, allocate_sweep, sweep
from skybake.clouds.transfer import Entering, Floats, Scattering, Voxels
from skybake.jit.arguments import Flat, flatten
from skybake.optics.medium import Array

ACROSS = 0.3
"""Of a voxel, by which a ray may move farther than one before its way is divided in parts."""


class Passes:
    """Passes of one channel: each adds a scattering to what is known."""

    def __init__(self, voxels: Voxels, scattering: Scattering, entering: Entering) -> None:
        self._entering = entering
        self._quadrature = quadrature = scattering.quadrature
        self._sweeps = [
            _hemisphere(voxels, scattering, part)
            for part in (quadrature.downward, quadrature.upward)
        ]
        self._flat_sweeps = [flatten(each) for each in self._sweeps]
        _, rows, columns = voxels.extinction.shape
        # Light between clouds scatters nothing: it is gathered once, at the end.
        self.cells = cloudy_cells(voxels)
        self._cloudy, self._all = flatten(self.cells), flatten(all_cells(voxels))
        self._harmonics = (scattering.order + 1) ** 2
        self._light = entering.sun[0].astype(np.float32)
        half = len(quadrature.weight) // 2
        self._radiance = np.empty((half, rows * columns), np.float32)
        self._scratch = flatten(allocate_sweep(half, max(columns, CHUNK)))
        self._leaving = voxels.leaving
        self._air = [air_within(voxels, quadrature, entering, side) for side in (0, 1)]
        self._share = 1.0

    def dark(self) -> Floats:
        """Return moments of cloudy voxels without light."""
        return np.zeros(self.cells.row.size * self._harmonics, np.float32)

    def spread(self, merged: Floats) -> Floats:
        """Return moments of cloudy voxels from those of merged voxels, (z, y, harmonic, x)."""
        known = self.dark()
        spread_moments(self._cloudy, merged, known)
        return known

    def until_settled(self, known: Floats, most: int, tolerance: float) -> tuple[Floats, int]:
        """Iterate from moments of cloudy voxels; return others, and how many passes it took."""
        new = np.empty_like(known)
        mixing = Mixing(known.size)
        for number in range(1, most):
            self._advance(self._cloudy, known, new)
            change = mean_change(self._cloudy, self._harmonics, known, new)
            if change <= tolerance:
                return new, number
            mixing.step(known, new)
        return known, most - 1

    def finish(self, known: Floats, out: Floats) -> tuple[Array, float]:
        """Write the moments of all voxels, (z, y, harmonic, x).

        Returns
        -------
        up : ndarray of float64, shape (direction,)
            Mean radiance that leaves the top.
        down : float
            Irradiance of a horizontal plane at the base.
        """
        before = np.zeros_like(out)
        put_moments(self._cloudy, known, before)
        # In chunks of a row these are moments of cells.
        down = self._advance(self._all, before.reshape(-1), out.reshape(-1))
        return self._radiance.mean(axis=1, dtype=float), down

    def _advance(self, cells: Flat, known: Floats, new: Floats) -> float:
        """Write the moments that follow from the known ones; return the flux down at the base."""
        entering, quadrature = self._entering, self._quadrature
        new[...] = 0.0
        given = flatten(known), flatten(new)
        self._radiance[...] = entering.above[0][:, None]
        self._sweep(cells, 0, *given)
        down = float(quadrature.flux(self._radiance.mean(axis=1, dtype=float)))
        # Light from below is that of clear air, as far as the light comes that makes it.
        lit = self._leaving * entering.sun_share[0]
        sunlight = entering.down_sun[0] * lit
        share = (down + sunlight) / (entering.down[0] + entering.down_sun[0] + 1e-300)
        self._share = share
        below = share * entering.below[0] + lit * entering.below_lit[0]
        self._radiance[...] = below[:, None]
        self._sweep(cells, 1, *given)
        return down

    def _sweep(self, cells: Flat, side: int, known: Flat, new: Flat) -> None:
        air = self._air[side]
        added = (air.added + self._share * air.shared).astype(np.float32)
        sweep(
            cells,
            self._flat_sweeps[side],
            side == 1,
            self._light,
            known,
            self._radiance,
            added,
            self._scratch,
            new,
        )


def _hemisphere(voxels: Voxels, scattering: Scattering, part: slice) -> Sweep:
    quadrature = scattering.quadrature
    direction = np.ascontiguousarray(quadrature.direction[part])
    degree = degrees(scattering.order)
    harmonics = harmonics_of(direction, scattering.order)
    scatter = harmonics * ((2 * degree + 1) / (4.0 * math.pi) * scattering.moments[degree])
    sun = harmonics_of(-scattering.sun[None], scattering.order)[0]
    length = voxels.spacing[0] / np.abs(direction[:, 2])
    along = direction[:, :2] * length[:, None] / voxels.spacing[[2, 1]]
    single = voxels.extinction.shape[1:] == (1, 1)
    parts = np.ceil(np.hypot(*along.T) - ACROSS).astype(np.int64)
    return Sweep(
        direction=direction,
        scatter=scatter.astype(np.float32),
        sunlight=(scatter @ sun).astype(np.float32),
        project=(harmonics * quadrature.weight[part, None]).astype(np.float32),
        along=along,
        parts=np.ones_like(parts) if single else np.maximum(parts, 1),
        length=length,
    )
