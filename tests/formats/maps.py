"""Maps to write, and short ways to write them."""

import shutil
import sysconfig
from pathlib import Path

import numpy as np
import pytest

from skybake.colour.space import find_colour_space
from skybake.formats.spec import MapSpec
from skybake.formats.writer import open_map

WIDTH, HEIGHT = 128, 64


def sky(width=WIDTH, height=HEIGHT, seed=0):
    """Linear RGB from 1e-3 to 1, smooth with a little noise, as a sky is."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float32) / np.float32(height)
    noise = np.random.default_rng(seed).random((height, width, 3), dtype=np.float32)
    smooth = np.stack([0.3 * np.exp(-y - 2 * (x - 1) ** 2) + c for c in (0.01, 0.05, 0.1)], -1)
    return (smooth * (1.0 + 0.01 * noise)).astype(np.float32)


def map_spec(width=WIDTH, height=HEIGHT, colorspace="lin_rec709", **options):
    options = {"white_luminance": 39321.6, **options}
    return MapSpec(width, height, find_colour_space(colorspace), **options)


def write_map(path, rows, band=16, **options):
    """Write a map in bands and return its writer."""
    height, width = rows.shape[:2]
    with open_map(Path(path), map_spec(width, height, **options)) as writer:
        for y in range(0, height, band):
            writer.write_rows(y, min(y + band, height), rows[y : y + band])
    return writer


def program(name):
    """Path of a program that is not part of skybake; skips where it is not installed."""
    found = shutil.which(name) or shutil.which(name, path=sysconfig.get_path("scripts"))
    if found is None:
        pytest.skip(f"{name} is not installed")
    return found


def listing(folder):
    """Names of everything in a folder, hidden files too."""
    return sorted(path.name for path in Path(folder).iterdir())
