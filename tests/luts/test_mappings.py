"""Mappings there and back, and the formulas that they are written in."""

import math

import numpy as np
import pytest

from skybake.luts.formula import evaluate
from skybake.luts.parametrisations import (
    CONSTANTS,
    LEAST_SUN_COSINE,
    PARAMETRISATIONS,
    TABLES,
    find_mappings,
)
from skybake.luts.settings import TableSettings

SIZES = TableSettings().sizes
NUDGE = 1e-11
"""Angle from the horizon, where rows crowd as a root of it. [rad]"""


def constants(altitude):
    radius = 6360.0 + altitude
    values = {
        "PI": math.pi,
        "BOTTOM_RADIUS": 6360.0,
        "TOP_RADIUS": 6460.0,
        "LEAST_SUN_COSINE": LEAST_SUN_COSINE,
        "OBSERVER_ALTITUDE": altitude,
        "HORIZON": math.pi - math.asin(6360.0 / radius),
        "FAR": 128.0,
        "NEAREST": 0.03,
    }
    assert values.keys() == CONSTANTS.keys()
    return values


@pytest.mark.parametrize("altitude", [0.002, 0.5, 60.0])
@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("name", PARAMETRISATIONS)
def test_what_a_texel_stands_for_is_looked_up_in_its_middle(name, table, altitude):
    mapping, size, known = find_mappings(name)[table], SIZES[table], constants(altitude)
    inputs = mapping.texels(size, known)
    if table == "sky_view":
        # At the horizon itself one of two rows is found.
        is_above = np.arange(size[1])[:, None] < size[1] // 2
        nudged = np.where(
            is_above,
            np.minimum(inputs["zenith"], known["HORIZON"] - NUDGE),
            np.maximum(inputs["zenith"], known["HORIZON"] + NUDGE),
        )
        inputs = {**inputs, "zenith": nudged}
    found = mapping.coordinates(size, {**known, **inputs})
    for axis, coordinate in enumerate(found):
        shape = [1] * len(size)
        shape[len(size) - 1 - axis] = size[axis]
        texel = np.arange(size[axis]).reshape(shape) + 0.5
        assert np.abs(coordinate * size[axis] - texel).max() < 0.02


@pytest.mark.parametrize("name", PARAMETRISATIONS)
def test_single_precision_finds_the_same_texels(name):
    """Shaders compute in it; a tenth of a texel is not seen."""
    size, known = SIZES["transmittance"], constants(0.5)
    mapping = find_mappings(name)["transmittance"]
    inputs = mapping.texels(size, known)
    single = {key: np.float32(value) for key, value in {**known, **inputs}.items()}
    exact = mapping.coordinates(size, {**known, **inputs})
    for axis, (one, other) in enumerate(zip(mapping.coordinates(size, single), exact, strict=True)):
        assert np.abs(one - other).max() * size[axis] < 0.1


def test_a_formula_takes_both_branches_apart():
    found = evaluate("y = sqrt(x) if x > 0 else -x / 2", {"x": [-4.0, 9.0]})
    np.testing.assert_array_equal(found["y"], [2.0, 3.0])


@pytest.mark.parametrize(
    "text", ["x = __import__('os')", "x = [1]", "x = a.b", "import os", "x = 'text'", "x = f(1)"]
)
def test_what_is_no_formula_is_refused(text):
    with pytest.raises((ValueError, KeyError)):
        evaluate(text, {"a": 1.0})
