"""Kernels that collect the light of one map in the pixels of another.

A pixel is the mean over samples of it, each weighted by its solid angle. Texels that are much
brighter than the rest, such as those of a sun, are cut off at a threshold in this mean. What they
hold beyond it, their excess, is added afterwards to the pixels that see them, all of it whatever
number of samples falls on them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.environment.layout import EQUIRECT, NOWHERE, Layout, direction_at, place_of
from skybake.jit.kernel import kernel

_SMALLEST = 1e-300


class Source(NamedTuple):
    """The map that light comes from.

    Attributes
    ----------
    layout : Layout
        Where its pixels look.
    pixels : ndarray of float32, shape (pixel, 3)
        Of all of its canvases.
    blend : float
        Share of a texel over which neighbours are blended, from 0 for boxes to 1 for linear
        interpolation.
    cosine, sine : float
        Of the angle by which bearings in the other map are increased to be those in this one.
    threshold : float
        Magnitude beyond which texels are bright.
    bright : ndarray of int64, shape (bright,)
        Their indices, in rising order.
    """

    layout: Layout
    pixels: npt.NDArray[np.float32]
    blend: float
    cosine: float
    sine: float
    threshold: float
    bright: npt.NDArray[np.int64]


class Target(NamedTuple):
    """Rows of a chart that collect light.

    Attributes
    ----------
    layout : Layout
        Of the whole map.
    chart : int
        Which of its charts it is.
    first : int
        First one of the rows.
    fineness : int
        Samples across a pixel.
    multiple : int
        Of which all numbers of samples across a pixel are a multiple.
    """

    layout: Layout
    chart: int
    first: int
    fineness: int
    multiple: int


@kernel
def fill_peaks(pixels, peaks):
    """Write the largest magnitude of each pixel's channels."""
    for i in range(pixels.shape[0]):
        peaks[i] = max(abs(pixels[i, 0]), abs(pixels[i, 1]), abs(pixels[i, 2]))


@kernel
def gather(target, source, pixels, touched):
    """Collect all but the excess.

    Parameters
    ----------
    target, source : Target, Source
        Where light is collected, and what it comes from.
    pixels : ndarray of float32, shape (row, column, 3)
        Written.
    touched : ndarray of bool, shape (row, column)
        Written: whether a pixel sees a bright texel.
    """
    for i in range(pixels.shape[0]):
        across = _columns(target, i)
        finer, narrower = 1.0 / target.fineness, 1.0 / across
        for j in range(pixels.shape[1]):
            red, green, blue, total = 0.0, 0.0, 0.0, 0.0
            sees_bright = False
            for down in range(target.fineness):
                for right in range(across):
                    row, column = i + (down + 0.5) * finer, j + (right + 0.5) * narrower
                    x, y, z, weight = _sample(target, source, row, column)
                    total += weight
                    chart, row, column = place_of(source.layout, x, y, z)
                    if chart == NOWHERE:
                        continue
                    if source.blend == 0.0:
                        texel = _texel_at(source.layout, chart, row, column)
                        part, is_bright = _kept(source, texel)
                        red += weight * part * source.pixels[texel, 0]
                        green += weight * part * source.pixels[texel, 1]
                        blue += weight * part * source.pixels[texel, 2]
                        sees_bright |= is_bright
                        continue
                    for corner in range(4):
                        texel, share = _tap(source, chart, row, column, corner)
                        if share == 0.0:
                            continue
                        part, is_bright = _kept(source, texel)
                        red += weight * share * part * source.pixels[texel, 0]
                        green += weight * share * part * source.pixels[texel, 1]
                        blue += weight * share * part * source.pixels[texel, 2]
                        sees_bright |= is_bright
            touched[i, j] = sees_bright
            total = max(total, _SMALLEST)
            pixels[i, j, 0] = red / total
            pixels[i, j, 1] = green / total
            pixels[i, j, 2] = blue / total


@kernel
def receive(target, source, touched, sizes, received):
    """Add up the solid angles in which pixels see each bright texel.

    Parameters
    ----------
    target, source, touched
        As of `gather`.
    sizes : ndarray of float64, shape (row, 1) or (row, column)
        Solid angles of the pixels. [sr]
    received : ndarray of float64, shape (bright,)
        Added to. [sr]
    """
    for i in range(touched.shape[0]):
        across = _columns(target, i)
        for j in range(touched.shape[1]):
            if not touched[i, j]:
                continue
            total = 0.0
            for k in range(target.fineness * across):
                _, _, _, weight = _nth_sample(target, source, i, j, across, k)
                total += weight
            size = sizes[i, min(j, sizes.shape[1] - 1)] / total
            for k in range(target.fineness * across):
                x, y, z, weight = _nth_sample(target, source, i, j, across, k)
                chart, row, column = place_of(source.layout, x, y, z)
                if chart == NOWHERE:
                    continue
                for corner in range(4):
                    texel, share = _tap(source, chart, row, column, corner)
                    found = _find(source.bright, texel) if share > 0.0 else NOWHERE
                    if found != NOWHERE:
                        received[found] += share * weight * size


