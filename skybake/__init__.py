"""Physically based HDR sky maps for any sun, altitude and planet.

Names are imported when they are first used: the command line's help needs none
of numpy, numba and OpenImageIO.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from skybake.version import __version__

if TYPE_CHECKING:
    from skybake.baking import Baked, bake
    from skybake.errors import SkybakeError
    from skybake.image.settings import Encoding, Lighting, MapSettings, View, map_settings
    from skybake.pipeline import Pipeline, Sky
    from skybake.preset import load_preset
    from skybake.projection import Cubemap, Equirect, Fisheye, Perspective

__all__ = [
    "Baked",
    "Cubemap",
    "Encoding",
    "Equirect",
    "Fisheye",
    "Lighting",
    "MapSettings",
    "Perspective",
    "Pipeline",
    "Sky",
    "SkybakeError",
    "View",
    "__version__",
    "bake",
    "load_preset",
    "map_settings",
]

_HOMES = {
    "Baked": "skybake.baking",
    "Cubemap": "skybake.projection",
    "Encoding": "skybake.image.settings",
    "Equirect": "skybake.projection",
    "Fisheye": "skybake.projection",
    "Lighting": "skybake.image.settings",
    "MapSettings": "skybake.image.settings",
    "Perspective": "skybake.projection",
    "Pipeline": "skybake.pipeline",
    "Sky": "skybake.pipeline",
    "SkybakeError": "skybake.errors",
    "View": "skybake.image.settings",
    "bake": "skybake.baking",
    "load_preset": "skybake.preset",
    "map_settings": "skybake.image.settings",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
