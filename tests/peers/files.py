"""Maps that the programs are given, and pictures that they give back."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenImageIO

from skybake.baking import bake
from skybake.image.settings import map_settings
from tests.peers.scenes import Sky, Views

SUN_ELEVATION, SUN_AZIMUTH = math.radians(32.0), math.radians(236.0)
WIDTH, JUDGE_WIDTH = 1024, 512


@dataclass(frozen=True)
class Files:
    """A map without the sun's disc, and the lights beside it.

    Attributes
    ----------
    map, json, script, usd : Path
        The map, its light as JSON, as a script for Blender, and as USD.
    sky : Sky
        The same sky with the disc in it.
    """

    map: Path
    json: Path
    script: Path
    usd: Path
    sky: Sky


def bake_files(folder, target):
    """Bake what a program is given, by the name of its target."""
    values = {"sun_elevation": SUN_ELEVATION, "sun_azimuth": SUN_AZIMUTH, "pixel": "float"}
    names = [folder / f"sky.{kind}" for kind in ("light.json", "py", "usda")]
    settings = map_settings(size=WIDTH, target=target, **{**values, "sun_disc": "exclude"})
    baked = bake("earth", folder / "sky.exr", settings, lights=names)
    full = bake("earth", folder / "full.exr", map_settings(size=JUDGE_WIDTH, **values))
    sky = Sky(read_pixels(full.files[0]), np.array(full.sun_direction))
    return Files(baked.files[0], *names, sky)


def read_pixels(path):
    """RGB of a file, shape (row, column, 3)."""
    image = OpenImageIO.ImageBuf(str(path))
    values = image.get_pixels(OpenImageIO.FLOAT)
    if image.has_error:
        raise OSError(f"{path}: {image.geterror()}")
    return values[..., :3]


def read_views(folder):
    """Views from files of their names."""
    return Views(*(read_pixels(folder / f"{name}.exr") for name in Views._fields))
