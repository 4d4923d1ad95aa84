"""Bakes a planned sequence: checks, tables that all frames share, and what bakes the frames."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from skybake.image.picture_settings import PictureSettings
from skybake.sequence.dask import dask_pool
from skybake.sequence.frame import PreviewSettings
from skybake.sequence.pixel import common_pixel
from skybake.sequence.plan import Plan
from skybake.sequence.pool import Run, local_pool
from skybake.sequence.products import Products
from skybake.sequence.run import FrameEvent, SequenceResult, bake_frames, common_ev, prepare
from skybake.sequence.sheet import TILE_WIDTH


def bake_sequence(
    plan: Plan,
    *,
    only: Sequence[int] | None = None,
    products: Products | None = None,
    picture: PictureSettings | None = None,
    skip_existing: bool = False,
    retries: int = 0,
    workers: int | None = None,
    dask: str | None = None,
    tell: Callable[[FrameEvent], None] | None = None,
    notice: Callable[[str], None] | None = None,
) -> SequenceResult:
    """Bake the frames of a plan.

    Parameters
    ----------
    plan : Plan
        Of `skybake.plan_sequence`.
    only : sequence of int, optional
        Frames to bake, if not all.
    products : Products, optional
        What will be written about the sequence: their names are checked and their
        thumbnails made. Call its ``write`` with the result.
    picture : PictureSettings, optional
        How all pictures show the frames. An exposure value of auto suits the frame with the
        highest sun, or is the maps' own where a curve sets it.
    skip_existing : bool, optional
        Skip frames whose files are complete and of the same recipe.
    retries : int, optional
        How often a frame that failed is tried again, after all others.
    workers : int, optional
        Frames at once; default one for each CPU.
    dask : str, optional
        Address of a Dask scheduler, as ``tcp://host:8786``, to bake there instead.
    tell : callable, optional
        Called with each `FrameEvent`.
    notice : callable, optional
        Called with a human-readable line when something takes long that later runs need not repeat.

    Returns
    -------
    SequenceResult
        Which frames were baked, skipped or failed; one that fails does not stop the others.

    Raises
    ------
    SkybakeError
        If a file could not be written, before anything is computed.
    """
    part = plan if only is None else plan.only(only)
    check_sequence(part, products)
    with frame_pool(
        plan,
        part,
        products=products,
        picture=picture,
        skip_existing=skip_existing,
        workers=workers,
        dask=dask,
        notice=notice,
    ) as run:
        return bake_frames(
            part,
            run,
            retries=retries,
            tell=tell or (lambda _: None),
            keep=(lambda outcome: outcome) if products is None else products.keep,
        )


def check_sequence(part: Plan, products: Products | None) -> None:
    """Raise the errors of all files that can be found before anything is computed.

    Raises
    ------
    SkybakeError
        If a file cannot be written under its name, or would be written twice.
    """
    part.check(() if products is None else products.paths)
    if products is not None:
        products.check()


@contextmanager
def frame_pool(
    plan: Plan,
    part: Plan,
    *,
    products: Products | None = None,
    picture: PictureSettings | None = None,
    skip_existing: bool = False,
    workers: int | None = None,
    dask: str | None = None,
    notice: Callable[[str], None] | None = None,
) -> Iterator[Run]:
    """Yield what bakes frames: threads of this process, or workers of a cluster.

    Parameters
    ----------
    plan, part : Plan
        The whole sequence, which determines how frames are shown, and the part to bake.
    products, picture, skip_existing, workers, dask, notice
        As of `bake_sequence`.

    Raises
    ------
    SkybakeError
        If the cluster cannot be used.
    """
    if dask is None:
        # First, because finding an exposure needs the same tables, and would print no notice.
        prepare(part, notice)
    previews = _preview_settings(plan, products, picture or PictureSettings())
    pool = (
        local_pool(part, previews, workers=workers, skip_existing=skip_existing)
        if dask is None
        else dask_pool(part, previews, dask, skip_existing=skip_existing)
    )
    with pool as run:
        yield run


def _preview_settings(
    plan: Plan, products: Products | None, picture: PictureSettings
) -> PreviewSettings:
    """How frames are stored and shown; of a part of a sequence as all of it would be."""
    widths = () if products is None else products.thumbnail_widths
    is_common = picture.ev in {None, "auto"}
    follows_map = is_common and plan.exposure_curve is not None
    adapts_tiles = picture.ev is None and not follows_map
    # The tiles of a sheet do not need the exposure of others.
    shared = set(widths) - ({TILE_WIDTH} if adapts_tiles else set())
    has_pictures = bool(shared) or any(frame.preview is not None for frame in plan.frames)
    if is_common and has_pictures and not follows_map:
        picture = replace(picture, ev=common_ev(plan, picture))
    return PreviewSettings(picture, adapts_tiles, follows_map, widths, common_pixel(plan))
