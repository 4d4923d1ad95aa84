"""One frame of a sequence, baked or found."""

from __future__ import annotations

import gc
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.baking.paths import map_paths
from skybake.baking.pixel_type import PixelType
from skybake.baking.write import bake_scene
from skybake.colour.exposure import ev_from_luminance
from skybake.errors import InputError
from skybake.formats.reader import read_attributes
from skybake.formats.whole_files import WholeFiles, remove_leftovers
from skybake.image.light import (
    Light,
    attributes_from_light,
    light_from_attributes,
    light_of_scene,
    moon_attributes,
)
from skybake.image.moon_figures import ColourAndLight, moon_from_attributes
from skybake.image.picture import picture_ev, thumbnail
from skybake.image.picture_settings import PictureSettings
from skybake.image.picture_texts import preview_texts
from skybake.image.recipe import recipe_hash
from skybake.image.scene import Scene
from skybake.pipeline import Pipeline
from skybake.preset import Planet
from skybake.sequence.digests import claim_of, file_sha256, verified_digests, write_digests
from skybake.sequence.plan import Frame
from skybake.sequence.sheet import TILE_WIDTH


@dataclass(frozen=True)
class PreviewSettings:
    """How frames are shown.

    Attributes
    ----------
    picture : PictureSettings
        How all pictures show them. Its exposure value is a number, or adapt.
    adapts_tiles : bool
        Whether the tiles of a contact sheet are exposed each for itself nevertheless.
    follows_map : bool
        Show maps as their own exposure has them, in place of that exposure.
    thumbnail_widths : tuple of int
        Of the thumbnails of each frame. [pixel]
    pixel : {"half", "float"} or None
        What the maps' pixel type auto stands for; None decides it by each frame.
    """

    picture: PictureSettings = field(default_factory=PictureSettings)
    adapts_tiles: bool = False
    follows_map: bool = False
    thumbnail_widths: tuple[int, ...] = ()
    pixel: PixelType | None = None


@dataclass(frozen=True)
class FrameOutcome:
    """A frame that is done.

    Attributes
    ----------
    number : int
        Its frame number.
    is_new : bool
        Whether it was baked; False if its files existed.
    light : Light
        Its light.
    files : tuple of Path
        The map, one file or six.
    sha256 : tuple of str
        Digests of these files.
    ev : float or None
        Exposure value of its picture, if that is known.
    tile_ev : float or None
        The same of its tile on a contact sheet.
    thumbnails : mapping of int to ndarray of uint8
        Code values of sRGB, shape (row, width, 3), by their widths.
    warnings : tuple of str
        As of `skybake.baking.Baked`; none of a frame that was found.
    moon : tuple of colour and illuminance, or None
        Light of its Moon: linear Rec. 709 of luminance 1, and on a plane that faces it. [lx]
    """

    number: int
    is_new: bool
    light: Light
    files: tuple[Path, ...]
    sha256: tuple[str, ...]
    ev: float | None
    tile_ev: float | None
    thumbnails: Mapping[int, npt.NDArray[np.uint8]]
    warnings: tuple[str, ...] = ()
    moon: ColourAndLight | None = None


