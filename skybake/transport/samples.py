"""Work space for rays that are traced together: their sample points, one ray after another."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Array, Medium

MAX_SAMPLES = 4096
"""Samples of one ray at most."""

BATCH_SAMPLES = MAX_SAMPLES + 2048
"""Samples of one batch at most: what two rays of the longest kind do not fit into, and what
some fifty ordinary rays leave in a processor's cache."""

BATCH_RAYS = 256


class Samples(NamedTuple):
    """What is known of a batch of rays before any light is added.

    Attributes
    ----------
    distance, radius : ndarray of float64, shape (sample,)
        Distance from the observer and from the planet's centre. [km]
    density : ndarray of float64, shape (sample, constituent)
        Relative densities.
    column_to : ndarray of float64, shape (sample, constituent)
        Columns from the observer. [km]
    weight : ndarray of float64, shape (sample, wavelength)
        Transmittance to the observer times the length that the sample represents
        for; a sum of weight * source is the integral along the ray. [km]
    first, number : ndarray of int64, shape (ray,)
        First sample of each ray of the batch and how many there are: two for each step.
    length : ndarray of float64, shape (ray,)
        Distance to the end of the ray. [km]
    hits_ground : ndarray of bool, shape (ray,)
        Whether the ray ends on the ground.
    transmittance : ndarray of float64, shape (ray, wavelength)
        Transmittance of the whole ray.
    column : ndarray of float64, shape (ray, constituent)
        Columns of the whole ray. [km]
    """

    distance: Array
    radius: Array
    density: Array
    column_to: Array
    weight: Array
    first: npt.NDArray[np.int64]
    number: npt.NDArray[np.int64]
    length: Array
    hits_ground: npt.NDArray[np.bool_]
    transmittance: Array
    column: Array


def allocate_samples(medium: Medium, rays: int = BATCH_RAYS) -> Samples:
    """Make the work space for so many rays through `medium`; each thread needs its own."""
    constituents, wavelengths = medium.extinction.shape
    return Samples(
        distance=np.empty(BATCH_SAMPLES),
        radius=np.empty(BATCH_SAMPLES),
        density=np.empty((BATCH_SAMPLES, constituents)),
        column_to=np.empty((BATCH_SAMPLES, constituents)),
        weight=np.empty((BATCH_SAMPLES, wavelengths)),
        first=np.empty(rays, np.int64),
        number=np.empty(rays, np.int64),
        length=np.empty(rays),
        hits_ground=np.empty(rays, np.bool_),
        transmittance=np.empty((rays, wavelengths)),
        column=np.empty((rays, constituents)),
    )
