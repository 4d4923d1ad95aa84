"""Samples in independent batches, from whose scatter standard errors come."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError

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


def mean_and_error(means: Array) -> tuple[Array, Array]:
    """Mean over the last axis, which holds batches, and its standard error."""
    return means.mean(axis=-1), means.std(axis=-1, ddof=1) / math.sqrt(BATCHES)
