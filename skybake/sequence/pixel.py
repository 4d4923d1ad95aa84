"""The pixel type of a sequence, which is one for all frames."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from skybake.baking.pixel_type import pixel_type
from skybake.errors import SkybakeError
from skybake.image.scene import Scene
from skybake.sequence.plan import Frame, Plan

_FEATURES: tuple[Callable[[Frame], float], ...] = (
    lambda frame: frame.settings.lighting.sun_elevation,
    lambda frame: frame.settings.encoding.white_luminance,
    lambda frame: frame.settings.view.altitude,
    lambda frame: frame.world,
)


def common_pixel(plan: Plan) -> Literal["float"] | None:
    """Return what the pixel type auto stands for in all frames of a sequence.

    Parameters
    ----------
    plan : Plan
        All of the sequence, so that each machine of a farm decides alike.

    Returns
    -------
    "float" or None
        Float if one of the frames with the lowest or the highest sun, altitude and so on
        needs it. None leaves the choice to each frame, which will be half.
    """
    if all(frame.output.suffix.lower() == ".hdr" for frame in plan.frames):
        return None
    if any(frame.settings.encoding.pixel != "auto" for frame in plan.frames):
        return None
    for frame in _extremes(plan):
        try:
            if pixel_type(Scene(plan.planet(frame), frame.settings)) == "float":
                return "float"
        except SkybakeError:
            # The frame will fail by itself, and the others shall not.
            continue
    return None


def _extremes(plan: Plan) -> list[Frame]:
    """Return the frames at the ends of what changes, those with the lowest sun first."""
    if len(plan.frames) == 1:
        return []
    ends = [end(plan.frames, key=feature) for feature in _FEATURES for end in (min, max)]
    return list({frame.number: frame for frame in ends}.values())
