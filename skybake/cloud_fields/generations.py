"""Clouds that come and go.

Each generation is a tile of its own, whose clouds grow while those of another shrink.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.fit import mean_depth
from skybake.cloud_fields.noise import random_map
from skybake.cloud_fields.patches import erosion_at
from skybake.cloud_fields.patching import vanishing_of
from skybake.cloud_fields.surface import STEP
from skybake.cloud_fields.surface_bounds import with_clearance
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS

_FARTHEST = 32767


def field_of_age(build: Callable[[int], CloudField], seed: int, age: float) -> CloudField:
    """Return the field of a layer whose clouds are replaced by others again and again.

    Parameters
    ----------
    build : callable
        Makes the field of a seed.
    seed : int
        Of the layer as it is at the age of 0.
    age : float
        Generations that have passed. Not all places are of the same age, so that at no moment
        all clouds are large.

    Notes
    -----
    Surfaces of two generations are eroded as those of patches are, in time instead of in place.
    """
    first = build(seed)
    if age == 0.0:
        return first
    ages = _ages(first, seed, age)
    numbers = range(math.floor(ages.min()), math.ceil(ages.max()) + 1)
    fields = {each: build(_seed(seed, each)) for each in numbers}
    tallest = max((first, *fields.values()), key=lambda each: each.distance.shape[0])
    merged = np.full(tallest.distance.shape, _FARTHEST, np.int16)
    for number, field in fields.items():
        lifted = float(first.shift[0] - field.shift[0])
        _merge_all(field, ages, number, lifted, merged)
    whole = first._replace(distance=merged, extinction=tallest.extinction, top=tallest.top)
    # Clouds are smaller while others take their place.
    scale = mean_depth(first) / max(mean_depth(whole), 1e-9)
    return with_clearance(
        whole._replace(extinction=scale * whole.extinction, vanishing=vanishing_of(whole))
    )


def _ages(field: CloudField, seed: int, age: float) -> npt.NDArray[np.float64]:
    """Return how many generations have passed in each column, shape (y, x)."""
    shape = field.distance.shape[1], field.distance.shape[2]
    width, height = (float(each) for each in field.period)
    scales = 0.2 * width, 0.5 * width
    late = random_map(shape, (height, width), -3.0, scales, (seed, 16))
    late = np.clip(0.5 + 0.2 * late, 0.0, 1.0)
    # At first, and before it, there is one generation everywhere.
    return np.asarray(np.maximum(age - late, 0.0) if age > 0.0 else np.minimum(age + late, 0.0))


def _seed(seed: int, number: int) -> int:
    if number == 0:
        return seed
    return int(np.random.default_rng([seed, 17, number % 2**32]).integers(2**31))


def _merge_all(
    field: CloudField,
    ages: npt.NDArray[np.float64],
    number: int,
    lifted: float,
    merged: npt.NDArray[np.int16],
) -> None:
    def work(first: int, last: int) -> None:
        _merge(field, ages, float(number), lifted, merged, first, last)

    ALL_CPUS.run_rows(field.distance.shape[0], work, chunk=4)


@kernel
def _merge(field, ages, number, lifted, merged, first, last):
    """Unite a generation with what is there, in planes from `first` to below `last`."""
    _, rows, columns = merged.shape
    for k in range(first, last):
        for j in range(rows):
            for i in range(columns):
                across = 2.0 * abs(ages[j, i] - number) - 1.0
                if across >= 1.0:
                    continue
                moved = (erosion_at(field, across) + lifted) / STEP
                distance = round(field.distance[k, j, i] + moved)
                merged[k, j, i] = min(merged[k, j, i], distance)
