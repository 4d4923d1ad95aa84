"""Parts of a map that are kept in one file, and add up to it.

They are ``beauty``, the map as it is without parts; ``sky``; ``clouds``, premultiplied, with an
alpha that says how much of the sky they hide; ``sun`` and ``moon``, the discs; ``stars``, through
air and clouds; and ``transmittance`` of air and clouds to space. With all of them::

    beauty = sky * (1 - clouds.A) + clouds + sun + moon + stars

and without `sun` and `moon` in `beauty` if the disc is separate.
"""

from __future__ import annotations

import numpy as np

from skybake.image.layers import RGB, Pixels
from skybake.image.raster import Raster
from skybake.image.scene import Scene

RGBA = (*RGB, "A")


def part_names(scene: Scene) -> tuple[str, ...]:
    """Return the parts of a scene's map in the order of the file; one only if it has no parts.

    The first of them is what a program shows that reads no others.
    """
    lighting, encoding = scene.settings.lighting, scene.settings.encoding
    shows_sky = lighting.sun_disc != "only" and scene.settings.night.stars != "only"
    if not shows_sky or not (encoding.layers or lighting.sun_disc == "separate"):
        return ("beauty",)
    has_stars = encoding.layers and scene.stars is not None
    has_clouds = encoding.layers and scene.cloudscape is not None
    has_moon = "moon" in scene.layer_names
    has_beauty = encoding.layers and (has_clouds or has_stars or lighting.sun_disc == "include")
    is_there = {
        "beauty": has_beauty,
        "sky": True,
        "clouds": has_clouds,
        "sun": lighting.sun_disc != "exclude" and not scene.settings.moonlight.is_alone,
        "moon": has_moon,
        "stars": has_stars,
        "transmittance": lighting.sun_disc == "separate",
    }
    return tuple(name for name, there in is_there.items() if there)


def part_channels(name: str) -> tuple[str, ...]:
    """Return the channels of a part."""
    return RGBA if name == "clouds" else RGB


def band_parts(raster: Raster, scene: Scene, first: int, last: int) -> tuple[Pixels, ...]:
    """Return the parts of the rows first..last, in the order of `part_names`.

    Parameters
    ----------
    raster : Raster
        Of a picture of the map.
    scene : Scene
        What it shows.
    first, last : int
        Rows, the latter excluded.

    Returns
    -------
    tuple of ndarray of float32, shape (row, column, channel)
        Scene-linear; a transmittance is from 0 to 1.
    """
    names, clamps = part_names(scene), scene.settings.encoding.clamp_negative
    found: dict[str, Pixels] = {}
    hidden: Pixels | None = None
    if scene.cloudscape is not None and {"clouds", "transmittance"} & set(names):
        apart = _clamped(raster.band("apart", first, last), clamps)
        clear, clouded, hidden = apart[..., :3], apart[..., 3:6], apart[..., 6:]
        found["clouds"] = np.concatenate([clouded - clear * (1.0 - hidden), hidden], axis=2)
        found["sky"] = clear if "clouds" in names else clouded
    else:
        found["sky"] = clouded = _clamped(raster.band("sky", first, last), clamps)
    found |= {
        name: _clamped(raster.band(name, first, last), clamps)
        for name in ("sun", "moon", "stars")
        if name in names
    }
    if "beauty" in names:
        is_whole = scene.settings.lighting.sun_disc == "include"
        added = ("sun", "moon", "stars") if is_whole else ("stars",)
        found["beauty"] = sum((found[name] for name in added if name in found), clouded)
    if "transmittance" in names:
        through = _clamped(raster.band("transmittance", first, last), clamps)
        found["transmittance"] = through if hidden is None else through * (1.0 - hidden)
    return tuple(np.ascontiguousarray(found[name]) for name in names)


def _clamped(pixels: Pixels, clamps: bool) -> Pixels:
    return np.maximum(pixels, np.float32(0.0)) if clamps else pixels
