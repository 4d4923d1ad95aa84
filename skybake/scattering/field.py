"""The diffuse light in the atmosphere: angular moments over altitude and sun angle.

A field of order L holds, at each altitude and solar zenith angle, the real
spherical harmonics of the radiance up to l = L. Order 0 is an isotropic field.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array, Medium, altitude_nodes
from skybake.scattering.harmonics import Harmonics, build_harmonics
from skybake.transport.exponential import fast_exp

ANGLE_BINS = 2048

ORDINARY_DIP = math.radians(5.0)
"""Dip of the horizon at the top of the atmosphere below which twilight is shorter in proportion; of
the presets Jupiter's is the least, 5.2. [rad]"""

STEEP_DIPS = 0.5
"""Depression of the sun, in dips of the horizon, beyond which twilight can end within a node."""

TWILIGHT_SLOPE = 40.0
TWILIGHT_ONSET = math.radians(5.0)
TWILIGHT_END = math.radians(30.0)
"""Depression of the sun at which it is night. Beyond it nodes are so far apart that the decline
from one to the next would magnify the light of a planet whose night is not so dark, one with
an atmosphere as high as its radius, by 1000 with every scattering. [rad]

All three are those of a `twilight_scale` of 1."""


class DiffuseField(NamedTuple):
    """Diffuse radiance per unit irradiance of the sun, as kernels read it.

    Attributes
    ----------
    harmonics : Harmonics
        Recurrence of the harmonics that `radiance` counts.
    altitude : ndarray of float64, shape (altitude,)
        Ascending from 0 to the top. [km]
    layer : ndarray of float64, shape (ALTITUDE_NODES,)
        Table of `altitude_layers`: the number of the node below an altitude, and the
        share of the one above as its fraction.
    sun_angle : ndarray of float64, shape (sun,)
        Solar zenith angles, ascending from 0; cubic between. [rad]
    sun_bin : ndarray of int64, shape (ANGLE_BINS,)
        First of the four nodes around a solar zenith angle, by equal bins of pi.
    sun_factor : ndarray of float64, shape (sun - 3, 4)
        What of `sun_weights` does not depend on the sun, see there.
    twilight : float
        `twilight_scale` of the atmosphere.
    steep_from : float
        `steep_twilight` of the atmosphere. [rad]
    source : ndarray of float64, shape (constituent, order + 1, wavelength)
        Scattering coefficient times chi_l at density 1. [km⁻¹]
    polarised : ndarray of float64, shape (constituent, 2, wavelength)
        Scattering coefficient times beta_2 and alpha2_2 at density 1, see
        `skybake.optics.matrix.matrix_moments`; of no constituent in a field without
        polarisation. [km⁻¹]
    radiance : ndarray of float32, shape (altitude, sun, harmonic, wavelength)
        Moments of the radiance scattered or reflected at least once, and after them, if there is
        polarisation, those of `skybake.scattering.polarised`. [sr⁻¹]
    ground : ndarray of float64, shape (sun, wavelength)
        Irradiance of the ground by the sky.
    """

    harmonics: Harmonics
    altitude: Array
    layer: Array
    sun_angle: Array
    sun_bin: npt.NDArray[np.int64]
    sun_factor: Array
    twilight: float
    steep_from: float
    source: Array
    polarised: Array
    radiance: npt.NDArray[np.float32]
    ground: Array


def twilight_scale(medium: Medium) -> float:
    """How long twilight is beside an ordinary one, by the dip of the horizon at the top."""
    return min(1.0, math.acos(medium.r_bottom / medium.r_top) / ORDINARY_DIP)


def steep_twilight(medium: Medium) -> float:
    """Solar zenith angle beyond which light is linear between suns, not cubic; infinite if never.

    The twilight of shallow air can end within a node, and cubics through such an end swing
    below 0.
    """
    if twilight_scale(medium) == 1.0:
        return math.inf
    return 0.5 * math.pi + STEEP_DIPS * math.acos(medium.r_bottom / medium.r_top)


