"""Pictures as renderers write them."""

import math

import numpy as np
import OpenImageIO

from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset

EARTH = load_preset("earth")


def write_exr(path, planes, *, kinds=None, **attributes):
    """Write channels by name, shape (row, column), half unless `kinds` names another type."""
    height, width = next(iter(planes.values())).shape
    spec = OpenImageIO.ImageSpec(width, height, len(planes), "float")
    spec.channelnames = tuple(planes)
    formats = [(kinds or {}).get(name, "half") for name in planes]
    spec.channelformats = tuple(OpenImageIO.TypeDesc(each) for each in formats)
    for name, value in attributes.items():
        if isinstance(value, np.ndarray):
            spec.attribute(name, OpenImageIO.TypeDesc("matrix"), tuple(value.ravel().tolist()))
        else:
            spec[name] = value
    output = OpenImageIO.ImageOutput.create(str(path))
    assert output.open(str(path), spec)
    pixels = np.stack([np.asarray(plane, np.float32) for plane in planes.values()], axis=-1)
    assert output.write_image(np.ascontiguousarray(pixels))
    output.close()


def beauty(depth, light=0.2, alpha=1.0):
    """Channels of an even picture at depths."""
    even = np.full(np.shape(depth), light)
    cover = np.broadcast_to(alpha, np.shape(depth))
    return {"R": even, "G": even, "B": even, "A": cover, "Z": depth}


def scene(elevation=20.0, altitude=0.1, planet=EARTH, **settings):
    """Sun in the south; elevation in degrees, altitude in km."""
    return Scene(
        planet,
        map_settings(None, sun_elevation=math.radians(elevation), altitude=altitude, **settings),
    )
