"""Rays that share a pixel too coarse for the clouds in it, as those seen from orbit are."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import SURFACE, CloudField
from skybake.clouds.light import LayerLight
from skybake.clouds.march import Marching
from skybake.clouds.sight import Eye, see_layer
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

_MOST = 3.0
"""Rays along each side of a pixel at most."""

_RESOLVED = 3.0
"""Distance between rays, in the largest blur of a field, up to which one ray a pixel is enough."""


_BLUR = 0.15
"""Blur of a layer below the observer, in the largest of its field: blurred clouds have the
extinction of sharp ones, but hide more."""


def rays_per_side(field: CloudField, altitude: float, pixel: float) -> float:
    """Return how many rays along each side of a pixel see a layer, on average over pixels.

    Parameters
    ----------
    field : CloudField
        The layer.
    altitude : float
        Of the observer. [km]
    pixel : float
        Angle of a pixel's side. [rad]
    """
    if field.kind != SURFACE:
        return 1.0
    footprint = max(altitude - field.top, 0.0) * pixel
    return min(max(footprint / (_RESOLVED * field.largest_blur) + 0.5, 1.0), _MOST)


def see_pixels(
    field: CloudField,
    light: LayerLight,
    eye: Eye,
    directions: Array,
    marching: Marching,
    out: tuple[Floats, Floats],
    workers: Workers,
    count: float,
    ends: Array | None = None,
) -> None:
    """Do what `see_layer` does, with the mean of `count` times `count` rays for each direction.

    Between two whole numbers some directions have the lower and others the higher, so that no edge
    shows where it changes.
    """
    least = int(count)
    if count == least:
        _see_several(field, light, eye, directions, marching, out, workers, least, ends)
        return
    has_more = _scattered(directions) < count - least
    for is_chosen, own in ((~has_more, least), (has_more, least + 1)):
        if is_chosen.all():
            _see_several(field, light, eye, directions, marching, out, workers, own, ends)
        elif is_chosen.any():
            part = np.empty_like(out[0][is_chosen]), np.empty_like(out[1][is_chosen])
            chosen = np.ascontiguousarray(directions[is_chosen])
            nearest = None if ends is None else np.ascontiguousarray(ends[is_chosen])
            _see_several(field, light, eye, chosen, marching, part, workers, own, nearest)
            out[0][is_chosen], out[1][is_chosen] = part


def _scattered(directions: Array) -> Array:
    """Return a number in [0, 1) for each direction, without any order but always the same."""
    words = np.ascontiguousarray(directions, np.float64).view(np.uint64)
    mixed = words[:, 0] ^ (words[:, 1] << np.uint64(1)) ^ (words[:, 2] << np.uint64(2))
    # The finalizer of Stafford's variant 13 (SplitMix64).
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    share: Array = ((mixed ^ (mixed >> np.uint64(31))) >> np.uint64(11)) * 2.0**-53
    return share


def _see_several(
    field: CloudField,
    light: LayerLight,
    eye: Eye,
    directions: Array,
    marching: Marching,
    out: tuple[Floats, Floats],
    workers: Workers,
    count: int,
    ends: Array | None = None,
) -> None:
    finer = marching._replace(pixel=marching.pixel / count)
    above = eye.altitude - field.top
    if field.kind == SURFACE and above > 0.0:
        finer = finer._replace(pixel=min(finer.pixel, _BLUR * field.largest_blur / above))
    if count == 1:
        see_layer(field, light, eye, directions, finer, out, workers, ends)
        return
    seen, passing = out
    seen[:], passing[:] = 0.0, 0.0
    weights = np.zeros(len(passing), np.float32)
    part = np.empty_like(seen), np.empty_like(passing)
    for rays in _spread(directions, marching.pixel, count):
        see_layer(field, light, eye, rays, finer, part, workers, ends)
        opacity = 1.0 - part[1][:, 0]
        # Of distances only those count at which there is something.
        part[1][:, 2] *= opacity
        weights += opacity
        seen += part[0]
        passing += part[1]
    seen /= count**2
    passing[:, :2] /= count**2
    passing[:, 2] /= np.maximum(weights, np.float32(1e-9))


def _spread(directions: Array, pixel: float, count: int) -> Iterator[Array]:
    """Yield directions within pixels whose sides have this angle."""
    # Any two vectors across a ray will do; that to the axis it is farthest from is not along it.
    axis = np.eye(3)[np.abs(directions).argmin(axis=1)]
    right = np.cross(directions, axis)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    up = np.cross(right, directions)
    offsets = pixel * ((np.arange(count) + 0.5) / count - 0.5)
    for across in offsets:
        for along in offsets:
            ray = directions + across * right + along * up
            yield ray / np.linalg.norm(ray, axis=1, keepdims=True)
