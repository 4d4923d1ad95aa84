"""The light of a layer as the eye's rays look it up."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import inlined_kernel, kernel
from skybake.optics.medium import Array

FAINTEST = 1e-30
"""Share of the sun's beam that is told from none."""

STEEPEST = 1e4
"""Ratio of the lights of two suns up to which light between them is their geometric mean."""


class LayerLight(NamedTuple):
    """Light in a tile, for one sun or for several heights of it.

    Attributes
    ----------
    beam : ndarray of float32, shape (sun, z, y, x)
        Mean of the sun's beam in each voxel, without forward peaks and as a share of the light
        above the layer.
    moments : ndarray of uint16, shape (sun, z, y, x, channel * harmonic)
        Of the diffuse radiance in each voxel, see `half_words`.
    spacing : ndarray of float64, shape (3,)
        Of voxels along z, y and x. [km]
    base : float
        Altitude of the lowest voxels' lower face. [km]
    sun_mu : ndarray of float64, shape (sun,)
        Cosines of the sun's zenith angle, ascending.
    irradiance : ndarray of float64, shape (sun, z, channel)
        Facing the sun, without clouds, at the altitudes of voxels.
    brightness : ndarray of float64, shape (sun, channel)
        Mean of the diffuse radiance in voxels.
    order : int
        Highest degree of the harmonics.
    fraction : float
        Share of scattered light that counts as not scattered.
    scatter : ndarray of float64, shape (harmonic,)
        (2l + 1) / (4 pi) times the moment of the truncated phase function. [sr⁻¹]
    truncated, peak : ndarray
        Of `Particles`.
    """

    beam: npt.NDArray[np.float32]
    moments: npt.NDArray[np.uint16]
    spacing: Array
    base: float
    sun_mu: Array
    irradiance: Array
    brightness: Array
    order: int
    fraction: float
    scatter: Array
    truncated: Array
    peak: Array


def half_words(values: npt.NDArray[np.float32]) -> npt.NDArray[np.uint16]:
    """Round numbers to the upper halves of their words, which keep 8 binary digits.

    Every ray gathers hundreds of them from memory, and the mean of eight is better than each.
    """
    words = values.view(np.uint32)
    upper: npt.NDArray[np.uint16] = ((words + np.uint32(0x8000)) >> np.uint32(16)).astype(np.uint16)
    return upper


@inlined_kernel
def _single(half_word):
    """Return the number whose upper half is given."""
    return np.int32(np.int32(half_word) << np.int32(16)).view(np.float32)


@kernel
def sun_share(light, mu_s):
    """Place of a sun among those of a layer: its lower neighbour, and the share of the next."""
    suns = light.sun_mu.size
    i = 0
    while i < suns - 2 and mu_s > light.sun_mu[i + 1]:
        i += 1
    if suns == 1:
        return 0.0
    share = (mu_s - light.sun_mu[i]) / (light.sun_mu[i + 1] - light.sun_mu[i])
    return i + min(max(share, 0.0), 1.0 - 1e-9)


@inlined_kernel
def fill_blend(light, place, blend):
    """Write the shares of both suns in light between them, (4, channel).

    Light grows by several times from one sun to the next where they are low, and its logarithm
    evenly. Shares add up to a light whose brightness is the geometric mean of both.

    Parameters
    ----------
    light : LayerLight
        The layer.
    place : float
        Of `sun_share`.
    blend : ndarray of float64, shape (4, channel)
        Receives the shares of the diffuse light of the lower and of the higher sun, and of their
        irradiances.
    """
    first = int(place)
    share = place - first
    middle = light.irradiance.shape[1] // 2
    for c in range(blend.shape[1]):
        if share == 0.0:
            blend[0, c], blend[1, c], blend[2, c], blend[3, c] = 1.0, 0.0, 1.0, 0.0
            continue
        low, high = light.brightness[first, c], light.brightness[first + 1, c]
        blend[0, c], blend[1, c] = _shares(low, high, share)
        low, high = light.irradiance[first, middle, c], light.irradiance[first + 1, middle, c]
        blend[2, c], blend[3, c] = _shares(low, high, share)


