"""From the options of ``skybake render`` to what is baked, and how they go together."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.image.settings import MapSettings

BESIDE = Path("beside-the-map.png")
"""Stands for the default name of a preview."""

PICTURES = ("preview", "contact_sheet", "animate")
"""Options that ask for pictures to look at."""


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
        **dict.fromkeys(
            ("fov", "look"),
            (
                options["projection"] in {"fisheye", "perspective"},
                "--projection perspective or fisheye",
            ),
        ),
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
    from skybake.image import settings

    names = ("units", "ev", "pixel", "compression")
    given = {name: options[name] for name in names if options[name] is not None}
    names = ("sun_elevation", "sun_azimuth", "altitude", "colorspace")
    given |= {name: options[name] for name in (*names, "sun_disc", "clamp_negative", "method")}
    attributes = {"cube_layout": "layout", "fov": "fov"}
    shape = {own: options[name] for name, own in attributes.items() if options[name] is not None}
    if options["look"] is not None:
        shape["azimuth"], shape["elevation"] = options["look"]
    try:
        return settings.map_settings(options["projection"], options["size"], **shape, **given)
    except InputError as error:
        raise click.UsageError(f"--{error}") from error


def preview_path(preview: Path | None, output: Path) -> Path | None:
    """Return where the preview of a map goes, if there shall be one."""
    if preview != BESIDE:
        return preview
    return output.with_name(output.name.replace("{face}", "preview")).with_suffix(".png")
