"""Rays in fans that share their start and zenith angle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Array


class Fans(NamedTuple):
    """Rays in groups that share their start and zenith angle, and so their samples.

    Attributes
    ----------
    rays : ndarray of float64, shape (ray, 4)
        Radius of each ray's start [km], cosines of its zenith angle and of the sun's
        there, and of the angle between ray and sun.
    first : ndarray of int64, shape (fan + 1,)
        First ray of each fan, and the end of the last.
    starts : ndarray of float64, shape (fan, 2)
        What the rays of each fan share, as `trace` takes it.
    """

    rays: Array
    first: npt.NDArray[np.int64]
    starts: Array


def group_rays(rays: Array, distances: Array | None = None) -> Fans:
    """Find the fans among rays that are ordered by direction.

    Parameters
    ----------
    rays : ndarray of float64, shape (ray, 4)
        As `Fans` holds them.
    distances : ndarray of float64, shape (ray, distance), optional
        What the rays of a fan have to share as well.
    """
    is_new = np.any(rays[1:, :2] != rays[:-1, :2], axis=1)
    if distances is not None:
        is_new |= np.any(distances[1:] != distances[:-1], axis=1)
    first = np.concatenate([[0], np.flatnonzero(is_new) + 1, [len(rays)]]).astype(np.int64)
    return Fans(rays, first, np.ascontiguousarray(rays[first[:-1], :2]))
