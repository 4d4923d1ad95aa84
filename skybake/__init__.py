"""Physically based HDR sky maps for any sun, altitude and planet.

Names are imported when they are first used: the command line's help needs none
of numpy, numba and OpenImageIO.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from skybake.version import __version__

if TYPE_CHECKING:
    from skybake.baking import Baked, MapSettings, bake
    from skybake.errors import SkybakeError
    from skybake.preset import load_preset
    from skybake.sky.sky import Sky

__all__ = ["Baked", "MapSettings", "Sky", "SkybakeError", "__version__", "bake", "load_preset"]

_HOMES = {
    "Baked": "skybake.baking",
    "MapSettings": "skybake.baking",
    "Sky": "skybake.sky.sky",
    "SkybakeError": "skybake.errors",
    "bake": "skybake.baking",
    "load_preset": "skybake.preset",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
