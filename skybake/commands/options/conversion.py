"""What a map is made into, and what is known of the one that is read."""

from __future__ import annotations

import click

from skybake.commands.options import choices, values
from skybake.commands.options.rules import options_together
from skybake.commands.options.written import (
    clamp_negative_option,
    compression_option,
    ev_option,
    fov_option,
    look_option,
    omit_exposure_option,
    pixel_option,
)

_SAME = "that of IN"

conversion_options = options_together(
    click.option(
        "--projection",
        type=click.Choice(choices.PROJECTIONS),
        show_default=_SAME,
        help="Kind of map, as of 'skybake render'.",
    ),
    click.option(
        "--size",
        metavar="WxH|EDGE",
        type=values.size,
        show_default="as finely divided as IN",
        help="Width and height, or edge of a cubemap's face or of a square map.",
    ),
    fov_option,
    look_option,
    click.option(
        "--cube-layout",
        type=click.Choice(choices.CUBE_LAYOUTS),
        show_default="faces, or that of IN",
        help="Six files px nx py ny pz nz, one horizontal or vertical cross, row or column, or one "
        "OpenEXR cube.",
    ),
    click.option(
        "--cube-space",
        type=click.Choice(choices.CUBE_SPACES),
        show_default="world, or that of IN",
        help="Axes of a cubemap: the map's own, or with x or z negated.",
    ),
    click.option(
        "--face-names",
        metavar="STYLE|A,B,C,D,E,F",
        show_default="px",
        help="How six files are named, as of 'skybake render'.",
    ),
    click.option(
        "--equirect-rows",
        type=click.Choice(choices.EQUIRECT_ROWS),
        show_default="centres, or those of IN",
        help="Where the first and the last row look: half a row beside the zenith and the nadir, "
        "or at them.",
    ),
    click.option(
        "--rotate",
        metavar="ANGLE",
        type=values.bearing,
        show_default=_SAME,
        help="Compass bearing of the new map's -Z; of IN that is 0deg unless metadata say else.",
    ),
    click.option(
        "--colorspace",
        type=click.Choice(choices.COLOUR_SPACES),
        show_default=_SAME,
        help="Linear, scene-referred space of the pixels.",
    ),
    click.option(
        "--units",
        type=click.Choice(choices.UNITS),
        show_default=_SAME,
        help="What a pixel value of 1 stands for: 1.2 * 2^15 cd/m2, or 1 cd/m2.",
    ),
    ev_option,
    pixel_option,
    compression_option,
    click.option(
        "--mips",
        is_flag=True,
        help="Write smaller copies with the map, down to one pixel; of an equirect .exr or a "
        "cubemap whose size is a power of two.",
    ),
    clamp_negative_option,
    omit_exposure_option,
    click.option(
        "--input-projection",
        type=click.Choice(choices.PROJECTIONS),
        show_default="what metadata or the shape of IN say",
        help="Kind of map that IN is.",
    ),
    click.option(
        "--input-cube-space",
        type=click.Choice(choices.CUBE_SPACES),
        show_default="world",
        help="Axes of IN, a cubemap.",
    ),
    click.option(
        "--input-fov",
        metavar="ANGLE",
        type=values.field_of_view,
        show_default="180deg for a fisheye, 50deg for perspective",
        help="Angle that the width of IN covers, a fisheye or perspective picture.",
    ),
    click.option(
        "--input-look",
        metavar="AZIMUTH,ELEVATION",
        type=values.look,
        show_default="180,90 for a fisheye, 180,0 for perspective",
        help="Where the middle of such a picture looks.",
    ),
    click.option(
        "--input-rotate",
        metavar="ANGLE",
        type=values.bearing,
        show_default="what metadata say, or 0deg",
        help="Compass bearing of the -Z of IN.",
    ),
    click.option(
        "--input-colorspace",
        type=click.Choice(choices.COLOUR_SPACES),
        show_default="what tags say, or lin_rec709",
        help="Space of the pixels of IN.",
    ),
    click.option(
        "--input-units",
        type=click.Choice(choices.UNITS),
        show_default="what tags say",
        help="What a pixel value of 1 stands for in IN.",
    ),
    click.option(
        "--input-ev",
        metavar="N",
        type=float,
        help="Let a pixel value of 1 stand for 1.2 * 2^N cd/m2 in IN.",
    ),
)
