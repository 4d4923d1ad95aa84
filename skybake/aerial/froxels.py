"""The air as a volume of the camera's frustum, as engines have it."""

from __future__ import annotations

import math

import numpy as np

from skybake.aerial.air import Air, look_up, volumes_for
from skybake.aerial.depth import Depths
from skybake.aerial.sight import Lens
from skybake.image.scene import Scene
from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel

COLUMNS, ROWS, SLICES = 160, 90, 64
"""Froxels across, down, and away from the camera."""

AT_ONCE = 16


def air_by_froxels(scene: Scene, lens: Lens, depths: Depths) -> Air:
    """Return the air up to finite distances, interpolated between froxels.

    Parameters are those of `air_before`. Distances of slices grow by a constant factor.
    """
    height, width = depths.values.shape
    shape = min(ROWS, height), min(COLUMNS, width)
    coarse = lens._replace(
        width=lens.width * width / shape[1], height=lens.height * height / shape[0]
    )
    is_seen = np.isfinite(depths.values) & (depths.values > 0.0)
    seen = depths.values[is_seen]
    air = Air(np.zeros((height, width, 3), np.float32), np.ones((height, width, 3), np.float32))
    if not seen.size:
        return air
    nearest, farthest = float(seen.min()), float(seen.max())
    step = max(math.log(farthest / nearest), 1e-6) / (SLICES - 1)
    distances = nearest * np.exp(step * np.arange(SLICES))
    even = [depths._replace(values=np.full(shape, each, np.float32)) for each in distances]
    lights = volumes_for(scene, coarse, [even[0], even[-1]])
    slices = [look_up(coarse, lights, each) for each in even]
    light = np.stack([each.light for each in slices])
    passing = np.stack([each.passing for each in slices])
    given = [flatten(each) for each in (depths.values, light, passing, *air)]

    def work(first: int, last: int) -> None:
        interpolate(*given, nearest, step, first, last)

    scene.workers.run_rows(height, work, chunk=AT_ONCE)
    return air


@kernel
def interpolate(depth, light, passing, out_light, out_passing, nearest, step, first, last):
    """Interpolate between the middles of froxels, linearly in all three directions."""
    height, width = depth.shape
    slices, rows, columns, _ = light.shape
    for i in range(first, last):
        y = min(max((i + 0.5) / height * rows - 0.5, 0.0), rows - 1.0)
        row = min(int(y), max(rows - 2, 0))
        below = min(row + 1, rows - 1)
        for j in range(width):
            distance = depth[i, j]
            if not 0.0 < distance < math.inf:
                continue
            x = min(max((j + 0.5) / width * columns - 0.5, 0.0), columns - 1.0)
            column = min(int(x), max(columns - 2, 0))
            right = min(column + 1, columns - 1)
            z = min(max(math.log(distance / nearest) / step, 0.0), slices - 1.0)
            end = min(int(z), slices - 2)
            u, v, w = x - column, y - row, z - end
            for c in range(3):
                seen = kept = 0.0
                for s in range(2):
                    share = w if s == 1 else 1.0 - w
                    a = (1.0 - u) * (1.0 - v) * share
                    b = u * (1.0 - v) * share
                    d = (1.0 - u) * v * share
                    e = u * v * share
                    k = end + s
                    seen += a * light[k, row, column, c] + b * light[k, row, right, c]
                    seen += d * light[k, below, column, c] + e * light[k, below, right, c]
                    kept += a * passing[k, row, column, c] + b * passing[k, row, right, c]
                    kept += d * passing[k, below, column, c] + e * passing[k, below, right, c]
                out_light[i, j, c] = seen
                out_passing[i, j, c] = kept
