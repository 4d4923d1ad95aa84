"""The options of what a map records besides what an eye sees, or instead of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import choices, values
from skybake.commands.options.rules import Needs, options_together
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.image.sensor import Sensor

DEFAULT = "400:700:10"
_WHOLE = ("spectral", "stokes", "polarizer")
"""Options of maps that have no parts and no smaller copies."""

_STEP = 10.0
_MOST = 10_000


def wavelengths(text: str) -> tuple[float, ...]:
    """Read ``380:720:10nm``, ``380:720`` in steps of 10 nm, or ``450,550,650``. [nm]"""
    numbers = [_wavelength(part, text) for part in text.replace(":", ",").split(",")]
    if ":" not in text:
        return tuple(numbers)
    if "," in text or not 2 <= len(numbers) <= 3:
        raise click.BadParameter(
            f"must be FIRST:LAST:STEP such as {DEFAULT}nm, or a list such as 450,550,650, "
            f"got {text!r}"
        )
    first, last, step = *numbers[:2], numbers[2] if len(numbers) == 3 else _STEP
    if last < first or step <= 0.0 or (last - first) / step > _MOST:
        raise click.BadParameter(
            f"must ascend in at most {_MOST} steps greater than 0 nm, got {text!r}"
        )
    # The tolerance is for steps such as 0.1, which no sum of binary numbers meets.
    count = math.floor((last - first) / step + 1e-9) + 1
    return tuple(round(first + i * step, 4) for i in range(count))


def _wavelength(part: str, text: str) -> float:
    try:
        number = float(part.strip().removesuffix("nm"))
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise click.BadParameter(
            f"must be FIRST:LAST:STEP such as {DEFAULT}nm, or a list such as 450,550,650, "
            f"got {text!r}"
        )
    return number


sensor_options = options_together(
    click.option(
        "--spectral",
        is_flag=False,
        flag_value=DEFAULT,
        metavar="[WAVELENGTHS]",
        type=wavelengths,
        help="Also write the radiance at wavelengths, in nanometres: FIRST:LAST:STEP or a list, by "
        f"default {DEFAULT}; channels S0.550,0nm of an .exr, in W/(m2 sr nm).",
    ),
    click.option(
        "--camera",
        metavar="FILE.csv",
        type=click.Path(path_type=Path),
        callback=values.with_suffix(".csv"),
        help="Write what a camera sees instead of an eye: R, G and B by its response, columns "
        "wavelength_nm, R, G, B. Needs an .exr.",
    ),
    click.option(
        "--camera-white",
        type=click.Choice(choices.CAMERA_WHITES),
        show_default="d65",
        help="Scale the camera's channels such that daylight D65 is equal in all, or keep their "
        "ratios and scale by green.",
    ),
    click.option(
        "--stokes",
        is_flag=True,
        help="Also write the light's polarisation: Stokes components S0 to S3 of each channel, "
        "relative to the vertical, of an .exr.",
    ),
    click.option(
        "--polarizer",
        metavar="ANGLE",
        type=values.bearing,
        help="Put a linear polarising filter before the map: angle of its axis from the vertical, "
        "counter-clockwise as seen along the view. Needs an .exr.",
    ),
)


def sensor_needs(options: Mapping[str, Any]) -> Needs:
    """Return what `sensor_options`, and others with them, need to have an effect."""
    output, camera = options["output"], options["camera"]
    is_exr = output is None or output.suffix.lower() == ".exr"
    is_filtered = options["polarizer"] is not None
    passes_one = "cannot be combined with --polarizer, which passes one component"
    needs: dict[str, tuple[bool, str]] = {
        "stokes": (
            is_exr and not is_filtered,
            passes_one if is_filtered else "needs an .exr output",
        ),
        "polarizer": (is_exr, "needs an .exr output"),
        "show": (not is_filtered, passes_one),
        "spectral": (is_exr, "needs an .exr output"),
        "camera": (is_exr, "needs an .exr output"),
        "camera_white": (camera is not None, "needs --camera"),
        "colorspace": (
            camera is None,
            "cannot be combined with --camera, whose channels are in no space of an eye",
        ),
    }
    if camera is not None:
        lights = "cannot be combined with --camera, since lights have colours of an eye"
        needs["lights"] = (not options.get("lights"), lights)
    asked = [name for name in _WHOLE if options[name] is not None and options[name] is not False]
    if asked:
        whole = f"cannot be combined with --{asked[0]}"
        needs |= {name: (not options[name], whole) for name in ("mips", "layers")}
        needs["sun_disc"] = (options["sun_disc"] != "separate", whole)
    return needs


def sensor_from_options(options: Mapping[str, Any]) -> Sensor:
    """Return what a map records.

    Raises
    ------
    click.UsageError
        If wavelengths are too many or do not ascend.
    InputError
        If the camera's file cannot be used.
    """
    from skybake.image.sensor import Sensor

    response = None
    if options["camera"] is not None:
        from skybake.colour.camera import load_camera

        response = load_camera(options["camera"], options["camera_white"] or "d65")
    try:
        return Sensor(
            wavelengths=options["spectral"],
            response=response,
            stokes=options["stokes"],
            polarizer=options["polarizer"],
        )
    except InputError as error:
        raise click.UsageError(f"--{error}") from error
