"""Where rays may step over a field of a surface, and how far."""

from __future__ import annotations

import math

import numpy as np

from skybake.cloud_fields.clearance import block_clearance, blocks_of
from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.surface import STEP
from skybake.jit.kernel import kernel

_NODES_PER_BLOCK = (3, 6, 6)


def with_clearance(field: CloudField) -> CloudField:
    """Return a field with the blocks that no displacement and no blur carries its surface into."""
    blurs = field.largest_blur * np.linspace(0.0, 1.0, 4 * len(field.shift) - 3) ** 2
    amplitudes, waves = field.displacement[:, 0], field.displacement[:, 5]
    noise = np.maximum(amplitudes * (1.0 - 4.0 * blurs[:, None] * waves), 0.0).sum(1)
    reaches = noise + 0.5 * np.minimum(field.edge + blurs, field.widest_edge)
    # Between these blurs the reach bends; a step of the noise covers what it may differ by.
    between = float(np.abs(np.diff(noise)).max(initial=0.0))
    reach = float(reaches.max()) + between
    nearest = float(reaches.min()) - between + float(field.shift.min())
    steepness = _steepness(field.distance, field.spacing, nearest / STEP)
    cloudy = field.distance < (reach + float(field.shift.max())) / STEP
    for axis in range(3):
        turned = np.roll(cloudy, -1, axis)
        cloudy = cloudy | turned
    cloudy = cloudy[:-1]
    bottom = field.condensation - reach
    heights = field.base + np.arange(1, len(cloudy) + 1) * field.spacing[0]
    cloudy &= (heights > bottom)[:, None, None]
    mask, block = blocks_of(cloudy, field.spacing, _NODES_PER_BLOCK)
    return field._replace(clearance=block_clearance(mask, block), block=block, steepness=steepness)


@kernel
def _steepness(distance, spacing, nearest):
    """Largest gradient where trilinear values are above `nearest`, at least 1."""
    levels, rows, columns = distance.shape
    dz, dy, dx = spacing[0] / STEP, spacing[1] / STEP, spacing[2] / STEP
    largest = 1.0
    for k in range(levels - 1):
        for j in range(rows):
            north = j + 1 if j + 1 < rows else 0
            for i in range(columns):
                east = i + 1 if i + 1 < columns else 0
                a, b = float(distance[k, j, i]), float(distance[k, j, east])
                c, d = float(distance[k, north, i]), float(distance[k, north, east])
                e, f = float(distance[k + 1, j, i]), float(distance[k + 1, j, east])
                g, h = float(distance[k + 1, north, i]), float(distance[k + 1, north, east])
                if max(a, b, c, d, e, f, g, h) <= nearest:
                    continue
                x = max(abs(b - a), abs(d - c), abs(f - e), abs(h - g)) / dx
                y = max(abs(c - a), abs(d - b), abs(g - e), abs(h - f)) / dy
                z = max(abs(e - a), abs(f - b), abs(g - c), abs(h - d)) / dz
                largest = max(largest, x * x + y * y + z * z)
    return math.sqrt(largest)
