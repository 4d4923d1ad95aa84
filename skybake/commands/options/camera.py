"""The options of cameras: where they look, and what they see of it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from skybake.commands.options import choices, values
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.projection.camera import Camera

AimValue = tuple[str | None, float | None, float]

FREE = ("horizon", "limb")
"""What has a bearing of its own."""


def aim(text: str) -> AimValue:
    """Read what a camera looks at: a name, its bearing, or a direction. [rad]"""
    name, comma, rest = text.partition(",")
    name = name.strip()
    if name in choices.AIMS:
        if comma and name not in FREE:
            raise click.BadParameter(f"{name} takes no azimuth, got {text!r}")
        return name, values.bearing(rest) if comma else None, 0.0
    if not comma:
        known = ", ".join(choices.AIMS)
        raise click.BadParameter(
            f"must be {known} or AZIMUTH,ELEVATION such as 180,10, got {text!r}"
        )
    return None, values.bearing(name), values.elevation(rest)


aim_option = click.option(
    "--look",
    metavar="AT",
    type=aim,
    show_default="horizon",
    help="What is in the middle: sun; moon; horizon or limb, with a comma and a bearing, or else "
    "toward the sun; planet, all of it from afar; or AZIMUTH,ELEVATION.",
)

camera_option = click.option(
    "--camera",
    metavar="FILE",
    type=click.Path(path_type=Path),
    callback=values.with_suffix(".json", ".exr"),
    help="Camera of a .json, or of the attributes worldToCamera and worldToNDC of an .exr.",
)

camera_units_option = click.option(
    "--camera-units",
    type=click.Choice(choices.CAMERA_UNITS),
    show_default="those of the .json, or else m",
    help="Length of 1 in the camera's world.",
)

camera_up_option = click.option(
    "--camera-up",
    type=click.Choice(choices.CAMERA_UPS),
    show_default="that of the .json, or else y",
    help="Axis of the camera's world that is up; if z, +Y is north.",
)


def camera_from_file(
    path: Path, units: str | None, up: str | None, fov: float | None, aspect: float
) -> Camera:
    """Read the camera of a file.

    Parameters
    ----------
    path : Path
        ``.json`` or ``.exr``.
    units, up : str or None
        As of the options.
    fov : float or None
        Angle that the width covers, where it is given. [rad]
    aspect : float
        Width over height, for files that do not tell it.

    Raises
    ------
    click.UsageError
        If no plane shows so wide a field.
    InputError
        If the file tells no camera.
    """
    if fov is not None and fov >= math.pi:
        raise click.UsageError(
            f"--fov: must be less than 180deg for a camera, got {math.degrees(fov):g}deg"
        )

    from skybake.projection.camera import METRE, camera_from_attributes
    from skybake.projection.camera_file import UNITS, load_camera

    unit = None if units is None else UNITS[units]
    if path.suffix.lower() == ".json":
        return load_camera(path, fov=fov, aspect=aspect, unit=unit, up=up)
    from skybake.formats.reader import read_attributes

    return camera_from_attributes(
        read_attributes(path),
        str(path),
        fov=fov,
        aspect=aspect,
        unit=METRE if unit is None else unit,
        up=up or "y",
    )


def altitude_with(camera: Camera, altitude: float) -> float:
    """Return the altitude of a camera over the ground that its world stands on. [km]

    Raises
    ------
    InputError
        If it is below the ground.
    """
    total = altitude + camera.position[1]
    if total < 0.0:
        raise InputError(
            f"altitude: must be at least 0 m, got {total * 1e3:g} m with that of the camera"
        )
    return total
