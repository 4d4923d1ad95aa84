"""The table of the split sum's other half: how much a rough mirror of any colour reflects.

References
----------
B. Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course (scale and bias of F0).
E. Heitz, "Understanding the Masking-Shadowing Function", JCGT 2014 (height-correlated Smith).
R. Guy and M. Agopian, "Physically Based Rendering in Filament" (the multiscatter form).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.ibl.kernels import fill_dfg
from skybake.jit.workers import ALL_CPUS, Workers

RINGS = 64
SPOKES = 32


def dfg_table(
    edge: int, *, multiscatter: bool = False, workers: Workers = ALL_CPUS
) -> npt.NDArray[np.float32]:
    """Return the table for white light from all around.

    Parameters
    ----------
    edge : int
        Width and height. [pixel]
    multiscatter : bool, optional
        Return (bias, scale + bias) instead of (scale, bias), with which shaders make up for what
        is reflected more than once: ``mix(dfg.x, dfg.y, F0)``.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray of float32, shape (edge, edge, 2)
        By perceptual roughness (row) and cosine of the view's angle from the normal (column),
        both at (i + 1/2) / edge: scale and bias by which ``F0 * scale + bias`` is reflected by
        GGX with height-correlated Smith shadowing and Schlick's Fresnel term.
    """
    ring = (np.arange(RINGS) + 0.5) / RINGS
    # The other half of the turn is its mirror image.
    spoke = np.cos(np.pi * (np.arange(SPOKES) + 0.5) / SPOKES)
    table = np.empty((edge, edge, 2), np.float32)

    def work(first: int, last: int) -> None:
        fill_dfg(first, ring, spoke, table[first:last])

    workers.run_rows(edge, work, chunk=max(1, edge // 16))
    if multiscatter:
        table = np.stack([table[..., 1], table[..., 0] + table[..., 1]], axis=-1)
    return table