@kernel
def add_excess(target, source, gains, touched, pixels):
    """Add the excess of bright texels to the pixels that see them.

    Parameters
    ----------
    target, source, touched, pixels
        As of `gather`.
    gains : ndarray of float64, shape (bright,)
        Solid angle of each bright texel, over that in which pixels see it.
    """
    for i in range(pixels.shape[0]):
        across = _columns(target, i)
        for j in range(pixels.shape[1]):
            if not touched[i, j]:
                continue
            red, green, blue, total = 0.0, 0.0, 0.0, 0.0
            for k in range(target.fineness * across):
                x, y, z, weight = _nth_sample(target, source, i, j, across, k)
                total += weight
                chart, row, column = place_of(source.layout, x, y, z)
                if chart == NOWHERE:
                    continue
                for corner in range(4):
                    texel, share = _tap(source, chart, row, column, corner)
                    found = _find(source.bright, texel) if share > 0.0 else NOWHERE
                    if found == NOWHERE:
                        continue
                    kept, _ = _kept(source, texel)
                    part = gains[found] * weight * share * (1.0 - kept)
                    red += part * source.pixels[texel, 0]
                    green += part * source.pixels[texel, 1]
                    blue += part * source.pixels[texel, 2]
            pixels[i, j, 0] += red / total
            pixels[i, j, 1] += green / total
            pixels[i, j, 2] += blue / total


@kernel
def _kept(source, texel):
    """Part of a texel's light that is not excess, and whether it is bright."""
    red, green, blue = source.pixels[texel, 0], source.pixels[texel, 1], source.pixels[texel, 2]
    peak = max(abs(red), abs(green), abs(blue))
    if peak > source.threshold:
        return source.threshold / peak, True
    return 1.0, False


@kernel
def _columns(target, i):
    """Return the samples across the pixels of a row, narrow near the poles of an equirect map."""
    if target.layout.kind[target.chart] != EQUIRECT:
        return target.fineness
    _, _, _, sine = direction_at(target.layout, target.chart, target.first + i + 0.5, 0.0)
    fewest = max(2.0, target.fineness * sine)
    return target.multiple * math.ceil(fewest / target.multiple)


@kernel
def _nth_sample(target, source, i, j, across, k):
    """One of the samples of a pixel, as of `_sample`."""
    row, column = i + (k // across + 0.5) / target.fineness, j + (k % across + 0.5) / across
    return _sample(target, source, row, column)


@kernel
def _sample(target, source, row, column):
    """Direction, in the source's bearings, and density of a place in the rows of a target."""
    x, y, z, density = direction_at(target.layout, target.chart, target.first + row, column)
    turned = z * source.cosine + x * source.sine
    return x * source.cosine - z * source.sine, y, turned, density


@kernel
def _tap(source, chart, row, column, corner):
    """One of the four texels around a place, and its share of what is seen there."""
    top, down = _blended(row, source.blend)
    left, right = _blended(column, source.blend)
    share = (down if corner & 2 else 1.0 - down) * (right if corner & 1 else 1.0 - right)
    if share == 0.0:
        return 0, 0.0
    i, j = top + (corner >> 1), left + (corner & 1)
    rows, columns = source.layout.size[chart, 0], source.layout.size[chart, 1]
    if i < 0 or i >= rows or j < 0 or j >= columns:
        # Beside the chart: whichever texel is there on the sphere.
        x, y, z, _ = direction_at(source.layout, chart, i + 0.5, j + 0.5)
        there, row, column = place_of(source.layout, x, y, z)
        if there == NOWHERE:
            i, j = min(max(i, 0), rows - 1), min(max(j, 0), columns - 1)
        else:
            return _texel_at(source.layout, there, row, column), share
    return _texel_at(source.layout, chart, i + 0.5, j + 0.5), share


@kernel
def _texel_at(layout, chart, row, column):
    """Index of the pixel at a place of a chart; a place on its edge is within."""
    i = min(int(row), layout.size[chart, 0] - 1)
    j = min(int(column), layout.size[chart, 1] - 1)
    return layout.place[chart, 0] + i * layout.place[chart, 1] + j * layout.place[chart, 2]


@kernel
def _blended(place, blend):
    """First one of two texels along a side, and the share of the second."""
    middle = place - 0.5
    first = math.floor(middle)
    along = middle - first
    if blend == 0.0:
        return int(first), 1.0 if along >= 0.5 else 0.0
    return int(first), min(max((along - 0.5) / blend + 0.5, 0.0), 1.0)


@kernel
def _find(bright, texel):
    """Position of a texel among the bright ones; `NOWHERE` if it is none of them."""
    low, high = 0, bright.size
    while low < high:
        middle = (low + high) // 2
        if bright[middle] < texel:
            low = middle + 1
        else:
            high = middle
    return low if low < bright.size and bright[low] == texel else NOWHERE
