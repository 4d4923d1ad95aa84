"""What a set of tables consists of."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from skybake.errors import InputError
from skybake.luts.parametrisations import PARAMETRISATIONS
from skybake.projection.camera import Camera
from skybake.projection.frame import PictureAxes, check_look, look_frame, roll_frame
from skybake.projection.perspective import WIDEST
from skybake.scattering.segments import MAX_DISTANCES

PIXELS = ("float", "half")
LARGEST = 4096
"""Width and height of a table at most. [texel]"""

FEWEST = 2
MOST_TEXELS = 1 << 24
"""Of a volume. [texel]"""

NEAREST_FAR, FARTHEST_FAR = 1e-3, 1e5
LEAST_ASPECT, LARGEST_ASPECT = 0.05, 20.0


@dataclass(frozen=True, kw_only=True)
class TableSettings:
    """What a set of tables consists of.

    Attributes
    ----------
    parametrisation : str
        One of `skybake.luts.parametrisations.PARAMETRISATIONS`.
    transmittance_size, multiple_scattering_size, sky_view_size : (int, int)
        Width and height; that of the sky's view is even. [texel]
    aerial_size : (int, int, int)
        Width, height and depth of the volume. [texel]
    fov, aspect : float
        Angle that the width of the volume's camera covers [rad], and width over height.
    azimuth, elevation, roll : float
        Compass bearing and height of where it looks, and how far it is turned, see `roll_frame`.
        [rad]
    shift : (float, float)
        Where on the plane at distance 1 the middle of its picture is: right of its axis, and above.
    far : float
        Distance of the volume's far end. [km]
    pixel : {"float", "half"}
        Type of stored values.
    """

    parametrisation: str = "hillaire2020"
    transmittance_size: tuple[int, int] = (256, 64)
    multiple_scattering_size: tuple[int, int] = (32, 32)
    sky_view_size: tuple[int, int] = (192, 108)
    aerial_size: tuple[int, int, int] = (32, 32, 32)
    fov: float = math.radians(60.0)
    aspect: float = 16.0 / 9.0
    azimuth: float = math.pi
    elevation: float = 0.0
    roll: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)
    far: float = 128.0
    pixel: str = "float"

    def __post_init__(self) -> None:
        """Refuse what cannot be made."""
        _check_known("parametrisation", self.parametrisation, PARAMETRISATIONS)
        _check_known("pixel", self.pixel, PIXELS)
        for name in ("transmittance", "multiple_scattering", "sky_view"):
            _check_size(f"{name.replace('_', ' ')} size", getattr(self, f"{name}_size"), 2)
        _check_size("aerial size", self.aerial_size, 3)
        if self.sky_view_size[1] % 2:
            raise InputError(
                "sky view size: height must be even, a half above the horizon and one below it, "
                f"got {self.sky_view_size[1]}"
            )
        if not 0.0 < self.fov <= WIDEST + 1e-9:
            raise InputError(
                f"fov: must be greater than 0deg and at most {math.degrees(WIDEST):g}deg, "
                f"got {math.degrees(self.fov):g}deg"
            )
        _check_range("aspect", self.aspect, LEAST_ASPECT, LARGEST_ASPECT, "")
        _check_range("far", self.far, NEAREST_FAR, FARTHEST_FAR, " km")
        check_look(self.azimuth, self.elevation)
        if not all(map(math.isfinite, (self.roll, *self.shift))):
            raise InputError(
                f"camera: roll and shift must be finite, got {self.roll:g}, {self.shift}"
            )

    def seen_by(self, camera: Camera) -> TableSettings:
        """Return the same with a given camera, whose position does not matter here.

        Raises
        ------
        InputError
            If its field of view or its proportions are out of range.
        """
        azimuth, elevation, roll = camera.angles
        return replace(
            self,
            fov=2.0 * math.atan(camera.half_width),
            aspect=camera.half_width / camera.half_height,
            azimuth=azimuth,
            elevation=elevation,
            roll=roll,
            shift=camera.shift,
        )

    @property
    def sizes(self) -> dict[str, tuple[int, ...]]:
        """Width, height and depth of each table, by its name."""
        return {
            "transmittance": self.transmittance_size,
            "multiple_scattering": self.multiple_scattering_size,
            "sky_view": self.sky_view_size,
            "aerial_perspective": self.aerial_size,
        }

    @property
    def frame(self) -> PictureAxes:
        """Where the camera's right, its up and its axis look."""
        return roll_frame(look_frame(self.azimuth, self.elevation), self.roll)

    @property
    def half_width(self) -> float:
        """Tangent of half the camera's horizontal angle."""
        return math.tan(0.5 * self.fov)

    @property
    def half_height(self) -> float:
        """Tangent of half the camera's vertical angle."""
        return self.half_width / self.aspect


def _check_known(name: str, value: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise InputError(f"{name}: must be one of {', '.join(known)}, got {value!r}")


def _check_size(name: str, size: tuple[int, ...], axes: int) -> None:
    given = "x".join(map(str, size))
    if len(size) != axes:
        wanted = "width, height and depth" if axes == 3 else "width and height"
        raise InputError(f"{name}: must be {wanted}, got {given}")
    most = (LARGEST, LARGEST, MAX_DISTANCES)[:axes]
    if not all(FEWEST <= one <= largest for one, largest in zip(size, most, strict=True)):
        limits = "x".join(map(str, most))
        raise InputError(f"{name}: must be from {FEWEST} to {limits} texels, got {given}")
    if math.prod(size) > MOST_TEXELS:
        raise InputError(f"{name}: must be at most {MOST_TEXELS} texels in all, got {given}")


def _check_range(name: str, value: float, least: float, most: float, unit: str) -> None:
    if not least <= value <= most:
        raise InputError(f"{name}: must be from {least:g} to {most:g}{unit}, got {value:g}{unit}")
