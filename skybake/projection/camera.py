"""Cameras: where they are, where they look, and what part of the plane before them they show."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from skybake.angles import zenith_azimuth
from skybake.errors import InputError
from skybake.projection.cells import Array
from skybake.projection.frame import PictureAxes, look_frame, roll_frame

WORLD_TO_CAMERA, WORLD_TO_NDC = "worldToCamera", "worldToNDC"
"""Names of OpenEXR's standard attributes."""

METRE = 1e-3
"""[km]"""

Place = tuple[float, float, float]

# Matrices of single precision, multiplied by others, lose some digits.
_TOLERANCE = 1e-3

_Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From a world with +Z up and +Y north to one with +Y up and -Z north, of row vectors."""


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera in a right-handed world, +Y up, -Z north, +X east.

    Attributes
    ----------
    frame : ndarray of float64, shape (3, 3)
        Unit vectors of its right, its up and where it looks, one in each row.
    half_width, half_height : float
        Of the picture on the plane at distance 1: tangents of half the angles that it covers, if
        its lens is not shifted. Greater than 0.
    shift : tuple of float
        Where on this plane the middle of the picture is: right of the axis, and above it.
    position : tuple of float
        Of the camera. [km]

    Raises
    ------
    InputError
        If a value is not finite, an extent not greater than 0, or the axes are not at right angles.
    """

    frame: Array
    half_width: float
    half_height: float
    shift: tuple[float, float] = (0.0, 0.0)
    position: Place = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        """Refuse what no camera has."""
        values = [*np.ravel(self.frame), *self.shift, *self.position]
        if not np.isfinite(values).all():
            raise InputError("camera: must have finite numbers only")
        for name in ("half_width", "half_height"):
            extent = getattr(self, name)
            if not 0.0 < extent < math.inf:
                raise InputError(f"camera: {name} must be greater than 0 and finite, got {extent}")
        if not np.allclose(self.frame @ self.frame.T, np.eye(3), atol=_TOLERANCE):
            raise InputError("camera: axes must be at right angles and of length 1")

    @property
    def axes(self) -> PictureAxes:
        """Where its right, its up and its middle look, if its lens is not shifted."""
        return PictureAxes(*self.frame)

    @property
    def angles(self) -> tuple[float, float, float]:
        """Compass bearing and elevation of its axis, and its roll, see `roll_frame`. [rad]"""
        right, up, forward = self.frame
        zenith, azimuth = (float(angle) for angle in zenith_azimuth(forward))
        upright = look_frame(azimuth, math.pi / 2.0 - zenith)
        roll = math.atan2(-float(right @ upright.up), float(up @ upright.up))
        return azimuth, math.pi / 2.0 - zenith, roll


def camera_from_angles(
    azimuth: float, elevation: float, roll: float, fov: float, aspect: float
) -> Camera:
    """Return a camera without a shifted lens, in the middle of the world.

    Parameters
    ----------
    azimuth, elevation, roll : float
        As of `look_frame` and `roll_frame`. [rad]
    fov : float
        Angle that its width covers, in (0, pi). [rad]
    aspect : float
        Width over height.
    """
    frame = roll_frame(look_frame(azimuth, elevation), roll)
    half_width = math.tan(0.5 * fov)
    return Camera(np.stack(frame), half_width, half_width / aspect)


def camera_from_attributes(
    attributes: Mapping[str, Any],
    where: str,
    *,
    fov: float | None = None,
    aspect: float = 1.0,
    unit: float = METRE,
    up: str = "y",
) -> Camera:
    """Return the camera that the attributes of an OpenEXR file tell.

    Parameters
    ----------
    attributes : mapping
        With OpenEXR's `worldToNDC`, or `worldToCamera` and a given `fov`, or both: 16 numbers,
        row after row, that row vectors are multiplied by. Where both are given they must agree.
    where : str
        What holds them, for messages.
    fov : float, optional
        Angle that the width of the picture covers, which `worldToNDC` tells itself. [rad]
    aspect : float, optional
        Width over height of the picture, for `fov`.
    unit : float, optional
        Length of 1 in the world. [km]
    up : {"y", "z"}, optional
        Axis that is up; +Y is north then if it is z.

    Raises
    ------
    InputError
        If there are no such matrices, one is singular or of no such camera, or they disagree.

    Notes
    -----
    The camera looks along +Z if `worldToCamera` turns a right-handed world into a left-handed one,
    as OpenEXR and RenderMan have it, and along -Z if it does not, as of OpenGL and Arnold. In
    `worldToNDC` the picture is from 0 to 1 with y downward, as OpenEXR has it, or from -1 to 1
    with y upward, as some renderers do: in which way y runs tells them apart.
    """
    placed, projected = attributes.get(WORLD_TO_CAMERA), attributes.get(WORLD_TO_NDC)
    if projected is not None:
        told = _from_world_to_ndc(matrix(projected, f"{where}: {WORLD_TO_NDC}"), where)
        if placed is not None:
            frame, _ = _from_world_to_camera(matrix(placed, f"{where}: {WORLD_TO_CAMERA}"), where)
            if not np.allclose(frame, told.frame, atol=10.0 * _TOLERANCE):
                raise InputError(f"{where}: {WORLD_TO_CAMERA} and {WORLD_TO_NDC} must agree")
    elif placed is not None:
        frame, position = _from_world_to_camera(
            matrix(placed, f"{where}: {WORLD_TO_CAMERA}"), where
        )
        if fov is None:
            raise InputError(
                f"{where}: {WORLD_TO_CAMERA} does not tell how wide the picture is; {WORLD_TO_NDC} "
                "or a field of view must be given besides"
            )
        half_width = math.tan(0.5 * fov)
        told = Camera(frame, half_width, half_width / aspect, position=position)
    else:
        raise InputError(
            f"{where}: camera must be given, got neither {WORLD_TO_CAMERA} nor {WORLD_TO_NDC}"
        )
    turn = _Z_UP if up == "z" else np.eye(3)
    return replace(
        told, frame=told.frame @ turn, position=_place(np.array(told.position) @ turn * unit)
    )


