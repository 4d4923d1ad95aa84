"""What one program needs of a map, and why."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from skybake.errors import InputError

SUBJECTS = ("maps", "turn", "cube", "rows", "scale", "pixel", "sun")
"""What every target gives a reason for."""


class TargetReason(NamedTuple):
    """Why something of a target is as it is.

    Attributes
    ----------
    text : str
        A sentence.
    source : str
        Where that is from: an address, or what was run.
    """

    text: str
    source: str


class TargetAxes(NamedTuple):
    """Where a program's own axes point, once the map is in it.

    Attributes
    ----------
    east, north, up : str
        A sign and a letter, as ``+X``.
    """

    east: str
    north: str
    up: str

    def direction(self, vector: tuple[float, float, float]) -> tuple[float, float, float]:
        """Turn a direction in the world's axes, +Y up, -Z north, +X east, into those of here."""
        east, up, south = vector
        placed = {
            axis[1]: component if axis[0] == "+" else -component
            for axis, component in zip(self, (east, -south, up), strict=True)
        }
        return placed["X"], placed["Y"], placed["Z"]


@dataclass(frozen=True, kw_only=True)
class Target:
    """What one program needs of a map to open it the right way round and at the right level.

    Attributes
    ----------
    name : str
        By which users select it.
    title : str
        The program, and what takes the map in it.
    maps : mapping of str to tuple of str
        Projections that it takes, the usual one first, and the suffixes of their files, likewise.
    axes : TargetAxes
        Where east, north and up are in it then.
    verified : str
        With what this was verified, and how; or that it is by documentation only.
    rotation : float
        Compass bearing of the -Z of an equirect map, such that the program's own north is north;
        cubemaps are not turned. [rad]
    cube_layout, cube_space, face_names, equirect_rows : str
        As `skybake.projection.cubemap.Cubemap` and `skybake.projection.equirect.Equirect` have it.
    units, pixel, sun_disc : str
        As `skybake.image.settings.Encoding` and `Lighting` have it.
    omit_exposure : bool
        Leave EXPOSURE out of Radiance pictures.
    reasons : mapping of str to TargetReason
        By what they are for, all of `SUBJECTS`.
    """

    name: str
    title: str
    maps: Mapping[str, tuple[str, ...]]
    axes: TargetAxes
    verified: str
    rotation: float = 0.0
    cube_layout: str = "faces"
    cube_space: str = "world"
    face_names: str = "px"
    equirect_rows: str = "centres"
    units: str = "ev15"
    pixel: str = "auto"
    sun_disc: str = "include"
    omit_exposure: bool = True
    reasons: Mapping[str, TargetReason] = field(default_factory=dict)

    @property
    def projection(self) -> str:
        """The projection that it takes by default."""
        return next(iter(self.maps))

    def suffix(self, projection: str) -> str:
        """Return the usual suffix of its maps of a projection, which `check` takes."""
        self.check(projection, {})
        return self.maps[projection][0]

    def with_defaults(self, projection: str, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return settings of a map by name, as `skybake.image.settings.map_settings` takes them.

        Parameters
        ----------
        projection : str
            Of the map.
        given : mapping
            Settings that a user has given, which come first; a rotation adds to the target's.

        Raises
        ------
        InputError
            If the program does not take the projection, or what was given decides where it finds
            directions and is not as it needs them.
        """
        self.check(projection, given)
        shape: dict[str, Any] = {}
        if projection == "equirect":
            shape = {"rows": self.equirect_rows}
        elif projection == "cubemap":
            shape = {"layout": self.cube_layout, "space": self.cube_space}
            if given.get("layout", self.cube_layout) == "faces":
                shape["face_names"] = self.face_names
        scale = {} if given.get("ev") is not None else {"units": self.units}
        return {
            **shape,
            **scale,
            "pixel": self.pixel,
            "sun_disc": self.sun_disc,
            "omit_exposure": self.omit_exposure,
            **given,
            "rotation": given.get("rotation", 0.0) + self.turn(projection),
        }

    def turn(self, projection: str) -> float:
        """Return how far maps of a projection are turned for it, see `rotation`. [rad]"""
        return self.rotation if projection == "equirect" else 0.0

    def check(self, projection: str, given: Mapping[str, Any]) -> None:
        """Raise an `InputError` if a map is not as the program finds directions in it."""
        if projection not in self.maps:
            raise InputError(
                f"projection: must be {' or '.join(self.maps)} for the target {self.name}, "
                f"got {projection!r}"
            )
        for option, name, needed in (
            ("equirect-rows", "rows", self.equirect_rows),
            ("cube-space", "space", self.cube_space),
        ):
            if given.get(name, needed) != needed:
                raise InputError(
                    f"{option}: must be {needed} for the target {self.name}, got {given[name]!r}"
                )

    def check_suffix(self, projection: str, suffix: str) -> None:
        """Raise an `InputError` if the program does not take a map in files of a suffix."""
        self.check(projection, {})
        suffixes = self.maps[projection]
        if suffix.lower() not in suffixes:
            raise InputError(
                f"target {self.name}: needs an output {' or '.join(suffixes)}, got {suffix!r} "
                f"({self.reasons['maps'].text})"
            )

    def summary(self) -> dict[str, Any]:
        """Return all of it in human-readable units, fit for JSON."""
        return {
            "name": self.name,
            "title": self.title,
            "verified": self.verified,
            "maps": {name: list(suffixes) for name, suffixes in self.maps.items()},
            "axes": self.axes._asdict(),
            "rotate_deg": round(math.degrees(self.rotation), 9),
            "cube_layout": self.cube_layout,
            "cube_space": self.cube_space,
            "face_names": self.face_names,
            "equirect_rows": self.equirect_rows,
            "units": self.units,
            "pixel": self.pixel,
            "sun_disc": self.sun_disc,
            "omit_exposure": self.omit_exposure,
            "reasons": {subject: self.reasons[subject]._asdict() for subject in SUBJECTS},
        }