def finish_frame(
    frame: Frame,
    planet: Planet,
    previews: PreviewSettings,
    pipeline: Pipeline,
    *,
    skip_existing: bool = False,
) -> FrameOutcome:
    """Bake a frame, unless it exists.

    Parameters
    ----------
    frame, planet : Frame, Planet
        What to bake.
    previews : PreviewSettings
        What to show.
    pipeline : Pipeline
        Keeps what one frame shares with the next.
    skip_existing : bool, optional
        Skip the frame if its files are complete and of the same recipe.

    Raises
    ------
    SkybakeError
        As `skybake.baking.bake`.
    CancelledError
        If the pipeline's workers were stopped; no file is left then.
    """
    work = _Work(frame, planet, previews, pipeline)
    found = work.found() if skip_existing else None
    is_new = found is None
    pipeline.workers.check()
    files = map_paths(frame.output, frame.settings)
    warnings: tuple[str, ...] = ()
    if found is None:
        with WholeFiles() as whole:
            baked = bake_scene(
                work.scene,
                frame.output,
                preview=frame.preview,
                picture=None if frame.preview is None else work.picture,
                attributes=frame.attributes,
                files=whole,
                pixel=work.pixel,
            )
            digests = {path: file_sha256(whole.written(path)) for path in frame.files()}
            write_digests(whole, frame.output, work.claim, digests)
        warnings = baked.warnings
        # As read from its files if they are found later.
        light = light_from_attributes(attributes_from_light(baked))
        moon = moon_from_attributes(baked.moonlight)
    else:
        light, moon, digests = found
        for path in frame.files():
            remove_leftovers(path)
    outcome = FrameOutcome(
        number=frame.number,
        is_new=is_new,
        light=light,
        files=files,
        sha256=tuple(digests[path] for path in files),
        ev=work.ev if frame.preview is not None else None,
        tile_ev=work.tile_ev if TILE_WIDTH in previews.thumbnail_widths else None,
        thumbnails={width: work.thumbnail(width) for width in previews.thumbnail_widths},
        warnings=warnings,
        moon=moon,
    )
    if planet.clouds:
        # Scenes refer to themselves, and the light of their clouds takes memory that others need.
        del work
        gc.collect()
    return outcome


class _Work:
    """A frame's scene, made when it is needed."""

    def __init__(
        self, frame: Frame, planet: Planet, previews: PreviewSettings, pipeline: Pipeline
    ) -> None:
        self._frame, self._planet, self._previews, self._pipeline = (
            frame,
            planet,
            previews,
            pipeline,
        )

    @cached_property
    def scene(self) -> Scene:
        return self._pipeline.scene(self._planet, self._frame.settings)

    @cached_property
    def ev(self) -> float:
        """Exposure value of the preview and of animated pictures."""
        if self._previews.follows_map:
            return ev_from_luminance(self._frame.settings.encoding.white_luminance)
        return picture_ev(self.scene, self._previews.picture)

    @cached_property
    def tile_ev(self) -> float:
        """Exposure value of the tile on a contact sheet."""
        if self._previews.adapts_tiles:
            return picture_ev(self.scene, replace(self._previews.picture, ev="adapt"))
        return self.ev

    @property
    def picture(self) -> PictureSettings:
        """How the preview shows the map."""
        return replace(self._previews.picture, ev=self.ev)

    @property
    def pixel(self) -> PixelType | None:
        """What the frame's pixel type auto stands for, if that is decided."""
        return self._previews.pixel if self._frame.settings.encoding.pixel == "auto" else None

    @cached_property
    def claim(self) -> str:
        """What the maps are to hold, see `claim_of`."""
        decided = {} if self.pixel is None else {"pixel": self.pixel}
        return claim_of(
            recipe_hash(self._planet, self._frame.settings), {**self._frame.attributes, **decided}
        )

    def found(self) -> tuple[Light, ColourAndLight | None, dict[Path, str]] | None:
        """Return light, Moon and digests of the files if they are as this frame's were written."""
        frame, settings = self._frame, self._frame.settings
        digests = verified_digests(frame.output, self.claim, frame.files())
        if digests is None:
            return None
        if frame.preview is not None:
            texts = preview_texts(self._planet, settings, self.ev, self._previews.picture)
            if not texts.items() <= (_attributes(frame.preview) or {}).items():
                return None
        path = map_paths(frame.output, settings)[0]
        # A DDS file has no place for it.
        has_no_texts = path.suffix.lower() == ".dds"
        attributes = _attributes_of_scene(self.scene) if has_no_texts else _attributes(path)
        try:
            light = light_from_attributes(attributes or {})
        except (KeyError, ValueError):
            return None
        return light, moon_from_attributes(attributes or {}), digests

    def thumbnail(self, width: int) -> npt.NDArray[np.uint8]:
        ev = self.tile_ev if width == TILE_WIDTH else self.ev
        return thumbnail(self.scene, ev, self._previews.picture, width)


def _attributes_of_scene(scene: Scene) -> Mapping[str, Any]:
    """Return what a file of a scene would state of its light."""
    return {**attributes_from_light(light_of_scene(scene)), **moon_attributes(scene)}


def _attributes(path: Path) -> dict[str, Any] | None:
    """Return the attributes of a file if it can be read, else None."""
    try:
        return read_attributes(path)
    except (InputError, OSError):
        return None
