"""What to bake: one observer, one sun, one map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from skybake.colour.exposure import luminance_from_ev, luminance_from_units
from skybake.colour.space import ColourSpace, find_colour_space
from skybake.errors import InputError
from skybake.formats.compression import parse_compression
from skybake.sky.sky import METHODS

PROJECTIONS = ("equirect", "cubemap")
CUBE_LAYOUTS = ("faces", "cross", "exr")
SUN_DISCS = ("include", "exclude", "only")
PIXELS = ("auto", "half", "float")
LARGEST = 65536


@dataclass(frozen=True)
class MapSettings:
    """Everything that decides a map's pixels but the planet.

    Attributes
    ----------
    sun_elevation : float
        Geometric elevation of the sun's centre at the observer. [rad]
    sun_azimuth : float
        Compass bearing of the sun: 0 = north, clockwise. [rad]
    altitude : float
        Of the observer above the ground. [km]
    projection : {"equirect", "cubemap"}
        Kind of map.
    width : int
        Width of an equirect map, twice its height, or edge of a cube's face. [pixel]
    cube_layout : {"faces", "cross", "exr"}
        Six files, one horizontal cross, or one OpenEXR cube environment.
    colorspace : str
        A name of `skybake.colour.space.COLOUR_SPACES`.
    units : {"ev15", "nits"}
        What 1.0 stands for: 1.2 * 2**15 cd/m2, or 1 cd/m2.
    ev : float or None
        If given, 1.0 stands for 1.2 * 2**ev cd/m2 instead.
    pixel : {"auto", "half", "float"}
        Type of stored values; auto takes half where no value is lost in it.
    compression : str
        EXR compression, see `skybake.formats.compression`.
    sun_disc : {"include", "exclude", "only"}
        Whether the map holds the sun's disc, or nothing else.
    clamp_negative : bool
        Set negative values of colours outside the space to 0.
    method : {"hillaire", "march"}
        How light is transported, see `skybake.sky.sky.Sky`.
    """

    sun_elevation: float = math.radians(30.0)
    sun_azimuth: float = math.pi
    altitude: float = 0.0
    projection: str = "equirect"
    width: int = 2048
    cube_layout: str = "faces"
    colorspace: str = "lin_rec709"
    units: str = "ev15"
    ev: float | None = None
    pixel: str = "auto"
    compression: str = "zip"
    sun_disc: str = "include"
    clamp_negative: bool = False
    method: str = "full"

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        for name, value, known in (
            ("projection", self.projection, PROJECTIONS),
            ("cube layout", self.cube_layout, CUBE_LAYOUTS),
            ("pixel", self.pixel, PIXELS),
            ("sun disc", self.sun_disc, SUN_DISCS),
            ("method", self.method, METHODS),
        ):
            if value not in known:
                raise InputError(f"{name}: must be one of {', '.join(known)}, got {value!r}")
        smallest = 4 if self.projection == "equirect" else 1
        if not smallest <= self.width <= LARGEST:
            raise InputError(f"size: must be from {smallest} to {LARGEST}, got {self.width}")
        if self.projection == "equirect" and self.width % 2:
            raise InputError(f"size: width must be twice the height, got an odd width {self.width}")
        _ = self.space, self.white_luminance, parse_compression(self.compression)

    @property
    def space(self) -> ColourSpace:
        """The colour space of the pixels."""
        return find_colour_space(self.colorspace)

    @property
    def white_luminance(self) -> float:
        """Luminance that RGB (1, 1, 1) stands for. [cd m⁻²]"""
        if self.ev is not None:
            return luminance_from_ev(self.ev)
        return luminance_from_units(self.units)

    def recipe(self) -> dict[str, Any]:
        """All that decides the pixels, in units for people, fit for JSON."""
        return {
            "sun_elevation_deg": math.degrees(self.sun_elevation),
            "sun_azimuth_deg": math.degrees(self.sun_azimuth),
            "altitude_m": self.altitude * 1e3,
            "projection": self.projection,
            "width": self.width,
            "cube_layout": self.cube_layout if self.projection == "cubemap" else None,
            "colorspace": self.colorspace,
            "white_luminance_cd_m2": self.white_luminance,
            "pixel": self.pixel,
            "compression": self.compression,
            "sun_disc": self.sun_disc,
            "clamp_negative": self.clamp_negative,
            "method": self.method,
        }
