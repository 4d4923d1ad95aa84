"""What programs need of a map, by their names, with a reason for everything."""

from __future__ import annotations

from skybake.errors import InputError
from skybake.image.target_engines import ENGINES
from skybake.image.target_model import Target, TargetAxes, TargetReason
from skybake.image.target_renderers import RENDERERS

__all__ = ["TARGETS", "Target", "TargetAxes", "TargetReason", "find_target"]

TARGETS: dict[str, Target] = {target.name: target for target in (*RENDERERS, *ENGINES)}
"""Targets by their names."""


def find_target(name: str) -> Target:
    """Return a target by its name.

    Raises
    ------
    InputError
        If there is none of that name.
    """
    try:
        return TARGETS[name]
    except KeyError:
        raise InputError(f"target: must be one of {', '.join(TARGETS)}, got {name!r}") from None
