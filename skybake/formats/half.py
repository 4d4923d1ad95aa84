"""Conversion to half floats, by compiled code: OpenImageIO's takes as long as a map's sky."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, Workers

_SIGN = np.int32(-(2**31))
_MAGNITUDE = np.int32(2**31 - 1)
_SMALLEST_NORMAL = np.int32((127 - 14) << 23)
_REBIAS = np.int32((15 - 127) << 23)


def half_rows(
    rows: npt.NDArray[np.float32], workers: Workers = ALL_CPUS
) -> tuple[npt.NDArray[np.float16], float]:
    """Round to the nearest half floats, ties to even.

    Parameters
    ----------
    rows : ndarray of float32, shape (row, column, channel)
        Values of magnitude 65520 or more, and NaN, give undefined halves.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray of float16
        The halves.
    float
        The largest magnitude among `rows`; NaN if one of them is.
    """
    rows = np.ascontiguousarray(rows)
    out = np.empty(rows.shape, np.float16)
    flat = len(rows), math.prod(rows.shape[1:])
    values, halves = rows.reshape(flat), out.view(np.int16).reshape(flat)
    bits = values.view(np.int32)

    largest = [0]

    def work(first: int, last: int) -> None:
        largest.append(fill_halves(values[first:last], bits[first:last], halves[first:last]))

    workers.run_rows(len(rows), work, chunk=32)
    return out, float(np.int32(max(largest)).view(np.float32))


@kernel
def fill_halves(values, bits, out):
    """Write the bits of halves, given floats and their bits; returns the largest magnitude's."""
    largest = np.int32(0)
    for i in range(out.shape[0]):
        value, bit, half = values[i], bits[i], out[i]
        for j in range(half.size):
            magnitude = bit[j] & _MAGNITUDE
            largest = max(largest, magnitude)
            # Half the last place that stays, less one unless that place is odd.
            odd = (magnitude >> np.int32(13)) & np.int32(1)
            normal = (magnitude + _REBIAS + np.int32(4095) + odd) >> np.int32(13)
            # Below the normal halves the place that stays is always 2^-24.
            steps = abs(value[j]) * np.float32(2.0**24)
            whole = np.int32(min(steps, np.float32(1024.0)))
            rest = steps - np.float32(whole)
            is_odd = (whole & np.int32(1)) == np.int32(1)
            up = rest > np.float32(0.5) or (rest == np.float32(0.5) and is_odd)
            small = whole + np.int32(1) if up else whole
            kept = small if magnitude < _SMALLEST_NORMAL else normal
            half[j] = np.int16(kept | ((bit[j] & _SIGN) >> np.int32(16)))
    return np.int64(largest)