def matrix(value: Any, where: str) -> Array:
    """Read a matrix of 16 numbers, or of four rows of four, shape (4, 4).

    Raises
    ------
    InputError
        If it is no such matrix, of column vectors, or has numbers that are not finite.
    """
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(f"{where}: must be 16 numbers") from error
    if numbers.shape not in {(16,), (4, 4)}:
        raise InputError(f"{where}: must be 16 numbers, got an array of shape {numbers.shape}")
    if not np.isfinite(numbers).all():
        raise InputError(f"{where}: must be finite, got {numbers[~np.isfinite(numbers)][0]}")
    return numbers.reshape(4, 4)


def _from_world_to_camera(world: Array, where: str) -> tuple[Array, Place]:
    """Axes and position of a camera by its rotation, scale and translation."""
    where = f"{where}: {WORLD_TO_CAMERA}"
    if not np.allclose(world[:, 3], [0.0, 0.0, 0.0, 1.0], atol=1e-6):
        raise InputError(
            f"{where}: last column must be 0 0 0 1, got {_text(world[:, 3])}; a matrix of column "
            "vectors must be transposed"
        )
    turn, offset = world[:3, :3], world[3, :3]
    length = np.linalg.norm(turn, axis=0)
    size = float(length.mean())
    _check_rank(turn, where)
    axes = turn.T / size
    if not np.allclose(axes @ axes.T, np.eye(3), atol=_TOLERANCE):
        raise InputError(f"{where}: must be a rotation and a translation, without shear")
    is_left_handed = np.linalg.det(axes) < 0.0
    right, up, third = axes
    frame = np.stack([right, up, third if is_left_handed else -third])
    return frame, _place(-offset @ np.linalg.inv(turn))


def _from_world_to_ndc(world: Array, where: str) -> Camera:
    """Camera that has a projection."""
    where = f"{where}: {WORLD_TO_NDC}"
    # What becomes of places on the plane at distance 1 does not depend on the third coordinate.
    across, down, before = (world[:3, column] for column in (0, 1, 3))
    length = float(np.linalg.norm(before))
    if not length > 1e-12 * float(np.abs(world).max()):
        raise InputError(f"{where}: must be of a perspective camera, got one without perspective")
    used = np.stack([across, down, before], axis=1) / length
    _check_rank(used, where)
    forward = before / length
    right_shift, up_shift = float(used[:, 0] @ forward), float(used[:, 1] @ forward)
    right, upward = used[:, 0] - right_shift * forward, used[:, 1] - up_shift * forward
    scale_x = float(np.linalg.norm(right))
    right = right / scale_x
    up = np.cross(right, forward)
    scale_y = float(upward @ up)
    if not np.allclose(upward, scale_y * up, atol=_TOLERANCE * float(np.linalg.norm(upward))):
        raise InputError(f"{where}: axes of the picture must be at right angles")
    position = -(world[3, [0, 1, 3]] / length) @ np.linalg.inv(used)
    # The standard's picture is from 0 to 1, that of renderers with y upward from -1 to 1.
    half, middle = (1.0, 0.0) if scale_y > 0.0 else (0.5, 0.5)
    return Camera(
        np.stack([right, up, forward]),
        half / scale_x,
        half / abs(scale_y),
        shift=((middle - right_shift) / scale_x, (middle - up_shift) / scale_y),
        position=_place(position),
    )


def _place(position: Array) -> Place:
    x, y, z = position.tolist()
    return x, y, z


def _check_rank(turn: Array, where: str) -> None:
    sizes = np.linalg.svd(turn, compute_uv=False)
    if not sizes[-1] > 1e-9 * max(float(sizes[0]), 1e-300):
        raise InputError(f"{where}: must not be singular, got rows {_text(turn)}")


def _text(numbers: Array) -> str:
    return " ".join(f"{number:g}" for number in numbers.ravel())
