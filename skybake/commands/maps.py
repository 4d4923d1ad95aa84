"""The options of every command that bakes maps: what kind, and how it is stored."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from skybake.commands import parameters

Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--projection",
        type=click.Choice(parameters.PROJECTIONS),
        default="equirect",
        show_default=True,
        help="Kind of map; fisheye is equidistant, perspective a camera's picture.",
    ),
    click.option(
        "--size",
        metavar="WxH|EDGE",
        type=parameters.size,
        show_default="2048x1024, 1024 for a cubemap's face or a fisheye, 1920x1080 for perspective",
        help="Width and height, 2:1 for an equirect map, or edge of a cubemap's face or a fisheye.",
    ),
    click.option(
        "--fov",
        metavar="ANGLE",
        type=parameters.field_of_view,
        show_default="180deg for a fisheye, 50deg for perspective",
        help="Angle that the width of a fisheye or perspective picture covers.",
    ),
    click.option(
        "--look",
        metavar="AZIMUTH,ELEVATION",
        type=parameters.look,
        show_default="180,90 for a fisheye, 180,0 for perspective",
        help="Where the middle of such a picture looks.",
    ),
    click.option(
        "--cube-layout",
        type=click.Choice(parameters.CUBE_LAYOUTS),
        show_default="faces",
        help="Six files px nx py ny pz nz, one horizontal cross, or one OpenEXR cube.",
    ),
    click.option(
        "--colorspace",
        type=click.Choice(parameters.COLOUR_SPACES),
        default="lin_rec709",
        show_default=True,
        help="Linear, scene-referred space of the pixels.",
    ),
    click.option(
        "--units",
        type=click.Choice(parameters.UNITS),
        show_default="ev15",
        help="What a pixel value of 1 stands for: 1.2 * 2^15 cd/m2, or 1 cd/m2.",
    ),
    click.option(
        "--ev",
        metavar="N",
        type=float,
        help="Let a pixel value of 1 stand for 1.2 * 2^N cd/m2 instead.",
    ),
    click.option(
        "--pixel",
        type=click.Choice(parameters.PIXELS),
        show_default="auto",
        help="Stored type of an EXR; auto takes half where it holds every value.",
    ),
    click.option(
        "--compression",
        metavar="NAME[:LEVEL]",
        show_default="zip",
        help="Of an EXR: none, rle, zips, zip[:1-9], piz, pxr24, b44, b44a, dwaa[:0-135], ...",
    ),
    click.option("--clamp-negative", is_flag=True, help="Set negative values, out of gamut, to 0."),
    click.option(
        "--sun-disc",
        type=click.Choice(parameters.SUN_DISCS),
        default="include",
        show_default=True,
        help="Whether the map holds the sun's disc, or nothing else.",
    ),
    click.option(
        "--method",
        type=click.Choice(parameters.METHODS),
        default="full",
        show_default=True,
        help="Light transport: all orders of scattering, Hillaire's closure, or as a check single "
        "scattering by direct quadrature.",
    ),
)

view_option = click.option(
    "--view",
    type=click.Choice(parameters.VIEWS),
    show_default=parameters.VIEWS[0],
    help="Its display transform: ACES 2.0, or that of ACES 1.3.",
)


def map_options(command: Command) -> Command:
    """Add the options of a map, from its projection to the method."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command
