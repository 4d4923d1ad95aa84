"""Cumuli: flat at the level of condensation, and of bubbles on bubbles above it."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.fit import Surface, fitted_field
from skybake.cloud_fields.noise import billows, random_volume
from skybake.cloud_fields.population import Bubbles, cumulus_bubbles
from skybake.cloud_fields.scales import displacements, dyadic
from skybake.cloud_fields.slopes import limit_slopes
from skybake.cloud_fields.trilinear import between_nodes
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS

_COLUMNS = 384
_NODES_PER_SIZE = 28.0
_WARP_SIZE = 64
_WARPS_PER_TILE = 5


def cumulus(
    cover: float, base: float, depth: float, size: float, optical_depth: float, seed: int
) -> CloudField:
    """Return a field of cumuli.

    Parameters
    ----------
    cover : float
        Share of the sky they cover, seen from below, in (0, 1].
    base : float
        Altitude of their level of condensation. [km]
    depth : float
        Height of a cloud of this size. [km]
    size : float
        Diameter of large ones. [km]
    optical_depth : float
        Vertical, mean where there is cloud.
    seed : int
        Another one, another sky.

    Notes
    -----
    Extinction inside goes with the height above the base to the power of 2/3, as for the water
    of an adiabatic parcel in a constant number of droplets: bases are grey and tops white.
    """
    spacing = dyadic(size / _NODES_PER_SIZE)
    period = _COLUMNS * spacing
    rise = dyadic(max(0.8 * spacing, depth / 36.0))
    below, above = math.ceil(0.12 * size / rise), math.ceil((1.25 * depth + 0.2 * size) / rise)
    heights = rise * np.arange(-below, above + 1)
    nodes = np.full((len(heights), _COLUMNS, _COLUMNS), 0.25 * size, np.float32)
    margin = 0.25 * size
    for bubbles in cumulus_bubbles(cover, size, depth, period, seed):
        _stamp(nodes, bubbles, (spacing, rise, float(heights[0])), margin)
    nodes = _warped(nodes, spacing, rise, 0.055 * size, seed)
    steps = np.array([rise, spacing, spacing])
    limit_slopes(nodes, steps)
    surface = Surface(
        nodes=nodes,
        spacing=steps,
        base=base + float(heights[0]),
        profile=np.maximum(heights + 0.06 * depth, 0.03 * depth) ** (2.0 / 3.0),
        edge=0.026 * size,
        widest_edge=0.2 * size,
        condensation=base,
        displacement=displacements(
            (period, period),
            [(0.075 * size, 0.62 * size), (0.02 * size, 0.14 * size), (0.005 * size, 0.036 * size)],
            seed,
        ),
        noise=billows(seed),
    )
    return fitted_field(surface, cover, optical_depth, 0.12 * size)


def _stamp(
    nodes: npt.NDArray[np.float32],
    bubbles: Bubbles,
    steps: tuple[float, float, float],
    margin: float,
) -> None:
    def work(first: int, last: int) -> None:
        _stamp_bubbles(nodes, bubbles.centre, bubbles.radius, *steps, margin, first, last)

    ALL_CPUS.run_rows(len(nodes), work, chunk=4)


def _warped(
    nodes: npt.NDArray[np.float32], spacing: float, rise: float, amplitude: float, seed: int
) -> npt.NDArray[np.float32]:
    """Move what is round by a smooth flow, so that no two bulges look alike."""
    period = _COLUMNS * spacing / _WARPS_PER_TILE
    shortest = 3.0 * period / _WARP_SIZE
    flow = random_volume(_WARP_SIZE, period, -2.5, (shortest, 0.2 * period), (seed, 4))
    flow = np.clip(flow, -2.5, 2.5).astype(np.float32)
    warped = np.empty_like(nodes)

    def work(first: int, last: int) -> None:
        _warp(nodes, flow, period, spacing, rise, amplitude, warped, first, last)

    ALL_CPUS.run_rows(len(nodes), work, chunk=4)
    return warped


@kernel
def _stamp_bubbles(nodes, centres, radii, spacing, rise, lowest, margin, first, last):
    """Unite spheres with what is there, smoothly, in planes from `first` to below `last`."""
    _, rows, columns = nodes.shape
    for b in range(radii.shape[0]):
        x, y, z = centres[b, 0], centres[b, 1], centres[b, 2] - lowest
        radius = radii[b]
        reach = radius + margin
        blend = 0.15 * radius
        k0 = max(first, math.ceil((z - reach) / rise))
        k1 = min(last, math.floor((z + reach) / rise) + 1)
        for k in range(k0, k1):
            dz = k * rise - z
            half = math.sqrt(max(reach * reach - dz * dz, 0.0))
            j0, j1 = math.ceil((y - half) / spacing), math.floor((y + half) / spacing)
            for j in range(j0, j1 + 1):
                dy = j * spacing - y
                flat = dz * dz + dy * dy
                wide = math.sqrt(max(reach * reach - flat, 0.0))
                i0 = math.ceil((x - wide) / spacing)
                i1 = math.floor((x + wide) / spacing)
                row = nodes[k, j % rows]
                column = i0 % columns
                for i in range(i0, i1 + 1):
                    dx = i * spacing - x
                    distance = math.sqrt(flat + dx * dx) - radius
                    before = row[column]
                    mixed = max(blend - abs(distance - before), 0.0)
                    row[column] = min(distance, before) - 0.25 * mixed * mixed / blend
                    column = column + 1 if column + 1 < columns else 0


@kernel
def _warp(nodes, flow, period, spacing, rise, amplitude, warped, first, last):
    """Look each node's distance up where the flow comes from."""
    levels, rows, columns = nodes.shape
    size = flow.shape[0]
    scale = size / period
    for k in range(first, last):
        for j in range(rows):
            for i in range(columns):
                fx, fy, fz = i * spacing * scale, j * spacing * scale, k * rise * scale
                dx = amplitude * between_nodes(flow, fx, fy, fz)
                dy = amplitude * between_nodes(
                    flow, fx + 0.31 * size, fy + 0.43 * size, fz + 0.59 * size
                )
                dz = amplitude * between_nodes(
                    flow, fx + 0.67 * size, fy + 0.13 * size, fz + 0.23 * size
                )
                x, y = i + dx / spacing, j + dy / spacing
                z = min(max(k + 0.6 * dz / rise, 0.0), levels - 1.001)
                warped[k, j, i] = _lookup(nodes, x, y, z)


@kernel
def _lookup(volume, x, y, z):
    """Trilinear value at coordinates in nodes, periodic in x and y."""
    levels, rows, columns = volume.shape
    k, j, i = math.floor(z), math.floor(y), math.floor(x)
    u, v, w = x - i, y - j, z - k
    i, j = i % columns, j % rows
    east, north = (i + 1) % columns, (j + 1) % rows
    up = min(k + 1, levels - 1)
    a = volume[k, j, i] + u * (volume[k, j, east] - volume[k, j, i])
    b = volume[k, north, i] + u * (volume[k, north, east] - volume[k, north, i])
    c = volume[up, j, i] + u * (volume[up, j, east] - volume[up, j, i])
    d = volume[up, north, i] + u * (volume[up, north, east] - volume[up, north, i])
    a += v * (b - a)
    c += v * (d - c)
    return a + w * (c - a)
