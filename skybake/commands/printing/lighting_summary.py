"""What ``skybake ibl`` prints of lighting maps that are baked."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from skybake.ibl.bake import BakedLighting
    from skybake.ibl.files import FileForm
    from skybake.ibl.settings import LightingMaps


def print_summary(baked: BakedLighting, maps: LightingMaps, seconds: float) -> None:
    """Print files and what they hold, human-readable."""
    for path in baked.files:
        click.echo(path)
    roughness = " ".join(f"{maps.roughness(mip):.3g}" for mip in range(maps.mips))
    white = baked.white_luminance
    held = [
        f"roughness of mips {roughness}" if "specular" in maps.parts else "",
        "of unknown scale" if white is None else f"1.0 = {white:.6g} cd/m2",
        f"{baked.clamped} negative values set to 0" if baked.clamped else "",
        f"{seconds:.2f} s",
    ]
    click.echo("; ".join(filter(None, held)))


def print_json(baked: BakedLighting, maps: LightingMaps, form: FileForm, seconds: float) -> None:
    """Print one JSON object."""
    summary = {
        "files": [str(path) for path in baked.files],
        "parts": list(maps.parts),
        "format": form.format,
        "cube_space": form.space,
        "specular_size": maps.specular_size,
        "roughness": [maps.roughness(mip) for mip in range(maps.mips)],
        "diffuse_size": maps.diffuse_size,
        "white_luminance_cd_m2": baked.white_luminance,
        "points_of_light": baked.points,
        "clamped_negative_values": baked.clamped,
        "warnings": list(baked.warnings),
        "seconds": round(seconds, 3),
    }
    click.echo(json.dumps(summary))
