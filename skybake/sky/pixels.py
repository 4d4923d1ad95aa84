"""Evaluation of a sky's table at the pixels of a map."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array
from skybake.sky.interpolation import azimuth_count, azimuth_weights, fill_latitude
from skybake.sky.table import FoldedTable


@kernel
def _fill_places(folded, middle, cosine, out):
    """Write pixels' places in the curves of the basis: scattering angles as floating indices."""
    half = np.float32(0.5 * (folded.curves.shape[0] - 1))
    along_squared = math.sin(0.5 * (middle - folded.source_zenith)) ** 2
    sines = math.sin(middle) * math.sin(folded.source_zenith)
    for j in range(out.size):
        # Squared sines of half the angle from the sun and of half of that from its opposite.
        near = min(along_squared + 0.5 * sines * (1.0 - cosine[j]), 1.0)
        far = 1.0 - near
        x = half * np.sqrt(np.sqrt(np.float32(2.0 * max(min(near, far), 0.0))))
        out[j] = x if near < far else half + half - x


@kernel
def _add_pixels(folded, latitude, first, weights, share, place, out):
    """Add `share` of the radiance of pixels to `out`, shape (pixel, 3).

    A pixel is among the rows of `latitude` from its own `first` on, by its four `weights`.
    """
    last = folded.curves.shape[0] - 2
    scale = np.float32(share)
    for j in range(out.shape[0]):
        i = min(int(place[j]), last)
        low, high, u = folded.curves[i], folded.curves[i + 1], place[j] - np.float32(i)
        a, b, c, d = weights[j, 0], weights[j, 1], weights[j, 2], weights[j, 3]
        at = first[j]
        at_a, at_b, at_c, at_d = latitude[at], latitude[at + 1], latitude[at + 2], latitude[at + 3]
        red = green = blue = np.float32(0.0)
        for q in range(low.size):
            curve = low[q] + u * (high[q] - low[q])
            red += curve * (a * at_a[0, q] + b * at_b[0, q] + c * at_c[0, q] + d * at_d[0, q])
            green += curve * (a * at_a[1, q] + b * at_b[1, q] + c * at_c[1, q] + d * at_d[1, q])
            blue += curve * (a * at_a[2, q] + b * at_b[2, q] + c * at_c[2, q] + d * at_d[2, q])
        out[j, 0] += scale * red
        out[j, 1] += scale * green
        out[j, 2] += scale * blue


class PixelScratch(NamedTuple):
    """Work space of `fill_directions`; each thread needs its own.

    Attributes
    ----------
    latitude : ndarray of float32, shape (side, (azimuth + 2) * 3 * curve)
        The table at one zenith angle, above the horizon and below it.
    by_curve : ndarray of float32, shape (side, azimuth + 2, 3, curve)
        The same numbers.
    row, weights : ndarray, shape (side, column) and (side, column, 4)
        Where pixels are between azimuths of the table.
    angle, cosine, place : ndarray, shape (column,)
        Angles from the sun's azimuth, and places of pixels in the curves of the basis.
    theta, share, has_weights : ndarray, shape (side,)
        How a row of pixels is split, and whether it can keep weights for the next.
    four : ndarray of float64, shape (4,)
        Weights of one place.
    """

    latitude: npt.NDArray[np.float32]
    by_curve: npt.NDArray[np.float32]
    row: npt.NDArray[np.int64]
    weights: npt.NDArray[np.float32]
    angle: Array
    cosine: Array
    place: npt.NDArray[np.float32]
    theta: Array
    share: Array
    has_weights: npt.NDArray[np.bool_]
    four: Array


def allocate_pixels(folded: FoldedTable, columns: int) -> PixelScratch:
    """Make the work space for rows of so many pixels."""
    curves = folded.curves.shape[1]
    azimuths = folded.values.shape[2] // (3 * curves)
    latitude = np.empty((2, (azimuths + 2) * 3 * curves), np.float32)
    return PixelScratch(
        latitude=latitude,
        by_curve=latitude.reshape(2, azimuths + 2, 3, curves),
        row=np.empty((2, columns), np.int64),
        weights=np.empty((2, columns, 4), np.float32),
        angle=np.empty(columns),
        cosine=np.empty(columns),
        place=np.empty(columns, np.float32),
        theta=np.empty(2),
        share=np.empty(2),
        has_weights=np.empty(2, np.bool_),
        four=np.empty(4),
    )


