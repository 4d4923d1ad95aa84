"""Transmittance between any place in the air and space, toward any direction above the horizon."""

from __future__ import annotations

import math
from collections.abc import Mapping as Values

import numpy as np

from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.luts.mapping import Mapping
from skybake.luts.table import Table, texels
from skybake.optics.medium import Array, Medium
from skybake.transport.density import add_column
from skybake.transport.geometry import distance_to_exit

STEPS = 48
"""Of each half of a ray."""


@kernel
def _fill_columns(medium, altitude, mu, first, last, scratch, out):
    """Write columns to space; rays that descend are followed from their lowest point both ways."""
    for i in range(first, last):
        r = medium.r_bottom + altitude[i]
        for c in range(out.shape[1]):
            out[i, c] = 0.0
        start, start_mu = r, mu[i]
        if mu[i] < 0.0:
            start, start_mu = r * math.sqrt(max(1.0 - mu[i] * mu[i], 0.0)), 0.0
            add_column(medium, start, 0.0, -r * mu[i], STEPS, scratch, out[i])
        length = distance_to_exit(start, start_mu, medium.r_top)
        add_column(medium, start, start_mu, length, STEPS, scratch, out[i])


def space_transmittance(
    medium: Medium, altitude: Array, mu: Array, workers: Workers = ALL_CPUS
) -> Array:
    """Transmittance of rays that miss the ground, each integrated by itself.

    Parameters
    ----------
    medium : Medium
        The air.
    altitude, mu : ndarray of float64, shape (ray,)
        Where rays start, at most at the top of the atmosphere [km], and cosines of their zenith
        angles.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray of float64, shape (ray, wavelength)
    """
    columns = np.empty((altitude.size, len(medium.extinction)))
    arguments = flatten(medium), flatten(altitude), flatten(mu)

    def work(first: int, last: int) -> None:
        _fill_columns(*arguments, first, last, np.empty(columns.shape[1]), columns)

    workers.run_rows(altitude.size, work, chunk=512)
    return np.exp(-columns @ medium.extinction)


def transmittance_table(
    medium: Medium,
    weights: Array,
    mapping: Mapping,
    size: tuple[int, ...],
    constants: Values[str, float],
    workers: Workers = ALL_CPUS,
) -> Table:
    """Tabulate the transmittance to space.

    Parameters
    ----------
    medium : Medium
        The air.
    weights : ndarray of float64, shape (wavelength, 3)
        RGB of sunlight is the sum of these; transmittance is that of each colour of it.
    mapping, size, constants
        Where the texels are, see `Mapping.texels`.
    workers : Workers, optional
        Threads that do the work.
    """
    places = mapping.texels(size, constants)
    altitude, mu = (
        np.ascontiguousarray(np.broadcast_to(places[name], size[::-1]).ravel())
        for name in mapping.inputs
    )
    passed = space_transmittance(medium, altitude, mu, workers) @ colour_shares(weights)
    return Table(
        name=mapping.table,
        values=texels(passed.reshape(*size[::-1], 3)),
        quantity="share of sunlight that passes between a place and space, along rays that miss "
        "the ground",
        unit="1",
        mapping=mapping,
    )


def colour_shares(weights: Array) -> Array:
    """Weights by which each colour of sunlight is averaged over wavelengths, (wavelength, 3)."""
    shares: Array = weights / weights.sum(axis=0)
    return shares
