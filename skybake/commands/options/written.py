"""Options that mean the same wherever a map is written."""

from __future__ import annotations

import click

from skybake.commands.options import choices, values

fov_option = click.option(
    "--fov",
    metavar="ANGLE",
    type=values.field_of_view,
    show_default="180deg for a fisheye, 50deg for perspective",
    help="Angle that the width of a fisheye or perspective picture covers.",
)

look_option = click.option(
    "--look",
    metavar="AZIMUTH,ELEVATION",
    type=values.look,
    show_default="180,90 for a fisheye, 180,0 for perspective",
    help="Where the middle of such a picture looks.",
)

ev_option = click.option(
    "--ev",
    metavar="N",
    type=float,
    help="Let a pixel value of 1 stand for 1.2 * 2^N cd/m2 instead.",
)

pixel_option = click.option(
    "--pixel",
    type=click.Choice(choices.PIXELS),
    show_default="auto",
    help="Stored type; auto takes half where it holds every value. rgb9e5 and r11g11b10 are of "
    "a .ktx2.",
)

compression_option = click.option(
    "--compression",
    metavar="NAME[:LEVEL]",
    show_default="zip",
    help="Of an EXR: none, rle, zips, zip[:1-9], piz, pxr24, b44, b44a, dwaa[:0-135], ...; "
    "of a .ktx2: zstd (default) or none.",
)

omit_exposure_option = click.option(
    "--omit-exposure",
    is_flag=True,
    help="Leave the line EXPOSURE out of a .hdr, for programs that divide by it.",
)

clamp_negative_option = click.option(
    "--clamp-negative", is_flag=True, help="Set negative values (out of gamut) to 0."
)