@kernel
def fill_directions(folded, zenith, azimuth, footprint, first, last, scratch, out):
    """Evaluate a sky at pixels.

    Parameters
    ----------
    folded : FoldedTable
        The table.
    zenith : ndarray of float64, shape (row, 1) or (row, column)
        Zenith angles of the pixels' centres; one column if a row shares its. [rad]
    azimuth : ndarray of float64, shape (1, column) or (row, column)
        Azimuths relative to the sun; one row if all rows share it. [rad]
    footprint : ndarray of float64, shape (1, 1), (row, 1) or (row, column)
        Extents of the pixels in zenith angle, over which the edges of the planet and of
        its atmosphere are smoothed by the share of the pixel on either side; one column if a row
        shares its zenith angle. [rad]
    first, last : int
        Rows to fill.
    scratch : PixelScratch
        Work space.
    out : ndarray of float32, shape (last - first, column, 3)
        Receives RGB.
    """
    azimuths, columns = azimuth_count(folded), out.shape[1]
    latitude, by_curve = scratch.latitude, scratch.by_curve
    angle, cosine, place = scratch.angle, scratch.cosine, scratch.place
    row, weights = scratch.row, scratch.weights
    theta, share, four = scratch.theta, scratch.share, scratch.four
    has_weights = scratch.has_weights
    has_weights[:] = False
    shares_zenith, shares_azimuth = zenith.shape[1] == 1, azimuth.shape[0] == 1
    keeps_weights = shares_azimuth and folded.zenith_first == 0.0
    is_mirrored = False
    last_row, last_column = footprint.shape[0] - 1, footprint.shape[1] - 1
    for i in range(first, last):
        if i == first or not shares_azimuth:
            mirrors = _fill_angles(azimuth[0 if shares_azimuth else i], angle, cosine)
            is_mirrored = shares_zenith and mirrors
        computed = (columns + 1) // 2 if is_mirrored else columns
        span = computed if shares_zenith else 1
        for begin in range(0, computed, span):
            middle = zenith[i, 0 if shares_zenith else begin]
            height = footprint[min(i, last_row), min(begin, last_column)]
            _split_pixel(folded, middle, height, theta, share)
            for side in range(2):
                if share[side] == 0.0:
                    continue
                if not (keeps_weights and has_weights[side]):
                    has_weights[side] = True
                    kept = 0 if keeps_weights else begin
                    for j in range(kept, computed if keeps_weights else begin + span):
                        row[side, j] = azimuth_weights(
                            folded, theta[side], angle[j], cosine[j], four
                        )
                        for q in range(4):
                            weights[side, j, q] = four[q]
                low = 0 if shares_zenith else row[side, begin]
                high = azimuths + 2 if shares_zenith else low + 4
                fill_latitude(folded, side, theta[side], low, high, four, latitude[side])
            end = begin + span
            _fill_places(folded, middle, cosine[begin:end], place[begin:end])
            pixels = out[i - first, begin:end]
            for j in range(span):
                for k in range(3):
                    pixels[j, k] = 0.0
            for side in range(2):
                if share[side] > 0.0:
                    _add_pixels(
                        folded,
                        by_curve[side],
                        row[side, begin:end],
                        weights[side, begin:end],
                        share[side],
                        place[begin:end],
                        pixels,
                    )
        _mirror(out[i - first], computed)


@kernel
def _fill_angles(azimuth, angle, cosine):
    """Angles from the sun's azimuth, 0 to pi; whether they are the same from right to left."""
    for j in range(angle.size):
        phi = azimuth[j]
        angle[j] = abs(phi - 2.0 * math.pi * math.floor(phi / (2.0 * math.pi) + 0.5))
        cosine[j] = math.cos(angle[j])
    difference = 0.0
    for j in range(angle.size // 2):
        difference = max(difference, abs(angle[j] - angle[angle.size - 1 - j]))
    return difference < 1e-12


@kernel
def _mirror(pixels, computed):
    """Copy the first pixels of a row to the others, in reverse."""
    for j in range(computed, pixels.shape[0]):
        for k in range(3):
            pixels[j, k] = pixels[pixels.shape[0] - 1 - j, k]


@kernel
def _split_pixel(folded, theta, height, middle, share):
    """Shares of a pixel above and below the horizon, and the zenith angle of each's middle."""
    low, high = theta - 0.5 * height, theta + 0.5 * height
    begin = max(low, folded.zenith_first) if folded.zenith_first > 0.0 else low
    end = min(high, folded.zenith_horizon)
    share[0] = max(end - begin, 0.0) / height
    middle[0] = theta if share[0] > 0.999 else 0.5 * (begin + end)
    begin = max(low, folded.zenith_horizon)
    share[1] = max(high - begin, 0.0) / height
    middle[1] = theta if share[1] > 0.999 else 0.5 * (begin + high)


@kernel
def blacken_negative(weights, pixels):
    """Set pixels of a negative luminance to 0.

    Parameters
    ----------
    weights : ndarray of float32, shape (3,)
        Luminance is the product of a pixel's values with these.
    pixels : ndarray of float32, shape (row, column, 3)
        Is changed.
    """
    for i in range(pixels.shape[0]):
        for j in range(pixels.shape[1]):
            here = pixels[i, j]
            if here[0] * weights[0] + here[1] * weights[1] + here[2] * weights[2] < 0.0:
                here[0] = here[1] = here[2] = 0.0
