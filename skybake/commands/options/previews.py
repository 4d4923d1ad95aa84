"""The options of pictures to look at."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import choices, values
from skybake.commands.options.rules import Decorator, Needs, options_together

if TYPE_CHECKING:
    from skybake.image.picture_settings import PictureSettings

BESIDE = Path("beside-the-map.png")
"""Selects the default name of a preview."""

_SEQUENCE_PICTURES = ("preview", "contact_sheet", "animate")


def preview_option(metavar: str, text: str) -> Decorator:
    """Name a file of its own, or, without one, the file beside the map."""
    return click.option(
        "--preview",
        is_flag=False,
        flag_value=BESIDE,
        metavar=metavar,
        type=click.Path(path_type=Path),
        callback=values.with_suffix(".png"),
        help=text,
    )


look_options = options_together(
    click.option(
        "--white-balance",
        metavar="auto|none|KELVIN",
        type=values.white_balance,
        show_default="none on Earth, auto on other worlds",
        help="What its white is: by auto the light that falls on the ground; none is D65. Maps are "
        "never changed.",
    ),
    click.option(
        "--shot",
        metavar="AZIMUTH,ELEVATION,FOV",
        type=values.shot,
        help="Show a perspective view of the map, 16:9, of which FOV is the width.",
    ),
    click.option(
        "--view",
        type=click.Choice(choices.VIEWS),
        show_default=choices.VIEWS[0],
        help="Its display transform: that of ACES 1.3, or ACES 2.0.",
    ),
)


def _vision_option(name: str) -> Decorator:
    return click.option(
        name,
        "vision",
        type=click.Choice(choices.VISIONS),
        show_default=choices.VISIONS[0],
        help="Whether the dark looks as to a camera, or as to the eye, which sees less colour in "
        "it. Maps are never changed.",
    )


vision_option = _vision_option("--vision")
preview_vision_option = _vision_option("--preview-vision")

preview_options = options_together(
    preview_option("[FILE.png]", "Also write a picture to look at; by default beside the map."),
    click.option(
        "--preview-ev",
        metavar="auto|N",
        type=values.exposure,
        show_default="auto",
        help="Its exposure value at ISO 100; auto meters the sky as a camera does.",
    ),
    preview_vision_option,
    click.option(
        "--show",
        type=click.Choice(choices.SHOWN),
        show_default="light",
        help="What it shows: the light, or its degree or angle of linear polarisation.",
    ),
    look_options,
)

sequence_preview_options = options_together(
    preview_option("[PATTERN.png]", "Also write pictures to look at; by default beside the maps."),
    click.option(
        "--preview-ev",
        metavar="auto|adapt|N",
        type=values.sequence_exposure,
        show_default="auto, and adapt for contact sheets",
        help="Exposure value of all pictures at ISO 100; auto suits the frame with the highest "
        "sun, adapt finds one for each frame.",
    ),
    preview_vision_option,
    look_options,
)

_NAMES = ("preview_ev", "show", "white_balance", "shot", "view", "vision")


def picture_from_options(options: Mapping[str, Any], ev: float | str | None) -> PictureSettings:
    """Return how pictures show maps.

    Parameters
    ----------
    options : mapping
        With the values of `look_options`, or of those of them that a command has.
    ev : float, str or None
        Exposure value, as of `PictureSettings`.
    """
    from skybake.image.picture_settings import PictureSettings, shot

    view = options.get("shot")
    return PictureSettings(
        ev=ev,  # type: ignore[arg-type]
        view=options["view"] or choices.VIEWS[0],
        white_balance=options["white_balance"],
        shot=None if view is None else shot(*view),
        vision=options["vision"] or choices.VISIONS[0],
        show=options.get("show") or choices.SHOWN[0],
    )


def preview_needs(options: Mapping[str, Any]) -> Needs:
    """Return what the options of pictures need: an option that asks for one."""
    pictures = [name for name in _SEQUENCE_PICTURES if name in options]
    has_pictures = any(options[name] is not None for name in pictures)
    need = " or ".join(f"--{name.replace('_', '-')}" for name in pictures)
    return dict.fromkeys(_NAMES, (has_pictures, f"needs {need}"))
