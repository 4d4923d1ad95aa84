"""The air in front of what a camera sees."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.aerial.depth import Depths
from skybake.aerial.lookup import allocate_air, fill_air
from skybake.aerial.sight import ABOVE, BELOW, Eye, Lens, eye_of, survey
from skybake.aerial.volume import TAPS, Extent, Volume, build_volume
from skybake.image.scene import Scene
from skybake.jit.arguments import flatten
from skybake.jit.workers import Workers
from skybake.optics.medium import Array
from skybake.sky.sky import Sky

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


class LitAir(NamedTuple):
    """The light of the air under one body, for directions and distances that are looked at.

    Attributes
    ----------
    sky : Sky
        The observer and what shines.
    above, below : Volume
        Above the horizon and below it.
    """

    sky: Sky
    above: Volume
    below: Volume


def air_before(scene: Scene, lens: Lens, depths: Depths) -> Air:
    """Return the air up to finite distances; at infinity and at 0 there is none in it.

    Parameters
    ----------
    scene : Scene
        The observer, the sun and the Moon, and the scale of values.
    lens : Lens
        Where pixels look.
    depths : Depths
        How far they see.
    """
    return look_up(lens, volumes_for(scene, lens, [depths]), depths)


def volumes_for(scene: Scene, lens: Lens, needed: Sequence[Depths]) -> list[LitAir]:
    """Return the light by the sun, and by the Moon if it is seen, that some depths need."""
    return [_volumes(*light, lens, needed) for light in _lights(scene)]


def _lights(scene: Scene) -> Iterator[tuple[Sky, Array]]:
    """Yield what shines, and the weights of its spectrum."""
    yield scene.sky, scene.rgb_weights
    moonlit = scene.moonlit
    if moonlit is not None and moonlit.lights_air:
        yield moonlit.sky, moonlit.rgb_weights


def _volumes(sky: Sky, weights: Array, lens: Lens, needed: Sequence[Depths]) -> LitAir:
    eye = eye_of(sky.skylight, sky.source)
    found = np.concatenate([_survey(sky.workers, eye, lens, depths) for depths in needed])
    above, below = (_volume(sky, weights, eye, found[:, side], side) for side in (ABOVE, BELOW))
    return LitAir(sky, above, below)


def look_up(lens: Lens, lights: Sequence[LitAir], depths: Depths) -> Air:
    """Return the air before a picture, of volumes that hold what it needs.

    What passes is of light of the first body's colour.
    """
    air, *others = [_look_up(each, lens, depths) for each in lights]
    for other in others:
        np.add(air.light, other.light, out=air.light)
    return air


def _look_up(lit: LitAir, lens: Lens, depths: Depths) -> Air:
    sky, volumes = lit.sky, (lit.above, lit.below)
    eye = eye_of(sky.skylight, sky.source)
    shape = (*depths.values.shape, 3)
    air = Air(np.empty(shape, np.float32), np.empty(shape, np.float32))
    given = [flatten(each) for each in (eye, lens, *volumes, depths.values)]

    def work(first: int, last: int) -> None:
        scratch = allocate_air(*volumes)
        fill_air(*given, depths.unit, depths.is_planar, first, last, scratch, *air)

    sky.workers.run_rows(shape[0], work, chunk=ROWS)
    return air


def _survey(workers: Workers, eye: Eye, lens: Lens, depths: Depths) -> Array:
    """Return what each row needs of either side, see `survey`, shape (row, 2, 4)."""
    rows = len(depths.values)
    found = np.empty((rows, 2, 4))
    given = [flatten(each) for each in (eye, lens, depths.values)]

    def work(first: int, last: int) -> None:
        survey(*given, depths.unit, depths.is_planar, first, last, np.empty(9), found)

    workers.run_rows(rows, work, chunk=ROWS)
    return found


def _volume(sky: Sky, weights: Array, eye: Eye, needed: Array, side: int) -> Volume:
    least, greatest = needed[:, ::2].min(axis=0), needed[:, 1::2].max(axis=0)
    if least[0] > greatest[0]:
        return _nothing()
    extent = Extent(float(least[0]), float(greatest[0]), float(least[1]), float(greatest[1]))
    return build_volume(sky.skylight, sky.source, eye, extent, weights, is_below=side == BELOW)


def _nothing() -> Volume:
    """Return a volume that no pixel looks at, of the same types."""
    one = np.zeros((TAPS, TAPS, TAPS, 3), np.float32)
    return Volume(0.0, 1.0, 0.0, 1.0, 1.0, one, one[0].copy(), np.zeros((2, 1), np.float32))
