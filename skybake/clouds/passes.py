"""Passes over the voxels of a layer, each of which adds a scattering to what is known."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.clouds.harmonics import degrees, harmonics_of
from skybake.clouds.mixing import Mixing
from skybake.clouds.ordinates import Sweep, sweep
from skybake.clouds.transfer import Entering, Floats, Scattering, Voxels
from skybake.jit.arguments import Flat, flatten

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
        self._grid = flatten(voxels.extinction), flatten(voxels.beam)
        self._light = entering.sun[0].astype(np.float32)
        half = len(quadrature.weight) // 2
        self._radiance = np.empty((half, rows, columns), np.float32)
        self._scratch = (
            flatten(np.empty(columns, np.float32)),
            flatten(np.empty(columns, np.float32)),
        )
        self._leaving = voxels.leaving
        self._cloudy = voxels.extinction > 0.0

    def until_settled(self, state: Floats, most: int, tolerance: float) -> tuple[float, float, int]:
        """Iterate in place; return the fluxes up and down, and how many passes it took."""
        # Light between clouds scatters nothing, and is not mixed.
        cloudy = np.nonzero(self._cloudy)
        mixing = Mixing(cloudy[0].size * state.shape[2])
        image = np.empty_like(state)
        up = down = 0.0
        for number in range(1, most + 1):
            up, down = self._advance(state, image)
            change = _mean_change(state, image, self._cloudy)
            if change > tolerance and number < most:
                mixed = _take(state, cloudy)
                mixing.step(mixed, _take(image, cloudy))
                _put(mixed, cloudy, state)
                continue
            state[...] = image
            if change <= tolerance:
                break
        return up, down, number

    def _advance(self, state: Floats, image: Floats) -> tuple[float, float]:
        """Write the moments that follow from those of `state` to `image`; return the fluxes."""
        entering, quadrature = self._entering, self._quadrature
        image[...] = 0.0
        known, new = flatten(state), flatten(image)
        self._radiance[...] = entering.above[0][:, None, None]
        self._sweep(0, known, new)
        down = float(quadrature.flux(self._radiance.mean(axis=(1, 2), dtype=float)))
        # Light from below is that of clear air, as far as the light comes that makes it.
        lit = self._leaving * entering.sun_share[0]
        sunlight = entering.down_sun[0] * lit
        share = (down + sunlight) / (entering.down[0] + entering.down_sun[0] + 1e-300)
        below = share * entering.below[0] + lit * entering.below_lit[0]
        self._radiance[...] = below[:, None, None]
        self._sweep(1, known, new)
        up = float(quadrature.flux(self._radiance.mean(axis=(1, 2), dtype=float)))
        return up, down

    def _sweep(self, side: int, known: Flat, new: Flat) -> None:
        extinction, beam = self._grid
        sweep(
            extinction,
            self._flat_sweeps[side],
            side == 1,
            beam,
            self._light,
            known,
            self._radiance,
            *self._scratch,
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


def _take(moments: Floats, at: tuple[npt.NDArray[np.intp], ...]) -> Floats:
    """Moments of some voxels, flat."""
    levels, rows, columns = at
    taken: Floats = moments.transpose(0, 1, 3, 2)[levels, rows, columns].reshape(-1)
    return taken


def _put(values: Floats, at: tuple[npt.NDArray[np.intp], ...], out: Floats) -> None:
    """Write what `_take` returns."""
    levels, rows, columns = at
    out.transpose(0, 1, 3, 2)[levels, rows, columns] = values.reshape(-1, out.shape[2])


def _mean_change(state: Floats, image: Floats, cloudy: npt.NDArray[np.bool_]) -> float:
    """Relative change of the mean radiance in cloud."""
    if not cloudy.any():
        return 0.0
    before, after = (each[:, :, 0][cloudy] for each in (state, image))
    return float(np.abs(after - before).mean() / max(float(np.abs(after).mean()), 1e-30))
