"""From the options of ``skybake render`` to what is baked, and how they go together."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.baking import MapSettings

BESIDE = Path("beside-the-map.png")
"""Stands for the default name of a preview."""

PICTURES = ("preview", "contact_sheet", "animate")
"""Options that ask for pictures to look at."""

EQUIRECT_WIDTH = 2048
CUBEMAP_EDGE = 1024


def check_together(context: click.Context) -> None:
    """Refuse options that would have no effect beside the others.

    Raises
    ------
    click.UsageError
        That names both options.
    """
    options = context.params
    is_radiance = options["output"] is not None and options["output"].suffix.lower() == ".hdr"
    shown = [name for name in PICTURES if name in options]
    has_pictures = any(options[name] is not None for name in shown)
    pictures = " or ".join(f"--{name.replace('_', '-')}" for name in shown)
    needs = {
        "cube_layout": (options["projection"] == "cubemap", "--projection cubemap"),
        "pixel": (not is_radiance, "an .exr output"),
        "compression": (not is_radiance, "an .exr output"),
        "preview_ev": (has_pictures, pictures),
        "view": (has_pictures, pictures),
        "units": (options["ev"] is None, "no --ev beside it"),
    }
    if options.get("exposure_curve") is not None:
        needs |= dict.fromkeys(("units", "ev"), (False, "no --exposure-curve beside it"))
    for parameter in context.command.params:
        met, need = needs.get(parameter.name or "", (True, ""))
        if not met and options[parameter.name or ""] is not None:
            raise click.UsageError(f"{parameter.opts[0]}: needs {need}")
    if is_radiance and options["cube_layout"] == "exr":
        raise click.UsageError("--cube-layout exr: needs an .exr output")


def map_settings(options: dict[str, Any]) -> MapSettings:
    """Return the settings of a map.

    Raises
    ------
    click.UsageError
        If a value is out of range.
    """
    width = _width(options["projection"], options["size"])

    from skybake.baking import MapSettings

    names = ("cube_layout", "units", "ev", "pixel", "compression")
    given = {name: options[name] for name in names if options[name] is not None}
    names = ("sun_elevation", "sun_azimuth", "altitude", "projection", "colorspace")
    given |= {name: options[name] for name in (*names, "sun_disc", "clamp_negative", "method")}
    try:
        return MapSettings(width=width, **given)
    except InputError as error:
        raise click.UsageError(f"--{error}") from error


def preview_path(preview: Path | None, output: Path) -> Path | None:
    """Return where the preview of a map goes, if there shall be one."""
    if preview != BESIDE:
        return preview
    return output.with_name(output.name.replace("{face}", "preview")).with_suffix(".png")


def _width(projection: str, size: tuple[int, ...] | None) -> int:
    if size is None:
        return EQUIRECT_WIDTH if projection == "equirect" else CUBEMAP_EDGE
    text = "x".join(map(str, size))
    if 0 in size:
        raise click.UsageError(f"--size: must be at least 1, got {text}")
    if projection == "cubemap":
        if len(size) != 1:
            raise click.UsageError(f"--size: a cubemap needs the edge of a face, got {text}")
    elif len(size) != 2:
        raise click.UsageError(f"--size: an equirect map needs width and height, got {text}")
    elif size[0] != 2 * size[1]:
        raise click.UsageError(f"--size: width must be twice the height, got {text}")
    return size[0]
