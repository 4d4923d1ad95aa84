"""Clouds and the air before, between and behind them, as one picture."""

from __future__ import annotations

import math

from skybake.clouds.airlight import CROWDING, TINY
from skybake.jit.kernel import kernel


@kernel
def compose(total, row, weight, distance, lit, through, seen, passing, first, last, out, opacity):
    """Put clouds of several layers into the light of the air.

    Parameters
    ----------
    total : ndarray of float32, shape (ray, channel)
        Light without clouds.
    row, weight : ndarray, shape (ray, 4)
        Nodes between which each ray is.
    distance : ndarray of float64, shape (node, stretch + 1)
        [km]
    lit, through : ndarray of float32
        Of `fill_lit` at the nodes.
    seen : ndarray of float32, shape (layer, ray, channel)
        Radiance of each layer, see `fill_march`.
    passing : ndarray of float32, shape (layer, ray, 3)
        What passes of what is behind, what of a sharp image, and the mean distance.
    first, last : int
        Rays to do.
    out : ndarray of float32, shape (ray, channel)
        Receives the light.
    opacity : ndarray of float32, shape (ray,)
        Receives the share of what is behind that clouds hide.
    """
    layers, _, channels = seen.shape
    stretches = distance.shape[1] - 1
    for n in range(first, last):
        for c in range(channels):
            out[n, c] = 0.0
        begin = end = 0.0
        for p in range(4):
            begin += weight[n, p] * distance[row[n, p], 0]
            end += weight[n, p] * distance[row[n, p], stretches]
        passes, done = 1.0, -1.0
        place_before = -1.0
        for _ in range(layers + 1):
            nearest, layer = next_layer(passing[:, n], done, math.inf)
            place = stretches + 1.0
            if layer >= 0:
                place = place_along(nearest, begin, end, stretches)
            for c in range(channels):
                gained = at_place(lit, row[n], weight[n], place, c)
                if place_before >= 0.0:
                    gained -= at_place(lit, row[n], weight[n], place_before, c)
                out[n, c] += passes * max(total[n, c], TINY) * gained
                if layer >= 0:
                    air = at_place(through, row[n], weight[n], place, c)
                    out[n, c] += passes * air * seen[layer, n, c]
            if layer < 0:
                break
            passes *= passing[layer, n, 0]
            done, place_before = nearest, place
        opacity[n] = 1.0 - passes


@kernel
def next_layer(passing, done, limit):
    """Distance and number of the layer that is seen next behind a distance; inf and -1 for none.

    Layers at one distance are taken one after the other.
    """
    nearest, layer = math.inf, -1
    for k in range(passing.shape[0]):
        d = passing[k, 2] + 1e-9 * k
        if passing[k, 0] < 1.0 and done < d < min(nearest, limit):
            nearest, layer = d, k
    return nearest, layer


@kernel
def place_along(distance, begin, end, stretches):
    """Where a distance is among those of a ray's stretches, from 0 to their number."""
    share = (distance - begin) / max(end - begin, 1e-9)
    return min(max(share, 0.0), 1.0) ** (1.0 / CROWDING) * stretches


@kernel
def at_place(values, row, weight, place, channel):
    """Interpolate between nodes, and along their stretches."""
    q = min(int(place), values.shape[1] - 2)
    u = place - q
    total = 0.0
    for p in range(4):
        if weight[p] != 0.0:
            low, high = values[row[p], q, channel], values[row[p], q + 1, channel]
            total += weight[p] * (low + u * (high - low))
    return total
