"""Pictures of image files, metered by the light that they hold."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from skybake.baking.file_light import FileLight
from skybake.colour.exposure import luminance_from_ev
from skybake.colour.white_balance import chromaticity
from skybake.environment.tags import file_space, file_white
from skybake.errors import InputError
from skybake.formats.preview import check_preview, write_preview
from skybake.formats.reader import ImageFile
from skybake.formats.shrink import Shrinking
from skybake.image.picture import balanced
from skybake.image.picture_settings import PictureSettings
from skybake.image.picture_texts import shot_text, vision_text, white_balance_text
from skybake.image.vision import as_seen
from skybake.projection import Perspective
from skybake.projection.lookup import Lookup
from skybake.projection.of_file import file_canvas, file_rotation

MAX_WIDTH = 1024
"""Largest width of pictures; larger maps are reduced. [pixel]"""

# A file that does not state its scale is shown as if 1.0 were the white of EV 15.
UNKNOWN_WHITE = luminance_from_ev(15.0)


@dataclass(frozen=True)
class Shown:
    """How a file was shown.

    Attributes
    ----------
    ev : float
        Exposure value at ISO 100.
    white : tuple of float or None
        CIE xy of the light that became white; None for D65.
    """

    ev: float
    white: tuple[float, float] | None


def preview_file(source: Path, path: Path, settings: PictureSettings | None = None) -> Shown:
    """Write a picture of an image file.

    Parameters
    ----------
    source : Path
        An EXR or Radiance picture.
    path : Path
        ``.png``.
    settings : PictureSettings, optional
        How it is shown. White balance is none by default where a file is not known to show
        another world than Earth.

    Raises
    ------
    InputError
        If the file is no image, its tags name a space that is not known, or it does not show
        what is asked for.
    OutputError
        If the picture cannot be written.
    """
    settings = settings or PictureSettings()
    check_preview(path)
    image = ImageFile(source)
    attributes = image.attributes
    space = file_space(source, attributes)
    white_luminance = file_white(source, attributes) or UNKNOWN_WHITE
    lookup = _lookup(source, image, settings.shot)
    picture = Shrinking(image.width, image.height, MAX_WIDTH)
    for rows in image.bands():
        picture.add(rows)
        if lookup is not None:
            lookup.add(rows)
    whole = picture.result()
    height, width = whole.shape[:2]
    light = FileLight(
        attributes,
        whole,
        file_canvas(attributes, source.stem, width, height),
        space,
        white_luminance,
    )
    shown, canvas = whole, light.canvas
    if lookup is not None and settings.shot is not None:
        shown, canvas = lookup.result(), settings.shot.canvases()[0]
    ev = settings.fixed_ev
    ev = light.ev(shown, canvas) if ev is None else ev
    wanted = light.white_balance(settings)
    white = light.white(wanted)
    texts = {
        "skybake:exposureValue": f"{ev:.4f}",
        "skybake:view": settings.view,
        "skybake:whiteBalance": white_balance_text(wanted),
        "skybake:shot": "none" if settings.shot is None else shot_text(settings.shot),
        **vision_text(settings.vision),
    }
    write_preview(
        path,
        balanced(as_seen(shown, space, white_luminance, settings.vision), space, white),
        space,
        gain=white_luminance / luminance_from_ev(ev),
        view=settings.view,
        texts=texts,
    )
    return Shown(ev, None if white is None else chromaticity(white))


def _lookup(source: Path, image: ImageFile, shot: Perspective | None) -> Lookup | None:
    """Return what makes the picture of a shot."""
    if shot is None:
        return None
    canvas = file_canvas(image.attributes, source.stem, image.width, image.height)
    if canvas is None:
        raise InputError(
            f"{source}: shot: must be of a map whose layout is known, "
            f"got a picture of {image.width}x{image.height}"
        )
    lookup = Lookup(canvas, shot.on_map(file_rotation(image.attributes)))
    if not lookup.shows_something:
        raise InputError(
            f"{source}: shot: must look where the map shows something, got {shot_text(shot)}"
        )
    return lookup
