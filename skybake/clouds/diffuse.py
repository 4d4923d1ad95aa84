"""Diffuse light in a layer of voxels, by iteration over all orders of scattering."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skybake.clouds.merging import merge_levels, merge_pairs
from skybake.clouds.passes import Passes
from skybake.clouds.transfer import Entering, Floats, Scattering, Voxels
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

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

FAR = 6e-4
"""The same under suns over clouds that are far away, which start from the light of the next sun."""


class Known(NamedTuple):
    """Moments of a channel: in cloudy voxels, and in merged ones if those were solved for."""

    moments: Floats
    merged: Floats | None


class Diffuse(NamedTuple):
    """Diffuse light of a layer.

    Attributes
    ----------
    moments : ndarray of float32, shape (channel, z, y, harmonic, x)
        Of the radiance in each voxel.
    up : ndarray of float64, shape (direction, channel)
        Mean radiance at the top along the upward directions.
    down : ndarray of float64, shape (channel,)
        Mean irradiance of a horizontal plane at the base.
    passes : int
        How many it took, those on merged voxels included.
    known : tuple of Known
        By channel, from which light under another sun may start.
    """

    moments: Floats
    up: Array
    down: Array
    passes: int
    known: tuple[Known, ...]


def solve_diffuse(
    voxels: Voxels,
    scattering: Scattering,
    entering: Entering,
    workers: Workers,
    near: tuple[Known, ...] | None = None,
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
    near : tuple of Known, optional
        Light of the same voxels under another sun, from which to start.

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
    down, passes = np.empty(channels), np.zeros(channels, int)
    up = np.empty((len(scattering.quadrature.weight) // 2, channels))

    known: list[Known | None] = [None] * channels

    def solve(channel: int, like: Known | None, tolerance: float) -> None:
        light = Entering(*(part[channel : channel + 1] for part in entering))
        made = Passes(voxels, scattering, light)
        solved, passes[channel] = _solve_channel(voxels, scattering, light, made, like, tolerance)
        up[:, channel], down[channel] = made.finish(solved.moments, moments[channel])
        known[channel] = solved

    middle = channels // 2
    others = list(range(channels))
    if near is None:
        # Particles are grey, so that channels differ in little but their brightness.
        solve(middle, None, FINE)
        others.remove(middle)

    def work(first: int, last: int) -> None:
        for channel in others[first:last]:
            if near is None:
                solve(channel, known[middle], FINE)
            else:
                solve(channel, near[channel], FAR)

    workers.run_rows(len(others), work)
    solved = tuple(each for each in known if each is not None)
    return Diffuse(moments, up, down, int(passes.max()), solved)


def _solve_channel(
    voxels: Voxels,
    scattering: Scattering,
    entering: Entering,
    passes: Passes,
    like: Known | None,
    tolerance: float,
) -> tuple[Known, int]:
    if not _can_merge(voxels, LARGE):
        known, number = passes.until_settled(passes.dark(), MAX_PASSES, TOLERANCE)
        return Known(known, None), number
    merged, before = _merged_light(voxels, scattering, entering)
    if like is None or like.merged is None:
        start = passes.spread(merged)
    else:
        # What merging loses is lost of both alike: only what they differ in is spread.
        alike = _share_alike(merged, like.merged)
        start = passes.spread(merged - alike * like.merged) + alike * like.moments
    known, number = passes.until_settled(start, MAX_PASSES, tolerance)
    return Known(known, merged), before + number


def _share_alike(light: Floats, other: Floats) -> np.float32:
    """Factor of the other light at which it is nearest to the first."""
    square = float(np.vdot(other, other))
    return np.float32(float(np.vdot(light, other)) / square if square > 0.0 else 0.0)


def _merged_light(voxels: Voxels, scattering: Scattering, entering: Entering) -> tuple[Floats, int]:
    """Return the moments in merged voxels, and how many passes that took."""
    merged = _merge(voxels)
    levels, rows, columns = merged.extinction.shape
    light = entering._replace(sun=merge_levels(entering.sun, levels))
    passes = Passes(merged, scattering, light)
    start, before = passes.dark(), 0
    if _can_merge(merged, SMALL):
        coarser, before = _merged_light(merged, scattering, light)
        start = passes.spread(coarser)
    known, number = passes.until_settled(start, MAX_PASSES, ROUGH)
    moments = np.empty((levels, rows, (scattering.order + 1) ** 2, columns), np.float32)
    passes.finish(known, moments)
    return moments, before + number


def _can_merge(voxels: Voxels, least: int) -> bool:
    levels, rows, columns = voxels.extinction.shape
    return voxels.extinction.size >= least and levels >= 4 and rows % 2 == 0 and columns % 2 == 0


def _merge(voxels: Voxels) -> Voxels:
    """Merge each two voxels along every axis."""
    extinction = merge_pairs(voxels.extinction)
    # The beam that clouds meet, not that of the space between them.
    scattered = merge_pairs(voxels.extinction * voxels.beam)
    beam = np.where(
        extinction > 0.0, scattered / np.maximum(extinction, 1e-9), merge_pairs(voxels.beam)
    )
    return Voxels(extinction, 2.0 * voxels.spacing, beam.astype(np.float32), voxels.leaving)
