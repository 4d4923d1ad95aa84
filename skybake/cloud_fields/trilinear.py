"""Interpolation in volumes that repeat along all axes."""

from __future__ import annotations

from skybake.jit.kernel import kernel


@kernel
def between_nodes(volume, x, y, z):
    """Trilinear value of a cube whose edge is a power of two, at 0 or more along each axis."""
    mask = volume.shape[0] - 1
    k, j, i = int(z), int(y), int(x)
    u, v, w = x - i, y - j, z - k
    i, j, k = i & mask, j & mask, k & mask
    east, north, up = (i + 1) & mask, (j + 1) & mask, (k + 1) & mask
    a = volume[k, j, i] + u * (volume[k, j, east] - volume[k, j, i])
    b = volume[k, north, i] + u * (volume[k, north, east] - volume[k, north, i])
    c = volume[up, j, i] + u * (volume[up, j, east] - volume[up, j, i])
    d = volume[up, north, i] + u * (volume[up, north, east] - volume[up, north, i])
    a += v * (b - a)
    c += v * (d - c)
    return a + w * (c - a)
