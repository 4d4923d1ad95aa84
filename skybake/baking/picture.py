"""The preview of a map that is baked."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import NamedTuple

from skybake.colour.white_balance import chromaticity
from skybake.formats.preview import open_preview, write_picture
from skybake.formats.whole_files import WholeFiles
from skybake.image.layers import Pixels
from skybake.image.meter import scene_white
from skybake.image.picture import picture_ev, picture_projection, show_scene
from skybake.image.picture_settings import PictureSettings
from skybake.image.picture_texts import preview_texts
from skybake.image.scene import Scene
from skybake.projection import Projection


class OpenPicture(NamedTuple):
    """A preview that is to be drawn.

    Attributes
    ----------
    ev : float
        Its exposure value.
    white : tuple of float or None
        CIE xy of the light that becomes white; None for D65.
    projection : Projection
        What it shows.
    draw : callable
        Makes the picture, of pixels in the projection if they are given.
    """

    ev: float
    white: tuple[float, float] | None
    projection: Projection
    draw: Callable[[Pixels | None], None]


def open_picture(
    scene: Scene, path: Path, settings: PictureSettings, files: WholeFiles, stack: ExitStack
) -> OpenPicture:
    """Open the preview of a scene.

    Parameters
    ----------
    scene : Scene
        What is shown.
    path : Path
        ``.png``.
    settings : PictureSettings
        How it is shown.
    files : WholeFiles
        The files that it is to appear with.
    stack : ExitStack
        Closes the file.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    ev, white = picture_ev(scene, settings), scene_white(scene, settings)
    shown = picture_projection(scene.settings.view, settings.shot)
    if settings.show != "light":
        draw = partial(_draw_polarisation, scene, path, settings, shown, files)
        return OpenPicture(ev, None, shown, draw)
    show = stack.enter_context(
        open_preview(
            path,
            view=settings.view,
            max_width=shown.canvases()[0].width,
            texts=preview_texts(scene.planet, scene.settings, ev, settings),
            files=files,
        )
    )
    return OpenPicture(
        ev,
        None if white is None else chromaticity(white),
        shown,
        partial(show_scene, scene, show, ev, white, shown, settings.vision),
    )


def _draw_polarisation(
    scene: Scene,
    path: Path,
    settings: PictureSettings,
    shown: Projection,
    files: WholeFiles,
    _: Pixels | None,
) -> None:
    from skybake.image.polarisation_picture import polarisation_picture

    codes = polarisation_picture(scene, shown, settings.show)
    texts = preview_texts(scene.planet, scene.settings, 0.0, settings)
    write_picture(path, codes.shape[1], codes.shape[0], [codes], texts=texts, files=files)
