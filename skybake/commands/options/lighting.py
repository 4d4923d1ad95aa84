"""The options of lighting maps: which ones, how they are stored, and for which program."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import choices
from skybake.commands.options.maps import map_options
from skybake.commands.options.rules import Needs, options_together, some_of

if TYPE_CHECKING:
    from skybake.ibl.program import Program

_SHARED = ("rotate", "colorspace", "units", "ev", "sun_size", "sun_soft", "sun_strength", "method")
"""Options of `map_options` that lighting maps have as well."""


def _parts(text: str) -> tuple[str, ...]:
    parts = tuple(dict.fromkeys(part.strip() for part in text.split(",")))
    if not set(parts) <= set(choices.LIGHTING_PARTS):
        raise click.BadParameter(
            f"must be some of {','.join(choices.LIGHTING_PARTS)} with commas between, got {text!r}"
        )
    return parts


lighting_options = options_together(
    click.option(
        "--target",
        metavar="NAME",
        type=click.Choice(choices.LIGHTING_TARGETS),
        help="Program that the maps are for: sets format, pixel type, axes, scale, roughness of "
        "mips, and whether the sun is in the maps, where other options do not.",
    ),
    click.option(
        "--parts",
        metavar="A,B,..",
        type=_parts,
        show_default="specular,diffuse,sh,dfg",
        help="What to make: the cube of rough mirrors, that of white diffuse surfaces, spherical "
        "harmonics, the split sum's table.",
    ),
    click.option(
        "--specular-size",
        metavar="EDGE",
        type=int,
        show_default="256",
        help="Edge of the specular cube, a power of two.",
    ),
    click.option(
        "--mips",
        metavar="N",
        type=int,
        show_default="7",
        help="Levels of the specular cube, from a mirror in the first to roughness 1 in the last.",
    ),
    click.option(
        "--mip-roughness",
        type=click.Choice(choices.MIP_ROUGHNESS),
        show_default="linear",
        help="Perceptual roughness r of the levels: r = level / (N - 1), or, as in Filament, "
        "r (2 - r) = level / (N - 1). GGX's alpha is its square.",
    ),
    click.option(
        "--samples",
        metavar="N",
        type=int,
        show_default="1024",
        help="Directions in which a texel of a rough level looks; the sun is not sampled.",
    ),
    click.option(
        "--diffuse-size",
        metavar="EDGE",
        type=int,
        show_default="64",
        help="Edge of the diffuse cube, a power of two.",
    ),
    click.option(
        "--dfg-size",
        metavar="EDGE",
        type=int,
        show_default="128",
        help="Width and height of the split sum's table.",
    ),
    click.option(
        "--dfg-multiscatter",
        is_flag=True,
        help="Store bias and scale + bias, for materials that make up for multiple scattering.",
    ),
    click.option(
        "--sun-disc",
        type=click.Choice(choices.LIGHTING_SUN_DISCS),
        show_default="include",
        help="Whether the sun is in the maps, or left to a light of the program.",
    ),
    *some_of(map_options, *_SHARED),
    click.option(
        "--format",
        "file_format",
        type=click.Choice(choices.LIGHTING_FORMATS),
        show_default="ktx2",
        help="Of the cubes; exr are six files a level.",
    ),
    click.option(
        "--pixel",
        type=click.Choice(choices.PIXELS),
        show_default="auto",
        help="Stored type of the cubes; auto takes half where it holds every value. rgb9e5 and "
        "r11g11b10 are of ktx2.",
    ),
    click.option(
        "--cube-space",
        type=click.Choice(choices.CUBE_SPACES),
        show_default="world",
        help="Axes of the cubes: the map's own, or with x or z negated.",
    ),
    click.option(
        "--face-names",
        metavar="STYLE|A,B,C,D,E,F",
        show_default="px",
        help="How six .exr are named, as of render.",
    ),
)


def lighting_needs(options: Mapping[str, Any], program: Program) -> Needs:
    """Return what `lighting_options` need to have an effect."""
    parts = options["parts"] or choices.LIGHTING_PARTS
    file_format = options["file_format"] or program.format
    sun = options["sun_disc"] or program.sun_disc
    of_part = {
        **dict.fromkeys(("specular_size", "mips", "mip_roughness", "samples"), "specular"),
        "diffuse_size": "diffuse",
        **dict.fromkeys(("dfg_size", "dfg_multiscatter"), "dfg"),
    }
    has_cube = bool({"specular", "diffuse"} & set(parts))
    return {
        **{name: (part in parts, f"needs --parts {part}") for name, part in of_part.items()},
        **dict.fromkeys(
            ("file_format", "pixel", "cube_space"),
            (has_cube, "needs --parts specular or diffuse"),
        ),
        "face_names": (has_cube and file_format == "exr", "needs --format exr"),
        **dict.fromkeys(
            ("sun_size", "sun_soft", "sun_strength"),
            (sun == "include", "needs --sun-disc include"),
        ),
        "units": (options["ev"] is None, "cannot be combined with --ev"),
    }
