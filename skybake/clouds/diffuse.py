"""Diffuse light in a layer of voxels, by iteration over all orders of scattering."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.clouds.harmonics import degrees, harmonics_of
from skybake.clouds.merging import merge_levels, merge_pairs, spread_pairs
from skybake.clouds.mixing import Mixing
from skybake.clouds.ordinates import Sweep, sweep
from skybake.clouds.quadrature import Quadrature
from skybake.jit.arguments import Flat, flatten
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

TOLERANCE = 5e-6
"""Relative change of the mean radiance in clouds by one pass, at which iteration ends. In decks
of optical depth 64, where what later passes would change adds up, light is then kept to 4e-4."""

MAX_PASSES = 200
LARGE = 100_000
"""Voxels from which most of the work is done on voxels that are merged by two on each axis."""

SMALL = 30_000
"""Voxels from which these are merged again."""

ROUGH = 1e-3
"""Tolerance of what is solved on merged voxels for a start."""

FINE = 1.5e-4
"""Tolerance of what starts from there. Drawn cumuli then keep their light to 5e-4."""

ACROSS = 0.3
"""Of a voxel, by which a ray may move farther than one before its way is divided in parts."""


class Voxels(NamedTuple):
    """A tile of voxels whose forward peaks count as not scattered.

    Attributes
    ----------
    extinction : ndarray of float32, shape (z, y, x)
        [km⁻¹]
    spacing : ndarray of float64, shape (3,)
        Along z, y and x. [km]
    beam : ndarray of float32, shape (z, y, x)
        Mean over a voxel of a beam of the sun that enters with 1.
    leaving : float
        Mean of that beam where it leaves the layer.
    """

    extinction: Floats
    spacing: Array
    beam: Floats
    leaving: float


class Entering(NamedTuple):
    """Light that enters a layer, by channel.

    Attributes
    ----------
    sun : ndarray of float64, shape (channel, z)
        Irradiance facing the sun at the altitudes of voxels, without clouds.
    above : ndarray of float64, shape (channel, direction)
        Radiance of the sky along the downward directions.
    below, below_lit : ndarray of float64, shape (channel, direction)
        Radiance along the upward directions without clouds: what is in proportion to all light that
        comes down, and what the sun lights in the air beneath.
    down : ndarray of float64, shape (channel,)
        Irradiance of a horizontal plane at the base without clouds, by the sky alone.
    down_sun : ndarray of float64, shape (channel,)
        The same by the sun.
    sun_share : ndarray of float64, shape (channel,)
        What clouds above leave of the sun.
    """

    sun: Array
    above: Array
    below: Array
    below_lit: Array
    down: Array
    down_sun: Array
    sun_share: Array


class Diffuse(NamedTuple):
    """Diffuse light of a layer.

    Attributes
    ----------
    moments : ndarray of float32, shape (channel, z, y, harmonic, x)
        Of the radiance in each voxel.
    up, down : ndarray of float64, shape (channel,)
        Mean irradiances of horizontal planes: upward at the top, and downward at the base.
    passes : int
        How many it took, those on merged voxels included.
    """

    moments: Floats
    up: Array
    down: Array
    passes: int


class Scattering(NamedTuple):
    """How voxels scatter along discrete directions.

    Attributes
    ----------
    order : int
        Highest degree.
    quadrature : Quadrature
        The directions.
    moments : ndarray of float64, shape (order + 1,)
        chi_l of the truncated phase function.
    sun : ndarray of float64, shape (3,)
        Unit vector toward the sun.
    """

    order: int
    quadrature: Quadrature
    moments: Array
    sun: Array


def solve_diffuse(
    voxels: Voxels, scattering: Scattering, entering: Entering, workers: Workers
) -> Diffuse:
    """Solve for the diffuse light of all channels.

    Parameters
    ----------
    voxels : Voxels
        The tile.
    scattering : Scattering
        Phase function and directions.
    entering : Entering
        Light from outside.
    workers : Workers
        Threads that do the work, a channel each.

    Returns
    -------
    Diffuse
        Particles do not absorb: what comes in goes out.

    References
    ----------
    K. F. Evans, "The Spherical Harmonics Discrete Ordinate Method", J. Atmos. Sci. 55, 1998: the
    source function in harmonics, transport along ordinates, delta-M.
    """
    channels = len(entering.sun)
    harmonics = (scattering.order + 1) ** 2
    levels, rows, columns = voxels.extinction.shape
    moments = np.empty((channels, levels, rows, harmonics, columns), np.float32)
    up, down, passes = np.empty(channels), np.empty(channels), np.zeros(channels, int)

    def work(first: int, last: int) -> None:
        for channel in range(first, last):
            light = Entering(*(part[channel : channel + 1] for part in entering))
            solved = _solve_channel(voxels, scattering, light, moments[channel])
            up[channel], down[channel], passes[channel] = solved

    workers.run_rows(channels, work)
    return Diffuse(moments, up, down, int(passes.max()))


def _solve_channel(
    voxels: Voxels, scattering: Scattering, entering: Entering, out: Floats
) -> tuple[float, float, int]:
    passes = _Passes(voxels, scattering, entering)
    if not _can_merge(voxels, LARGE):
        out[...] = 0.0
        return passes.until_settled(out, MAX_PASSES, TOLERANCE)
    before = _start(voxels, scattering, entering, out)
    up, down, number = passes.until_settled(out, MAX_PASSES, FINE)
    return up, down, before + number


def _start(voxels: Voxels, scattering: Scattering, entering: Entering, out: Floats) -> int:
    """Write moments that were found on merged voxels; return how many passes that took."""
    merged = _merge(voxels)
    light = entering._replace(sun=merge_levels(entering.sun, merged.extinction.shape[0]))
    shape = (*merged.extinction.shape[:2], out.shape[2], merged.extinction.shape[2])
    state = np.zeros(shape, np.float32)
    number = _start(merged, scattering, light, state) if _can_merge(merged, SMALL) else 0
    *_, more = _Passes(merged, scattering, light).until_settled(state, MAX_PASSES, ROUGH)
    spread_pairs(state, out)
    return number + more


def _can_merge(voxels: Voxels, least: int) -> bool:
    levels, rows, columns = voxels.extinction.shape
    return voxels.extinction.size >= least and levels >= 4 and rows % 2 == 0 and columns % 2 == 0


class _Passes:
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


def _merge(voxels: Voxels) -> Voxels:
    """Merge each two voxels along every axis."""
    extinction = merge_pairs(voxels.extinction)
    # The beam that clouds meet, not that of the space between them.
    scattered = merge_pairs(voxels.extinction * voxels.beam)
    beam = np.where(
        extinction > 0.0, scattered / np.maximum(extinction, 1e-9), merge_pairs(voxels.beam)
    )
    return Voxels(extinction, 2.0 * voxels.spacing, beam.astype(np.float32), voxels.leaving)
