"""The light of the air over directions and distances, as a volume that pixels interpolate in."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.aerial.sight import Eye, reach
from skybake.angles import cosine_between
from skybake.optics.medium import Array
from skybake.optics.phase_basis import PhaseBasis
from skybake.scattering.segments import MAX_DISTANCES, SHORTEST, trace_segments
from skybake.sky.skylight import Skylight
from skybake.sky.source import Source
from skybake.sky.spectral_table import resample_azimuths
from skybake.sky.table import EDGE, ray_azimuths

Floats = npt.NDArray[np.float32]

ANGLE_STEP = 0.02
"""Between nodes of the root of the angle from the horizon. [rad^½]"""

WAY_STEP = 0.35
"""Between nodes of the logarithm of the way, and `SPREAD` times the share of it."""

SPREAD = 6.0
NEAREST = 1e-9
"""Share of the way below which no nodes are closer."""

CURVE_ERROR = 1e-4
"""Of the root mean square over angles, by which curves may be left out."""

AZIMUTHS = 385
"""So many, from the cosine series of the rays', that pixels are linear between them."""

LANES = 2
TAPS = 4


class Volume(NamedTuple):
    """Light of the air on one side of the horizon.

    Attributes
    ----------
    angle_first, angle_step : float
        Of the nodes of the root of the angle from the horizon. [rad^½]
    way_first, way_step : float
        Of the nodes of `way_coordinate`.
    near : float
        Share of the way at which nodes begin to crowd toward the observer.
    light : ndarray of float32, shape (angle, azimuth, way, 3 * curve)
        Radiance over the way: R, G and B, each with a value for every curve. [km⁻¹]
    dimming : ndarray of float32, shape (angle, way, 3)
        What does not pass, over the way. [km⁻¹]
    curves : ndarray of float32, shape (SCATTERING_ANGLES, curve)
        By which values are multiplied.
    """

    angle_first: float
    angle_step: float
    way_first: float
    way_step: float
    near: float
    light: Floats
    dimming: Floats
    curves: Floats


class Extent(NamedTuple):
    """Part of directions and ways that a volume holds, on one side of the horizon.

    Attributes
    ----------
    angle_first, angle_last : float
        Root of the angle from the horizon. [rad^½]
    way_first, way_last : float
        Share of the way in the air.
    """

    angle_first: float
    angle_last: float
    way_first: float
    way_last: float


def build_volume(
    skylight: Skylight, source: Source, eye: Eye, extent: Extent, weights: Array, *, is_below: bool
) -> Volume:
    """Trace the rays of a volume.

    Parameters
    ----------
    skylight : Skylight
        The observer and the atmosphere.
    source : Source
        The sun.
    eye : Eye
        The same.
    extent : Extent
        What is needed.
    weights : ndarray of float64, shape (wavelength, 3)
        RGB is the radiance per unit irradiance times these.
    is_below : bool
        Below the horizon, rather than above it.
    """
    angle = _nodes(extent.angle_first, extent.angle_last, ANGLE_STEP)
    sign = 1.0 if is_below else -1.0
    zenith = eye.zenith_horizon + sign * np.maximum(angle**2, EDGE)
    zenith = np.clip(zenith, 0.0, math.pi)
    begin, end = np.array([reach.py_func(eye, math.cos(one), is_below) for one in zenith]).T
    if is_below:
        # Above the ground, whose light belongs to what is seen, also once it is rounded.
        end = np.maximum(np.floor(end / SHORTEST) - 1.0, 0.0) * SHORTEST
    in_space = eye.radius > eye.r_top
    near = 0.5 if in_space else max(extent.way_first, NEAREST)
    first, last = (way_coordinate(share, near) for share in extent[2:])
    way = _nodes(first, last, WAY_STEP, most=MAX_DISTANCES)
    share = np.minimum(_way_shares(way, near), 1.0)
    length = np.maximum(end - begin, 0.0)[:, None] * share
    light, passing = _trace(skylight, source, zenith, begin[:, None] + length, weights)
    over = 1.0 / np.maximum(length, SHORTEST)
    values, curves = few_curves(light * over[:, None, :, None, None], skylight.basis)
    flat = values.reshape(1, *values.shape[:2], -1)
    values = resample_azimuths(flat, AZIMUTHS).reshape(len(angle), AZIMUTHS, len(way), -1)
    return Volume(
        angle_first=float(angle[0]),
        angle_step=ANGLE_STEP,
        way_first=float(way[0]),
        way_step=WAY_STEP,
        near=near,
        light=np.ascontiguousarray(values, np.float32),
        dimming=((1.0 - passing) * over[..., None]).astype(np.float32),
        curves=curves,
    )


