"""Pictures of a camera without distortion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from skybake.errors import InputError
from skybake.projection.cells import Array
from skybake.projection.chart import Canvas, Projection, check_edge, size_text, whole
from skybake.projection.frame import check_look, look_frame, look_label
from skybake.projection.gnomonic import GnomonicChart
from skybake.units import degrees

WIDEST = math.radians(170.0)
LARGEST_PREVIEW = 1920


@dataclass(frozen=True)
class Perspective(Projection):
    """A flat picture, held upright.

    Attributes
    ----------
    width, height : int
        [pixel]
    fov : float
        Angle that the width covers, greater than 0 and at most `WIDEST`. [rad]
    azimuth, elevation : float
        Compass bearing and height of the middle. [rad]
    """

    name: ClassVar[str] = "perspective"
    width: int = 1920
    height: int = 1080
    fov: float = math.radians(50.0)
    azimuth: float = math.pi
    elevation: float = 0.0

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
        return f"{self.name}_{look}_fov{math.degrees(self.fov):g}deg"

    def recipe(self) -> dict[str, Any]:
        """Size, angle of view and direction."""
        return {
            "projection": self.name,
            "width": self.width,
            "height": self.height,
            "fov_deg": degrees(self.fov),
            "look_azimuth_deg": degrees(self.azimuth),
            "look_elevation_deg": degrees(self.elevation),
        }

    def smaller(self, width: int) -> Projection:
        """Return the same picture, in its own size up to full HD."""
        largest = max(width, LARGEST_PREVIEW)
        return self if self.width <= largest else self.glance(largest)

    def glance(self, width: int) -> Projection:
        """Return the same picture of another width."""
        height = max(1, round(self.height * width / self.width))
        return Perspective(width, height, self.fov, self.azimuth, self.elevation)

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
        frame = look_frame(self.azimuth, self.elevation)
        half_width = math.tan(0.5 * self.fov)
        half_height = half_width * self.height / self.width
        return GnomonicChart(frame, half_width, half_height, self.width, self.height)
