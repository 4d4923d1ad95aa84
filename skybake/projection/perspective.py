"""Pictures of a camera without distortion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from skybake.errors import InputError
from skybake.projection.camera import Camera
from skybake.projection.cells import Array
from skybake.projection.chart import Canvas, Projection, check_edge, size_text, whole
from skybake.projection.frame import check_look, look_frame, look_label, roll_frame
from skybake.projection.gnomonic import GnomonicChart
from skybake.units import degrees

WIDEST = math.radians(170.0)
LARGEST_PREVIEW = 1920
UPRIGHT = 1e-6
"""Roll below which it is rounding. [rad]"""

FARTHEST_SHIFT = 10.0
"""[width of the picture]"""


@dataclass(frozen=True)
class Perspective(Projection):
    """A flat picture.

    Attributes
    ----------
    width, height : int
        [pixel]
    fov : float
        Angle that the width covers, greater than 0 and at most `WIDEST`. [rad]
    azimuth, elevation : float
        Compass bearing and height of the camera's axis, which is the middle of the picture if the
        lens is not shifted. [rad]
    roll : float
        How far the camera is turned from upright, see `roll_frame`. [rad]
    shift : tuple of float
        How far the lens moves the picture's middle from the axis, to the right and upward, in
        widths of the picture.
    """

    name: ClassVar[str] = "perspective"
    width: int = 1920
    height: int = 1080
    fov: float = math.radians(50.0)
    azimuth: float = math.pi
    elevation: float = 0.0
    roll: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        check_edge(self.width)
        check_edge(self.height)
        if not 0.0 < self.fov <= WIDEST + 1e-9:
            raise InputError(
                f"fov: must be greater than 0deg and at most {math.degrees(WIDEST):g}deg for a "
                f"perspective picture, got {math.degrees(self.fov):g}deg"
            )
        check_look(self.azimuth, self.elevation)
        if not math.isfinite(self.roll):
            raise InputError(f"roll: must be finite, got {self.roll}")
        if not all(abs(shift) <= FARTHEST_SHIFT for shift in self.shift):
            raise InputError(
                f"lens shift: must be at most {FARTHEST_SHIFT:g} widths of the picture, "
                f"got {self.shift[0]:g} and {self.shift[1]:g}"
            )

    @classmethod
    def of_size(cls, size: tuple[int, ...] | None, options: Mapping[str, Any]) -> Self:
        """Make one of a width and a height."""
        if size is None:
            return cls(**options)
        if len(size) != 2:
            raise InputError(
                f"size: a perspective picture needs width and height, got {size_text(size)}"
            )
        return cls(width=size[0], height=size[1], **options)

    def canvases(self) -> tuple[Canvas, ...]:
        """Return the one picture."""
        return (whole(self._chart()),)

    @property
    def label(self) -> str:
        """How file names denote it."""
        look = look_label(self.azimuth, self.elevation)
        roll = "" if self.roll == 0.0 else f"_roll{math.degrees(self.roll):g}deg"
        shift = "" if self.shift == (0.0, 0.0) else f"_shift{self.shift[0]:g}_{self.shift[1]:g}"
        return f"{self.name}_{look}_fov{math.degrees(self.fov):g}deg{roll}{shift}"

    def recipe(self) -> dict[str, Any]:
        """Size, angle of view and direction."""
        return {
            "projection": self.name,
            "width": self.width,
            "height": self.height,
            "fov_deg": degrees(self.fov),
            "look_azimuth_deg": degrees(self.azimuth),
            "look_elevation_deg": degrees(self.elevation),
            **({} if self.roll == 0.0 else {"roll_deg": degrees(self.roll)}),
            **({} if self.shift == (0.0, 0.0) else {"lens_shift": list(self.shift)}),
        }

    def smaller(self, width: int) -> Projection:
        """Return the same picture, in its own size up to full HD."""
        largest = max(width, LARGEST_PREVIEW)
        return self if self.width <= largest else self.glance(largest)

    def glance(self, width: int) -> Projection:
        """Return the same picture of another width."""
        height = max(1, round(self.height * width / self.width))
        return replace(self, width=width, height=height)

    @classmethod
    def of_camera(cls, camera: Camera, width: int) -> Self:
        """Return what a camera sees from the middle of the world, with square pixels.

        Parameters
        ----------
        camera : Camera
            Whose proportions the picture has.
        width : int
            [pixel]
        """
        azimuth, elevation, roll = camera.angles
        right, up = (part / (2.0 * camera.half_width) for part in camera.shift)
        return cls(
            width=width,
            height=max(1, round(width * camera.half_height / camera.half_width)),
            fov=2.0 * math.atan(camera.half_width),
            azimuth=azimuth,
            elevation=elevation,
            roll=0.0 if abs(roll) < UPRIGHT else roll,
            shift=(right, up),
        )

    def finer(self, times: int) -> Perspective:
        """Return the same picture of that many times the width and the height."""
        return replace(self, width=self.width * times, height=self.height * times)

    def on_map(self, rotation: float) -> Perspective:
        """Return the same view in the axes of a map whose -Z looks to a bearing. [rad]"""
        return replace(self, azimuth=self.azimuth - rotation)

    def vectors(self) -> Array:
        """Return unit vectors of all pixels, shape (row, column, 3); +Y up, -Z north, +X east."""
        return self._chart().vectors(0, self.height)

    def _chart(self) -> GnomonicChart:
        frame = roll_frame(look_frame(self.azimuth, self.elevation), self.roll)
        half_width = math.tan(0.5 * self.fov)
        half_height = half_width * self.height / self.width
        right, up = (2.0 * half_width * part for part in self.shift)
        return GnomonicChart(
            frame, half_width, half_height, self.width, self.height, shift=(right, up)
        )
