"""Samples in independent batches, from whose scatter standard errors come."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.jit.workers import ALL_CPUS

Array = npt.NDArray[np.float64]

BATCHES = 32
"""Independent means from which a standard error is computed, to 13 %."""


def samples_per_batch(samples: int) -> int:
    """Divide samples among `BATCHES`, rounded up.

    Raises
    ------
    InputError
        If there is none.
    """
    if samples < 1:
        message = f"samples: must be >= 1, got {samples}"
        raise InputError(message)
    return -(-samples // BATCHES)


def batch_seed(seed: int, row: int) -> np.uint64:
    """Start of an independent stream of random numbers for each row."""
    return np.uint64(np.random.SeedSequence([seed, row]).generate_state(1, np.uint64)[0])


def estimate_means(
    views: int,
    wavelengths: int,
    seed: int,
    mean: Callable[[int, int, np.uint64], float | Array],
    components: tuple[int, ...] = (),
) -> tuple[Array, Array]:
    """Estimate radiances from batches of samples, in parallel.

    Parameters
    ----------
    views, wavelengths : int
        How many there are.
    seed : int
        Same seed, same result, for any number of threads.
    mean : callable
        Mean of one batch for the view and the wavelength of these numbers, with this seed.
    components : tuple of int, optional
        Shape of what it returns.

    Returns
    -------
    mean, stderr : ndarray of float64, shape (view, wavelength, ...)
    """
    rows = views, wavelengths, BATCHES
    means = np.empty((*rows, *components))

    def trace_batches(begin: int, end: int) -> None:
        for row in range(begin, end):
            index = np.unravel_index(row, rows)
            means[index] = mean(int(index[0]), int(index[1]), batch_seed(seed, row))

    ALL_CPUS.run_rows(math.prod(rows), trace_batches)
    return means.mean(axis=2), means.std(axis=2, ddof=1) / math.sqrt(BATCHES)
