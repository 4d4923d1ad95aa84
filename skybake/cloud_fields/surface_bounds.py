"""Where rays may step over a field of a surface, and how far."""

from __future__ import annotations

import numpy as np

from skybake.cloud_fields.clearance import block_clearance, blocks_of
from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.surface import STEP

_NODES_PER_BLOCK = (2, 4, 4)


def with_clearance(field: CloudField) -> CloudField:
    """Return a field with the blocks that no displacement and no blur carries its surface into."""
    blurs = field.largest_blur * np.linspace(0.0, 1.0, 4 * len(field.shift) - 3) ** 2
    amplitudes, waves = field.displacement[:, 0], field.displacement[:, 5]
    noise = np.maximum(amplitudes * (1.0 - 4.0 * blurs[:, None] * waves), 0.0).sum(1)
    reaches = noise + 0.5 * np.minimum(field.edge + blurs, field.widest_edge)
    # Between these blurs the reach bends; a step of the noise covers what it may differ by.
    between = float(np.abs(np.diff(noise)).max(initial=0.0))
    reach = float(reaches.max()) + between
    cloudy = field.distance < (reach + float(field.shift.max())) / STEP
    for axis in range(3):
        turned = np.roll(cloudy, -1, axis)
        cloudy = cloudy | turned
    cloudy = cloudy[:-1]
    bottom = field.condensation - reach
    heights = field.base + np.arange(1, len(cloudy) + 1) * field.spacing[0]
    cloudy &= (heights > bottom)[:, None, None]
    mask, block = blocks_of(cloudy, field.spacing, _NODES_PER_BLOCK)
    return field._replace(clearance=block_clearance(mask, block), block=block)