def altitude_layers(medium: Medium, altitude: Array) -> Array:
    """Where the altitudes of `altitude_nodes` are between a field's nodes.

    Light varies along with altitude where a layer between two nodes is thin and
    along with optical depth where it is thick; the share of the upper node is the
    mean of both, weighted 1 to the layer's optical depth.
    """
    fine = altitude_nodes(medium.r_bottom, medium.r_top)
    extinction = medium.density @ medium.extinction.mean(axis=1)
    rise = 0.5 * (extinction[1:] + extinction[:-1]) * np.diff(fine)
    depth = np.concatenate([[0.0], np.cumsum(rise)])
    node_depth = np.interp(altitude, fine, depth)
    low = np.clip(np.searchsorted(altitude, fine, side="right") - 1, 0, altitude.size - 2)
    across = (fine - altitude[low]) / np.maximum(altitude[low + 1] - altitude[low], 1e-300)
    inside = depth - node_depth[low]
    share = (across + inside) / (1.0 + node_depth[low + 1] - node_depth[low])
    layer: Array = low + np.clip(share, 0.0, 1.0)
    return layer


def sun_bins(sun_angle: Array) -> npt.NDArray[np.int64]:
    """Table from equal bins of the solar zenith angle to the first of four nodes.

    It holds for the start of a bin, from where a lookup moves on.
    """
    starts = np.arange(ANGLE_BINS) * (math.pi / ANGLE_BINS)
    interval = np.searchsorted(sun_angle, starts, side="right") - 1
    return np.clip(interval - 1, 0, sun_angle.size - 4)


def sun_factors(sun_angle: Array, twilight: float) -> Array:
    """Denominators of Lagrange's cubics through four nodes, and how dark it is at each.

    Parameters
    ----------
    sun_angle : ndarray of float64, shape (sun,)
        Nodes. [rad]
    twilight : float
        `twilight_scale` of the atmosphere.

    Returns
    -------
    ndarray of float64, shape (sun - 3, 4)
        Inverse of the product of distances to the other three nodes and of
        exp(log_twilight) at the node.
    """
    first = np.arange(sun_angle.size - 3)[:, None]
    nodes = sun_angle[first + np.arange(4)]
    distance = nodes[:, :, None] - nodes[:, None, :] + np.eye(4)
    factor: Array = 1.0 / (
        distance.prod(axis=2) * np.exp(np.vectorize(log_twilight.py_func)(nodes, twilight))
    )
    return factor


def sum_fields(field: DiffuseField, other: DiffuseField, factor: float) -> DiffuseField:
    """Add `factor` times another field on the same nodes."""
    return field._replace(
        radiance=field.radiance + np.float32(factor) * other.radiance,
        ground=field.ground + factor * other.ground,
    )


def lower_order(field: DiffuseField, order: int) -> DiffuseField:
    """Keep the harmonics of a field up to an order."""
    kept = _kept(field, order)
    return field._replace(
        harmonics=build_harmonics(order),
        source=np.ascontiguousarray(field.source[:, : order + 1]),
        radiance=np.ascontiguousarray(field.radiance[:, :, kept]),
    )


def raise_order(solved: DiffuseField, first: DiffuseField, fine: DiffuseField) -> DiffuseField:
    """Add to `fine` what a field of lower order gained over its own first scattering."""
    radiance = fine.radiance.copy()
    kept = _kept(fine, solved.harmonics.order)
    radiance[:, :, kept] += solved.radiance - first.radiance
    return fine._replace(radiance=radiance, ground=fine.ground + solved.ground - first.ground)


def _kept(field: DiffuseField, order: int) -> npt.NDArray[np.bool_]:
    """Moments that are of degrees up to an order, or of polarised light."""
    kept = np.ones(field.radiance.shape[2], np.bool_)
    kept[: field.harmonics.degree.size] = field.harmonics.degree <= order
    return kept


