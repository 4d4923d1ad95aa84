"""How programs take lighting maps that are made for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from skybake.errors import InputError
from skybake.ibl.settings import FORMATS
from skybake.image.target import find_target


@dataclass(frozen=True, kw_only=True)
class Program:
    """How one program takes lighting maps.

    Attributes
    ----------
    formats : tuple of str
        Those of `skybake.ibl.settings.FORMATS` that it takes, the usual one first.
    space, face_names : str
        As of `skybake.projection.cubemap.Cubemap`.
    pixel : str
        Stored type, or auto.
    units : str
        As of `skybake.image.settings.Encoding`.
    sun_disc : str
        As of `skybake.image.settings.Lighting`.
    mapping : str
        As of `skybake.ibl.settings.LightingMaps`.
    mips : int
        Levels of the specular cube.
    dfg_multiscatter, dfg_upward : bool
        As of `skybake.ibl.settings.LightingMaps`.
    """

    formats: tuple[str, ...] = FORMATS
    space: str = "world"
    face_names: str = "px"
    pixel: str = "auto"
    units: str = "ev15"
    sun_disc: str = "include"
    mapping: str = "linear"
    mips: int = 7
    dfg_multiscatter: bool = False
    dfg_upward: bool = False

    @property
    def format(self) -> str:
        """The usual format."""
        return self.formats[0]


ANY = Program()
"""For a program that is not known."""

_PROGRAMS: dict[str, dict[str, Any]] = {
    # The aureole of the sun is brighter in cd/m2 than 32 bits of three colours hold; Bevy
    # multiplies texels by the `intensity` of a light, which is the luminance of white here.
    "bevy": {"formats": ("ktx2",), "pixel": "rgb9e5", "units": "ev15"},
    # Its loader of KTX 2 makes no cube of texels that are not compressed.
    "three": {"formats": ("exr",)},
    # cmgen's names, and the roughness that Filament's shaders look for in a level.
    "filament": {
        "formats": ("exr", "ktx2"),
        "mapping": "filament",
        "mips": 5,
        "dfg_multiscatter": True,
        "dfg_upward": True,
    },
}

PROGRAMS = tuple(_PROGRAMS)
"""Targets that take lighting maps; others filter a map themselves."""


def find_program(name: str | None) -> Program:
    """Return how a target takes lighting maps; the axes are those of its other maps.

    Raises
    ------
    InputError
        If it takes none.
    """
    if name is None:
        return ANY
    target = find_target(name)
    if name not in _PROGRAMS:
        raise InputError(
            f"target: must be one of {', '.join(PROGRAMS)}, got {name!r}, which filters maps itself"
        )
    shared: dict[str, Any] = {
        "space": target.cube_space,
        "face_names": target.face_names,
        "units": target.units,
        "sun_disc": target.sun_disc,
    }
    return Program(**{**shared, **_PROGRAMS[name]})
