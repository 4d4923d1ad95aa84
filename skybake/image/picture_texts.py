"""What the preview of a map states besides its pixels."""

from __future__ import annotations

import math

from skybake.image.picture_settings import PictureSettings, WhiteBalance, white_balance_of
from skybake.image.recipe import HASH_ATTRIBUTE, recipe_hash
from skybake.image.settings import MapSettings
from skybake.preset import Planet
from skybake.projection import Perspective


def preview_texts(
    planet: Planet, settings: MapSettings, ev: float, picture: PictureSettings
) -> dict[str, str]:
    """Return the text chunks of a map's preview.

    The exposure value is rounded to less than a visible difference.
    """
    return {
        HASH_ATTRIBUTE: recipe_hash(planet, settings),
        "skybake:exposureValue": f"{ev:.4f}",
        "skybake:view": picture.view,
        "skybake:whiteBalance": white_balance_text(white_balance_of(picture, planet)),
        "skybake:shot": "none" if picture.shot is None else shot_text(picture.shot),
        **vision_text(picture.vision),
        **({} if picture.show == "light" else {"skybake:show": picture.show}),
    }


def vision_text(vision: str) -> dict[str, str]:
    """Return the text chunk of a picture that does not look as to a camera."""
    return {} if vision == "camera" else {"skybake:vision": vision}


def white_balance_text(white_balance: WhiteBalance) -> str:
    """Write a white balance as users type it."""
    return white_balance if isinstance(white_balance, str) else f"{white_balance:.10g}K"


def shot_text(shot: Perspective) -> str:
    """Write a shot as users type it."""
    angles = (shot.azimuth, shot.elevation, shot.fov)
    return ",".join(f"{math.degrees(angle):.10g}" for angle in angles)