@kernel
def fast_acos(x):
    """Arc cosine within 2e-8 rad (Abramowitz and Stegun 4.4.46), without a library call."""
    a = min(abs(x), 1.0)
    series = 1.5707963050 + a * (
        -0.2145988016
        + a
        * (
            0.0889789874
            + a
            * (
                -0.0501743046
                + a * (0.0308918810 + a * (-0.0170881256 + a * (0.0066700901 - a * 0.0012624911)))
            )
        )
    )
    positive = math.sqrt(1.0 - a) * series
    return positive if x >= 0.0 else math.pi - positive


@kernel
def log_twilight(angle, scale):
    """Logarithm of how dark it is, roughly: 0 by day, falling by 0.7 a degree until night.

    A degree is one of a `twilight_scale` of 1.
    """
    below = min(max((angle - 0.5 * math.pi) / scale, 0.0), TWILIGHT_END)
    onset = min(below, TWILIGHT_ONSET)
    return -TWILIGHT_SLOPE * (onset * onset / (2.0 * TWILIGHT_ONSET) + below - onset)


@kernel
def sun_weights(field, mu_s, out):
    """First node and weights of the four nodes around a sun's position.

    Lagrange's cubic through the values divided by exp(log_twilight), which differ
    little from node to node even where twilight falls by half between them; linear
    beyond `steep_from`.
    """
    angle = min(fast_acos(mu_s), field.sun_angle[-1])
    j = find_suns(field, angle)
    if angle > field.steep_from:
        fill_linear_weights(field, angle, j, out)
    else:
        fill_cubic_weights(field, angle, j, out)
    return j


@kernel
def find_suns(field, angle):
    """First of the four nodes around a solar zenith angle."""
    j = field.sun_bin[min(int(angle * (ANGLE_BINS / math.pi)), ANGLE_BINS - 1)]
    while angle > field.sun_angle[j + 2] and j + 4 < field.sun_angle.size:
        j += 1
    return j


@kernel
def fill_cubic_weights(field, angle, j, out):
    """Write the weights of four nodes from `j` on as of `sun_weights`, but for steep twilight."""
    xa, xb = angle - field.sun_angle[j], angle - field.sun_angle[j + 1]
    xc, xd = angle - field.sun_angle[j + 2], angle - field.sun_angle[j + 3]
    here = fast_exp(log_twilight(angle, field.twilight))
    low, high = here * xa * xb, here * xc * xd
    out[0] = field.sun_factor[j, 0] * xb * high
    out[1] = field.sun_factor[j, 1] * xa * high
    out[2] = field.sun_factor[j, 2] * xd * low
    out[3] = field.sun_factor[j, 3] * xc * low


@kernel
def fill_linear_weights(field, angle, j, out):
    """Write the weights of the two of four nodes that are on either side of a sun's position."""
    out[0] = out[1] = out[2] = out[3] = 0.0
    i = 1 if angle <= field.sun_angle[j + 2] else 2
    low, high = field.sun_angle[j + i], field.sun_angle[j + i + 1]
    share = (angle - low) / (high - low)
    dark = log_twilight(angle, field.twilight)
    out[i] = (1.0 - share) * fast_exp(dark - log_twilight(low, field.twilight))
    out[i + 1] = share * fast_exp(dark - log_twilight(high, field.twilight))


@kernel
def altitude_weight(field, h):
    """Lower node around an altitude and the share of the upper one."""
    last = field.layer.size - 1
    x = math.sqrt(min(max(h / field.altitude[-1], 0.0), 1.0)) * last
    i = min(int(x), last - 1)
    layer = field.layer[i] + (x - i) * (field.layer[i + 1] - field.layer[i])
    low = min(int(layer), field.altitude.size - 2)
    return low, layer - low


@kernel
def fill_ground_irradiance(field, mu_s, weights, out):
    """Write the sky's irradiance of the ground to `out`, shape (wavelength,)."""
    j = sun_weights(field, min(max(mu_s, -1.0), 1.0), weights)
    for k in range(out.size):
        value = 0.0
        for q in range(4):
            value += weights[q] * field.ground[j + q, k]
        out[k] = max(value, 0.0)
