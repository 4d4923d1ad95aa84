"""Clouds before things at known distances, and their shadows in the air up to there."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.clouds.cloudscape import Cloudscape
from skybake.clouds.compose import at_place, next_layer, place_along
from skybake.clouds.dimming import Dimming
from skybake.clouds.directions import unit_vectors
from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

RAYS_AT_ONCE = 4096
"""Rays that a thread takes at a time."""


class CloudsBefore:
    """Clouds of a cloudscape, up to given distances.

    Parameters
    ----------
    cloudscape : Cloudscape
        The clouds.
    """

    def __init__(self, cloudscape: Cloudscape) -> None:
        self._cloudscape = cloudscape
        self._lit, self._through, self._distance = cloudscape.nodes
        rays, _ = cloudscape.node_rays
        # The same rays, in the sun all along and without what clouds reflect.
        table = rays.table._replace(glow=np.zeros_like(rays.table.glow))
        clear = rays._replace(table=table, visible=np.ones_like(rays.visible))
        self._clear, _ = cloudscape.lit(clear, _no_dimming(cloudscape.dimming))

    def put_before(
        self,
        air: Floats,
        total: Floats,
        zenith: Array,
        bearing: Array,
        distance: Array,
        pixel: float,
    ) -> tuple[Floats, Floats]:
        """Put clouds into the light of clear air before things.

        Parameters
        ----------
        air, total : ndarray of float32, shape (ray, channel)
            Light of clear air up to the things, and of all a clear sky.
        zenith, bearing : ndarray of float64, shape (ray,)
            Directions. [rad]
        distance : ndarray of float64, shape (ray,)
            Where the things are. [km]
        pixel : float
            As of `Cloudscape.put_into`.

        Returns
        -------
        light : ndarray of float32, shape (ray, channel)
            Of air and clouds.
        passing : ndarray of float32, shape (ray,)
            Share of the things' light that clouds let through.

        Notes
        -----
        Clouds are followed up to the thing, so that it sinks into them by and by. The air between
        those of a layer is divided at their mean distance.
        """
        clouds = self._cloudscape
        distance = np.ascontiguousarray(distance)
        seen, passing = clouds.see(unit_vectors(zenith, bearing), pixel, distance)
        count = zenith.size
        row, weight = np.empty((count, 4), np.int64), np.empty((count, 4))
        clouds.find_places(zenith, bearing, row, weight)
        light, passes = np.empty_like(air), np.empty(count, np.float32)
        nodes = row, weight, self._distance, self._lit, self._clear, self._through
        rays = seen, passing, distance, air, total
        flat = [flatten(each) for each in (*nodes, *rays)]

        def work(first: int, last: int) -> None:
            fill_before(*flat, first, last, light, passes)

        clouds.workers.run_rows(count, work, chunk=RAYS_AT_ONCE)
        return light, passes


def _no_dimming(dimming: Dimming) -> Dimming:
    return Dimming(
        dimming.altitude,
        np.ones_like(dimming.ratio),
        np.ones_like(dimming.ground),
        np.zeros_like(dimming.irradiance),
    )


@kernel
def fill_before(
    row,
    weight,
    distance,
    lit,
    clear,
    through,
    seen,
    passing,
    ends,
    air,
    total,
    first,
    last,
    light,
    passes,
):
    """Write the light of air and clouds up to things, and what passes.

    Parameters
    ----------
    row, weight, distance, lit, through, seen, passing, total, first, last
        As of `compose`.
    clear : ndarray of float32
        As `lit`, without clouds.
    ends : ndarray of float64, shape (ray,)
        Distances of the things. [km]
    air : ndarray of float32, shape (ray, channel)
        Light of clear air up to them.
    light, passes : ndarray of float32, shapes (ray, channel) and (ray,)
        Receive the result.
    """
    layers, _, channels = seen.shape
    stretches = distance.shape[1] - 1
    for n in range(first, last):
        begin = end = 0.0
        for p in range(4):
            begin += weight[n, p] * distance[row[n, p], 0]
            end += weight[n, p] * distance[row[n, p], stretches]
        goal = place_along(ends[n], begin, end, stretches)
        for c in range(channels):
            light[n, c] = 0.0
        passed, done, before = 1.0, -1.0, -1.0
        for _ in range(layers + 1):
            nearest, layer = next_layer(passing[:, n], done, ends[n])
            place = goal if layer < 0 else place_along(nearest, begin, end, stretches)
            for c in range(channels):
                gained = at_place(lit, row[n], weight[n], place, c)
                if before >= 0.0:
                    gained -= at_place(lit, row[n], weight[n], before, c)
                near = _until(air[n, c], total[n, c], clear, row[n], weight[n], goal, stretches, c)
                whole = at_place(clear, row[n], weight[n], goal, c)
                light[n, c] += passed * near * (gained / whole if whole > 0.0 else 0.0)
                if layer >= 0:
                    dimmed = at_place(through, row[n], weight[n], place, c)
                    light[n, c] += passed * dimmed * seen[layer, n, c]
                else:
                    # Beyond all clouds the air is clear.
                    light[n, c] += passed * (air[n, c] - near)
            if layer < 0:
                break
            passed *= passing[layer, n, 0]
            done, before = nearest, place
        passes[n] = passed


@kernel
def _until(air, total, clear, row, weight, goal, stretches, channel):
    """Light of clear air up to a place among the stretches that clouds change."""
    if goal < stretches:
        return air
    return min(air, total * at_place(clear, row, weight, float(stretches), channel))