@inlined_kernel
def _shares(low, high, share):
    """Return shares of two numbers in their geometric mean, which one tends to at either end."""
    ratio = min(max(high, FAINTEST) / max(low, FAINTEST), STEEPEST)
    ratio = max(ratio, 1.0 / STEEPEST)
    grown = math.exp(share * math.log(ratio))
    return (1.0 - share) * grown, share * grown / ratio


@inlined_kernel
def fill_corners(light, x, y, altitude, corner, weight):
    """Write indices of the eight voxels around a point, (8, 3) as z, y, x, and their weights."""
    _, levels, rows, columns = light.beam.shape
    fz = min(max((altitude - light.base) / light.spacing[0] - 0.5, 0.0), levels - 1.0)
    fy, fx = y / light.spacing[1] - 0.5, x / light.spacing[2] - 0.5
    k = min(int(fz), max(levels - 2, 0))
    j, i = math.floor(fy), math.floor(fx)
    w, v, u = fz - k, fy - j, fx - i
    # A division takes as long as all the rest.
    south, west = int(j) % rows, int(i) % columns
    north = south + 1 if south + 1 < rows else 0
    east = west + 1 if west + 1 < columns else 0
    up = min(k + 1, levels - 1)
    for n in range(8):
        corner[n, 0] = up if n >> 2 else k
        corner[n, 1] = north if (n >> 1) & 1 else south
        corner[n, 2] = east if n & 1 else west
        weight[n] = (w if n >> 2 else 1.0 - w) * (v if (n >> 1) & 1 else 1.0 - v)
        weight[n] *= u if n & 1 else 1.0 - u


@inlined_kernel
def sun_depth(light, place, corner, weight):
    """Optical depth toward the sun between voxels, without forward peaks.

    Beams are interpolated rather than their depths, so that they stay what they are on average
    where shadows begin.
    """
    first = int(place)
    share = place - first
    total = 0.0
    for n in range(8):
        k, j, i = corner[n, 0], corner[n, 1], corner[n, 2]
        value = float(light.beam[first, k, j, i])
        if share > 0.0:
            value += share * (light.beam[first + 1, k, j, i] - value)
        total += weight[n] * value
    return -math.log(max(total, FAINTEST))


@inlined_kernel
def fill_diffuse(light, place, blend, corner, weight, toward, scratch, out):
    """Write the diffuse light that is scattered toward the eye at a point, by channel.

    Parameters
    ----------
    light : LayerLight
        The layer.
    place : float
        Of `sun_share`.
    blend
        Of `fill_blend`.
    corner, weight
        Of `fill_corners`.
    toward : ndarray of float32, shape (harmonic,)
        Harmonics of the direction to the eye times `LayerLight.scatter`.
    scratch : ndarray of float32, shape (channel * harmonic,)
        Work space.
    out : ndarray of float64, shape (channel,)
        Receives radiance per optical depth.
    """
    size = scratch.size
    for q in range(size):
        scratch[q] = 0.0
    first = int(place)
    share = place - first
    harmonics = toward.size
    for sun in range(2 if share > 0.0 else 1):
        for n in range(8):
            if weight[n] == 0.0:
                continue
            voxel = light.moments[first + sun, corner[n, 0], corner[n, 1], corner[n, 2]]
            if share == 0.0:
                scale = np.float32(weight[n])
                for q in range(size):
                    scratch[q] += scale * _single(voxel[q])
                continue
            for c in range(out.size):
                scale = np.float32(weight[n] * blend[sun, c])
                for q in range(c * harmonics, (c + 1) * harmonics):
                    scratch[q] += scale * _single(voxel[q])
    for c in range(out.size):
        total = np.float32(0.0)
        for p in range(harmonics):
            total += toward[p] * scratch[c * harmonics + p]
        out[c] = max(total, np.float32(0.0))
