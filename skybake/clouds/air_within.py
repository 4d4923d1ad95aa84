"""What the air between the clouds of a layer adds to light."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skybake.clouds.quadrature import Quadrature
from skybake.clouds.transfer import Entering, Voxels
from skybake.optics.medium import Array


class AirWithin(NamedTuple):
    """Air along the directions of a hemisphere, from where light enters a layer.

    Planes are in the order in which they are crossed, and at last where light leaves.

    Attributes
    ----------
    added : ndarray of float64, shape (z + 1, direction)
        Radiance that is added up to the middle of each plane.
    shared : ndarray of float64, shape (z + 1, direction)
        What is added besides, times the light under the layer as a share of a clear sky's.
    """

    added: Array
    shared: Array


def air_within(voxels: Voxels, quadrature: Quadrature, entering: Entering, side: int) -> AirWithin:
    """Find what the air of a layer adds to the light of its first channel.

    Parameters
    ----------
    voxels : Voxels
        The layer.
    quadrature : Quadrature
        Directions.
    entering : Entering
        Light from outside.
    side : int
        0 for what goes down, 1 for what goes up.

    Notes
    -----
    Without clouds radiance is that of clear air. With them, what it gains of sunlight scattered
    once is in their shadow, on average over each plane, and what it gains of the rest changes as
    the light at the top and at the base of the layer does, and linearly between. Inside clouds it
    gains nothing of that, and nothing of the light of clouds anywhere: where light comes from all
    sides, air sends on what it takes.
    """
    levels = len(voxels.extinction)
    height = (np.arange(levels) + 0.5) / levels
    beam = voxels.beam.mean(axis=(1, 2), dtype=float) * entering.sun_share[0]
    thickness = levels * float(voxels.spacing[0])
    between = np.exp(-thickness * voxels.extinction).mean(axis=(1, 2), dtype=float)
    if side == 0:
        height, beam, between = height[::-1], beam[::-1], between[::-1]
    ends = np.concatenate([[1.0 - side], height, [float(side)]])
    beam = np.append(beam, beam[-1])[:, None]
    single, diffuse = (
        np.diff(_between(each[0, side], ends), axis=0)
        for each in (entering.clear_single, entering.clear_diffuse)
    )
    clear = (entering.clear_single + entering.clear_diffuse)[0, 0, -1]
    above = quadrature.flux(entering.above[0]) / max(float(quadrature.flux(clear)), 1e-300)
    diffuse *= np.append(between, between[-1])[:, None]
    high = ends[1:, None]
    return AirWithin(
        np.cumsum(single * beam + diffuse * high * above, axis=0),
        np.cumsum(diffuse * (1.0 - high), axis=0),
    )


def _between(values: Array, height: Array) -> Array:
    """Interpolate values at even heights from 0 to 1, shape (height, direction)."""
    place = height * (len(values) - 1)
    below = np.minimum(place.astype(int), len(values) - 2)
    share = (place - below)[:, None]
    between: Array = values[below] + share * (values[below + 1] - values[below])
    return between
