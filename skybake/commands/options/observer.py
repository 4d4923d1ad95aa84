"""The options of the sun by its angles, and of the observer's altitude; of sequences as ranges."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from skybake.commands.options import values
from skybake.commands.options.rules import Decorator


def sun_option(*, is_range: bool = False) -> Decorator:
    """Return ``--sun``, an elevation or a range of them."""
    text = "Geometric elevation of the sun's centre at the observer, "
    return click.option(
        "--sun",
        "sun_elevation",
        **_quantity("ANGLE", values.elevation, is_range=is_range),
        default="30deg",
        show_default=True,
        help=text + ("from first to last frame." if is_range else "-90deg to 90deg."),
    )


def sun_azimuth_option(*, is_range: bool = False) -> Decorator:
    """Return ``--sun-azimuth``, a bearing or a range of them."""
    return click.option(
        "--sun-azimuth",
        **_quantity("ANGLE", values.bearing, is_range=is_range),
        default="180deg",
        show_default=True,
        help="Compass bearing of the sun: 0deg is north, 90deg east.",
    )


def altitude_option(*, is_range: bool = False) -> Decorator:
    """Return ``--altitude``, a length or a range of them."""
    return click.option(
        "--altitude",
        **_quantity("LENGTH", values.altitude, is_range=is_range),
        default="0m",
        show_default=True,
        help="Of the observer above the ground.",
    )


def _quantity(metavar: str, read: Callable[[str], float], *, is_range: bool) -> dict[str, Any]:
    if is_range:
        return {"metavar": f"{metavar}[..{metavar}]", "type": values.ramp(read)}
    return {"metavar": metavar, "type": read}
