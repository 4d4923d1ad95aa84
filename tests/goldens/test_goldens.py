"""Small maps as they were, to show what a change of code does to the pictures.

``pytest tests/goldens --update-goldens`` writes them anew; a failure leaves the map, the
golden and their difference in the folder that the message names.
"""

from pathlib import Path

import numpy as np
import pytest

from skybake.colour.space import find_colour_space
from skybake.formats.spec import MapSpec
from skybake.formats.writer import open_map
from tests.baking.maps import bake_map, pixels

FOLDER = Path(__file__).parent / "maps"
CASES = [
    ("earth", 60.0, 0.0),
    ("earth", 2.0, 0.0),
    ("earth", -4.0, 0.0),
    ("earth", 20.0, 400.0),
    ("mars", 30.0, 0.0),
    ("mars", 1.0, 0.0),
    ("earth-hillaire2020", 30.0, 0.0),
    ("earth-hillaire2020", 0.0, 0.0),
]

TYPICAL = 0.002
"""Root mean square of the differences, relative to the pixels."""

WORST = 0.02
"""Largest difference relative to the pixel, or to a thousandth of the brightest sky."""


def write(path, rows):
    spec = MapSpec(rows.shape[1], rows.shape[0], find_colour_space("lin_rec709"), 1.0, "float")
    with open_map(path, spec) as writer:
        writer.write_rows(0, len(rows), np.ascontiguousarray(rows, dtype=np.float32))


@pytest.mark.parametrize(("preset", "elevation", "altitude"), CASES)
def test_map_is_as_it_was(tmp_path, request, preset, elevation, altitude):
    name = f"{preset}_{elevation:+05.1f}deg_{altitude:g}km.exr"
    golden = FOLDER / name
    options = {"altitude": altitude, "size": 64, "pixel": "float"}
    if request.config.getoption("--update-goldens"):
        FOLDER.mkdir(exist_ok=True)
        bake_map(golden, preset, elevation, **options)
        pytest.skip(f"wrote {golden}")
    assert golden.exists(), "run pytest tests/goldens --update-goldens"
    bake_map(tmp_path / name, preset, elevation, **options)
    expected, got = pixels(golden), pixels(tmp_path / name)
    # The sun's disc outshines the sky a million times: its pixels are no scale for others.
    brightness = np.abs(expected).max(axis=-1)
    scale = np.maximum(brightness, 1e-3 * np.quantile(brightness, 0.99))
    error = np.abs(got - expected).max(axis=-1) / scale
    if error.max() >= WORST or np.sqrt(np.mean(error**2)) >= TYPICAL:
        write(tmp_path / f"golden_{name}", expected)
        write(tmp_path / f"difference_{name}", got - expected)
        pytest.fail(
            f"{name}: largest difference {error.max():.2%}, rms {np.sqrt(np.mean(error**2)):.2%}; "
            f"see golden_ and difference_ in {tmp_path}"
        )
