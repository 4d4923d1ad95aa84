"""Acceleration of a fixed-point iteration."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Array

MEMORY = 5


class Anderson:
    """Anderson's mixing of the last passes, for several independent systems at once.

    Parameters
    ----------
    systems : int
        How many, each of which is mixed with its own weights. Row i of a state belongs to
        system i modulo their number.

    Notes
    -----
    Rows that depend on each other must share weights: with weights of their own, mixed rows are
    not what one pass makes of mixed rows, and the iteration need not converge.

    References
    ----------
    D. G. Anderson, J. ACM 12, 1965; H. F. Walker and P. Ni, SIAM J. Numer. Anal.
    49, 2011, algorithm AA in the difference form.
    """

    def __init__(self, systems: int) -> None:
        self._systems = systems
        self._states: list[npt.NDArray[Any]] = []
        self._images: list[npt.NDArray[Any]] = []

    def step(
        self, state: npt.NDArray[Any], image: npt.NDArray[Any], weight: Array | None = None
    ) -> Array:
        """Next state from a state and its image under one pass, each (row, unknown).

        Parameters
        ----------
        state, image : ndarray, shape (row, unknown)
            A state, and what one pass makes of it.
        weight : ndarray of float64, shape (row,), optional
            What the squared residual of a row counts; all the same if not given.
        """
        self._states.append(state)
        self._images.append(image)
        if len(self._states) == 1:
            return image
        del self._states[: -MEMORY - 1], self._images[: -MEMORY - 1]
        residuals = [g - x for x, g in zip(self._states, self._images, strict=True)]
        changes = np.stack([b - a for a, b in pairwise(residuals)], axis=1)
        moves = np.stack([b - a for a, b in pairwise(self._images)], axis=1)
        normal = self._add_rows(changes @ changes.transpose(0, 2, 1), weight)
        trace = np.trace(normal, axis1=1, axis2=2)[:, None, None]
        # Nearly parallel residuals leave the weights undetermined; this keeps them small.
        normal = normal + (1e-10 * trace + 1e-36) * np.eye(normal.shape[1])
        right = self._add_rows(changes @ residuals[-1][:, :, None], weight)
        weights = np.linalg.solve(normal, right).astype(image.dtype)
        shared = np.tile(weights, (len(image) // self._systems, 1, 1))
        mixed: Array = image - (moves.transpose(0, 2, 1) @ shared)[:, :, 0]
        return mixed

    def _add_rows(self, products: Array, weight: Array | None) -> Array:
        """Sum weighted products of rows over each system."""
        if weight is not None:
            products = products * weight[:, None, None]
        total: Array = products.reshape(-1, self._systems, *products.shape[1:]).sum(
            axis=0, dtype=float
        )
        return total
