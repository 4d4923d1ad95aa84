"""The options of pictures to look at."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from skybake.commands.options import values
from skybake.commands.options.rules import Decorator, Needs, options_together

BESIDE = Path("beside-the-map.png")
"""Selects the default name of a preview."""

_SEQUENCE_PICTURES = ("preview", "contact_sheet", "animate")


def _preview_option(metavar: str, text: str) -> Decorator:
    return click.option(
        "--preview",
        is_flag=False,
        flag_value=BESIDE,
        metavar=metavar,
        type=click.Path(path_type=Path),
        callback=values.with_suffix(".png"),
        help=text,
    )


_view_option = click.option(
    "--view",
    type=click.Choice(values.VIEWS),
    show_default=values.VIEWS[0],
    help="Its display transform: ACES 2.0, or that of ACES 1.3.",
)

preview_options = options_together(
    _preview_option("[FILE.png]", "Also write a picture to look at; by default beside the map."),
    click.option(
        "--preview-ev",
        metavar="auto|N",
        type=values.exposure,
        show_default="auto",
        help="Its exposure value at ISO 100; auto finds a legible one.",
    ),
    _view_option,
)

sequence_preview_options = options_together(
    _preview_option("[PATTERN.png]", "Also write pictures to look at; by default beside the maps."),
    click.option(
        "--preview-ev",
        metavar="auto|adapt|N",
        type=values.sequence_exposure,
        show_default="auto",
        help="Exposure value of all pictures at ISO 100; auto suits the frame with the highest "
        "sun, adapt finds one for each frame.",
    ),
    _view_option,
)


def preview_needs(options: Mapping[str, Any]) -> Needs:
    """Return what the options of pictures need: an option that asks for one."""
    pictures = [name for name in _SEQUENCE_PICTURES if name in options]
    has_pictures = any(options[name] is not None for name in pictures)
    need = " or ".join(f"--{name.replace('_', '-')}" for name in pictures)
    return dict.fromkeys(("preview_ev", "view"), (has_pictures, f"needs {need}"))
