"""Maps baked for tests, and the light in them, read by OpenImageIO."""

import math
from pathlib import Path

import numpy as np
import OpenImageIO

from skybake.baking import bake
from skybake.colour.space import luminance_weights
from skybake.image.settings import map_settings
from skybake.projection import cubemap, equirect


def bake_map(path, preset="earth", elevation=30.0, **options):
    """Bake with the sun's elevation in degrees; small unless told otherwise."""
    options = {"size": 128, **options}
    settings = map_settings(sun_elevation=math.radians(elevation), **options)
    return bake(preset, path, settings), settings


def pixels(path):
    """RGB of a file, shape (row, column, 3)."""
    image = OpenImageIO.ImageBuf(str(path))
    values = image.get_pixels(OpenImageIO.FLOAT)
    assert not image.has_error, image.geterror()
    return values[..., :3]


def luminance(path, settings):
    """Luminance of a file's pixels, in cd/m2."""
    weights = luminance_weights(settings.encoding.space)
    return pixels(path).astype(float) @ weights * settings.encoding.white_luminance


def texels(baked, settings):
    """Directions, solid angles and luminances of all texels of a baked map, each flat."""
    projection = settings.view.projection
    if projection.name == "equirect":
        width = projection.width
        vectors = equirect.directions(width, width // 2)
        size = np.repeat(equirect.solid_angles(width, width // 2)[:, None], width, axis=1)
        values = luminance(baked.files[0], settings)
        return vectors.reshape(-1, 3), size.ravel(), values.ravel()
    assert [Path(file).stem[-2:] for file in baked.files] == list(cubemap.FACES)
    edge = projection.edge
    return (
        np.concatenate([cubemap.face_directions(f, edge).reshape(-1, 3) for f in cubemap.FACES]),
        np.tile(cubemap.solid_angles(edge).ravel(), 6),
        np.concatenate([luminance(file, settings).ravel() for file in baked.files]),
    )


def illuminance(baked, settings, facing=(0.0, 1.0, 0.0)):
    """Illuminance of a plane that faces a direction by all texels before it, in lx."""
    vectors, size, values = texels(baked, settings)
    return float((values * size) @ np.maximum(vectors @ np.asarray(facing), 0.0))