def way_coordinate(share: float, near: float) -> float:
    """Coordinate in which nodes along the way are equally far apart."""
    return math.log(share + near) + SPREAD * share


def _way_shares(coordinates: Array, near: float) -> Array:
    """Shares of the way at coordinates, by bisection; beyond both ends they go on."""
    low, high = np.zeros(coordinates.shape), np.full(coordinates.shape, 4.0)
    for _ in range(60):
        middle = 0.5 * (low + high)
        is_less = np.log(middle + near) + SPREAD * middle < coordinates
        low, high = np.where(is_less, middle, low), np.where(is_less, high, middle)
    shares: Array = high
    return shares


def _nodes(first: float, last: float, step: float, most: int = 1 << 20) -> Array:
    """Nodes from `first` to `last` or beyond, at least as many as a cubic needs."""
    count = min(max(math.ceil((last - first) / step) + 1, TAPS), most)
    return np.asarray(first + step * np.arange(count), dtype=float)


def _trace(
    skylight: Skylight, source: Source, zenith: Array, ends: Array, weights: Array
) -> tuple[Array, Array]:
    """Light up to `ends`, shape (angle, azimuth, way, 3, curve), and what passes."""
    elevation = source.elevation
    horizon = math.pi - math.asin(min(1.0, skylight.atmosphere.medium.r_bottom / skylight.radius))
    has_aureole = skylight.atmosphere.aureole.source.shape[2] > 0
    count = ray_azimuths(elevation, horizon, has_aureole=has_aureole)
    azimuth = np.linspace(0.0, math.pi, count)
    shape = zenith.size, count
    mu = np.repeat(np.cos(zenith), count)
    nu = cosine_between(
        mu,
        np.repeat(np.sin(zenith), count),
        source.mu,
        math.cos(elevation),
        np.tile(azimuth, zenith.size),
    )
    size = mu.size
    traced = trace_segments(
        skylight.atmosphere,
        np.full(size, skylight.radius),
        mu,
        np.full(size, source.mu),
        np.clip(nu, -1.0, 1.0),
        np.repeat(ends, count, axis=0),
        workers=skylight.workers,
    )
    wavelengths = len(weights)
    fold = np.einsum("cwq,wk->cwkq", skylight.basis.weights, weights)
    values = np.tensordot(traced.single[..., :wavelengths], fold, axes=2)
    values[..., 0] += traced.diffuse[..., :wavelengths] @ weights
    values = values.reshape(*shape, *values.shape[1:])
    passing = traced.transmittance.reshape(*shape, ends.shape[1], -1)[:, 0, :, :wavelengths]
    through: Array = passing @ weights / weights.sum(axis=0)
    return values, through


def few_curves(values: Array, basis: PhaseBasis) -> tuple[Array, Floats]:
    """Replace the curves of a basis by fewer, in which the same functions of the angle are told.

    Parameters
    ----------
    values : ndarray of float64, shape (..., curve)
        By which the curves are multiplied.
    basis : PhaseBasis
        The curves.

    Returns
    -------
    values : ndarray of float64, shape (..., fewer)
    curves : ndarray of float32, shape (SCATTERING_ANGLES, fewer)
        Functions differ by `CURVE_ERROR` of their root mean square, where each angle counts by the
        inverse of what all functions have there.
    """
    rows = values.reshape(-1, len(basis.curves))
    sizes = np.abs(rows).max(axis=1, keepdims=True)
    sample = rows / np.where(sizes > 0.0, sizes, 1.0)
    moment = sample.T @ sample
    at_angles = np.sqrt(np.maximum(np.einsum("qa,qp,pa->a", basis.curves, moment, basis.curves), 0))
    scaled = basis.curves / np.where(at_angles > 0.0, at_angles, 1.0)
    # Principal components of sample @ scaled, by its small Gram matrix.
    values_of, vectors = np.linalg.eigh(scaled @ scaled.T)
    kept = values_of > 1e-14 * values_of[-1]
    root = vectors[:, kept] * np.sqrt(values_of[kept])
    back = vectors[:, kept] / np.sqrt(values_of[kept])
    powers, parts = np.linalg.eigh(root.T @ moment @ root)
    powers, parts = powers[::-1], parts[:, ::-1]
    left = 1.0 - np.cumsum(powers) / powers.sum()
    rank = int(np.argmax(left < CURVE_ERROR**2)) + 1 if (left < CURVE_ERROR**2).any() else len(left)
    rank = min(-(-rank // LANES) * LANES, len(left))
    project, restore = root @ parts[:, :rank], back @ parts[:, :rank]
    curves = (restore.T @ basis.curves).T
    return values @ project, np.ascontiguousarray(curves, np.float32)
