"""Acceleration of a fixed-point iteration."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from skybake.optics.medium import Array

MEMORY = 3


class Anderson:
    """Anderson's mixing of the last passes, for many unknown vectors at once.

    Parameters
    ----------
    columns : int
        Vectors, each of which is mixed with its own weights.

    References
    ----------
    D. G. Anderson, J. ACM 12, 1965; H. F. Walker and P. Ni, SIAM J. Numer. Anal.
    49, 2011, algorithm AA in the difference form.
    """

    def __init__(self, columns: int) -> None:
        self._columns = columns
        self._states: list[Array] = []
        self._images: list[Array] = []

    def step(self, state: Array, image: Array) -> Array:
        """Next state from a state and its image under one pass, each (column, unknown)."""
        self._states.append(state)
        self._images.append(image)
        if len(self._states) == 1:
            return image
        del self._states[: -MEMORY - 1], self._images[: -MEMORY - 1]
        residuals = [g - x for x, g in zip(self._states, self._images, strict=True)]
        changes = np.stack([b - a for a, b in pairwise(residuals)], axis=1)
        moves = np.stack([b - a for a, b in pairwise(self._images)], axis=1)
        normal = (changes @ changes.transpose(0, 2, 1)).astype(float)
        trace = np.trace(normal, axis1=1, axis2=2)[:, None, None]
        # Nearly parallel residuals leave the weights undetermined; this keeps them small.
        normal = normal + (1e-7 * trace + 1e-36) * np.eye(normal.shape[1])
        right = (changes @ residuals[-1][:, :, None]).astype(float)
        weights = np.linalg.solve(normal, right).astype(image.dtype)
        mixed: Array = image - (moves.transpose(0, 2, 1) @ weights)[:, :, 0]
        return mixed
