"""The air in front of what a camera sees."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.aerial.depth import Depths
from skybake.aerial.lookup import allocate_air, fill_air
from skybake.aerial.sight import ABOVE, BELOW, Eye, Lens, eye_of, survey
from skybake.aerial.volume import TAPS, Extent, Volume, build_volume
from skybake.image.scene import Scene
from skybake.jit.arguments import flatten
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

ROWS = 16
"""Rows that a thread takes at a time."""


class Air(NamedTuple):
    """What the air does to light from what pixels show.

    Attributes
    ----------
    light : ndarray of float32, shape (row, column, 3)
        What it adds.
    passing : ndarray of float32, shape (row, column, 3)
        The share that passes.
    """

    light: Floats
    passing: Floats


def air_before(scene: Scene, lens: Lens, depths: Depths) -> Air:
    """Return the air up to finite distances; at infinity and at 0 there is none in it.

    Parameters
    ----------
    scene : Scene
        The observer, the sun, and the scale of values.
    lens : Lens
        Where pixels look.
    depths : Depths
        How far they see.
    """
    return look_up(scene, lens, volumes_for(scene, lens, [depths]), depths)


def volumes_for(scene: Scene, lens: Lens, needed: Sequence[Depths]) -> tuple[Volume, Volume]:
    """Return the light above the horizon and below it that pictures of some depths need."""
    eye = eye_of(scene.sky.skylight, scene.sky.source)
    found = np.concatenate([_survey(scene, eye, lens, depths) for depths in needed])
    above, below = (_volume(scene, eye, found[:, side], side) for side in (ABOVE, BELOW))
    return above, below


def look_up(scene: Scene, lens: Lens, volumes: tuple[Volume, Volume], depths: Depths) -> Air:
    """Return the air before a picture, of volumes that hold what it needs."""
    eye = eye_of(scene.sky.skylight, scene.sky.source)
    shape = (*depths.values.shape, 3)
    air = Air(np.empty(shape, np.float32), np.empty(shape, np.float32))
    given = [flatten(each) for each in (eye, lens, *volumes, depths.values)]

    def work(first: int, last: int) -> None:
        scratch = allocate_air(*volumes)
        fill_air(*given, depths.unit, depths.is_planar, first, last, scratch, *air)

    scene.workers.run_rows(shape[0], work, chunk=ROWS)
    return air


def _survey(scene: Scene, eye: Eye, lens: Lens, depths: Depths) -> Array:
    """Return what each row needs of either side, see `survey`, shape (row, 2, 4)."""
    rows = len(depths.values)
    found = np.empty((rows, 2, 4))
    given = [flatten(each) for each in (eye, lens, depths.values)]

    def work(first: int, last: int) -> None:
        survey(*given, depths.unit, depths.is_planar, first, last, np.empty(9), found)

    scene.workers.run_rows(rows, work, chunk=ROWS)
    return found


def _volume(scene: Scene, eye: Eye, needed: Array, side: int) -> Volume:
    least, greatest = needed[:, ::2].min(axis=0), needed[:, 1::2].max(axis=0)
    if least[0] > greatest[0]:
        return _nothing()
    extent = Extent(float(least[0]), float(greatest[0]), float(least[1]), float(greatest[1]))
    sky = scene.sky
    return build_volume(
        sky.skylight, sky.source, eye, extent, scene.rgb_weights, is_below=side == BELOW
    )


def _nothing() -> Volume:
    """Return a volume that no pixel looks at, of the same types."""
    one = np.zeros((TAPS, TAPS, TAPS, 3), np.float32)
    return Volume(0.0, 1.0, 0.0, 1.0, 1.0, one, one[0].copy(), np.zeros((2, 1), np.float32))
