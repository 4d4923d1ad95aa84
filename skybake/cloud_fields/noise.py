"""Periodic noise: billows that displace surfaces, and random maps and volumes of given scales."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel

BILLOW_SIZE = 64
"""Voxels along each side of the volume of billows."""

_CELLS = (4, 8, 16)
_GAIN = 0.55


def billows(seed: int) -> npt.NDArray[np.int8]:
    """Return bulges with creases between them: octaves of inverted Worley noise.

    Returns
    -------
    ndarray of int8, shape (z, y, x)
        Of zero mean, from -127 to 127, periodic along all axes.
    """
    rng = np.random.default_rng([seed, 1])
    total = np.zeros((BILLOW_SIZE,) * 3, np.float32)
    for octave, cells in enumerate(_CELLS):
        points = rng.random((cells, cells, cells, 3))
        _subtract_nearest(total, points, _GAIN**octave)
    total -= total.mean()
    return np.asarray(np.rint(total * (127.0 / np.abs(total).max())), np.int8)


def random_map(
    shape: tuple[int, int],
    extent: tuple[float, float],
    slope: float,
    scales: tuple[float, float],
    seed: tuple[int, int],
) -> npt.NDArray[np.float64]:
    """Return a periodic Gaussian random map.

    Parameters
    ----------
    shape : tuple of int
        Samples along y and x.
    extent : tuple of float
        Period along y and x. [km]
    slope : float
        Power per octave goes with wave number to the power of 1 + slope: -5/3 of turbulence.
    scales : tuple of float
        Shortest and longest length that has power. [km]
    seed : tuple of int
        Of the layer, and of this map within it.

    Returns
    -------
    ndarray of float64, shape (y, x)
        Of zero mean and unit variance.
    """
    (rows, columns), (height, width) = shape, extent
    kx = np.fft.rfftfreq(columns, width / columns)
    ky = np.fft.fftfreq(rows, height / rows)[:, None]
    return _shaped(np.hypot(kx, ky), 2, slope, scales, seed, shape)


def random_volume(
    size: int, period: float, slope: float, scales: tuple[float, float], seed: tuple[int, int]
) -> npt.NDArray[np.float64]:
    """Return a periodic Gaussian random volume of `size` samples along each axis.

    The other parameters are those of `random_map`.
    """
    k = np.fft.fftfreq(size, period / size)
    kx = np.fft.rfftfreq(size, period / size)
    waves = np.sqrt(k[:, None, None] ** 2 + k[:, None] ** 2 + kx**2)
    return _shaped(waves, 3, slope, scales, seed, (size, size, size))


def _shaped(
    waves: npt.NDArray[np.float64],
    dimensions: int,
    slope: float,
    scales: tuple[float, float],
    seed: tuple[int, int],
    shape: tuple[int, ...],
) -> npt.NDArray[np.float64]:
    """Give white noise a spectrum of power laws between two scales."""
    shortest, longest = scales
    waves = np.maximum(waves, 1e-9)
    amplitude = waves ** ((slope - dimensions + 1.0) / 2.0)
    amplitude *= np.exp(-((waves * shortest) ** 2)) / np.sqrt(1.0 + (waves * longest) ** -4.0)
    amplitude.flat[0] = 0.0
    white = np.random.default_rng(seed).standard_normal(shape)
    values = np.fft.irfftn(np.fft.rfftn(white) * amplitude, shape, tuple(range(len(shape))))
    return np.asarray((values - values.mean()) / values.std(), np.float64)


@kernel
def _subtract_nearest(total, points, weight):
    """Subtract the distance in cells to the nearest of one point a cell."""
    size, cells = total.shape[0], points.shape[0]
    scale = cells / size
    for k in range(size):
        z = (k + 0.5) * scale
        for j in range(size):
            y = (j + 0.5) * scale
            for i in range(size):
                x = (i + 0.5) * scale
                nearest = 9.0
                for dk in range(-1, 2):
                    for dj in range(-1, 2):
                        for di in range(-1, 2):
                            a, b, c = int(z) + dk, int(y) + dj, int(x) + di
                            point = points[a % cells, b % cells, c % cells]
                            dz, dy, dx = a + point[0] - z, b + point[1] - y, c + point[2] - x
                            nearest = min(nearest, dx * dx + dy * dy + dz * dz)
                total[k, j, i] -= weight * math.sqrt(nearest)
