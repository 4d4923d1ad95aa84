"""Acceleration of passes over one large state, of which few copies are kept."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

MEMORY = 5
"""Passes that are mixed with the last."""


class Mixing:
    """Anderson's mixing of the last passes, in place.

    Parameters
    ----------
    size : int
        Numbers in a state.

    Notes
    -----
    `skybake.scattering.anderson.Anderson` mixes several systems at once, and keeps their states;
    this keeps differences of one, so that each pass writes two of them and reads all once.

    References
    ----------
    H. F. Walker and P. Ni, SIAM J. Numer. Anal. 49, 2011, algorithm AA in the difference form.
    """

    def __init__(self, size: int) -> None:
        self._changes = np.empty((MEMORY, size), np.float32)
        self._moves = np.empty((MEMORY, size), np.float32)
        self._residual = np.empty(size, np.float32)
        self._image = np.empty(size, np.float32)
        self._products: Array = np.zeros((MEMORY, MEMORY))
        self._steps = 0

    def step(self, state: Floats, image: Floats) -> None:
        """Write the next state to `state`; both are flat, and `image` is what a pass made of it."""
        residual = image - state
        known = min(self._steps, MEMORY)
        if known == 0:
            state[...] = image
        else:
            newest = (self._steps - 1) % MEMORY
            np.subtract(residual, self._residual, out=self._changes[newest])
            np.subtract(image, self._image, out=self._moves[newest])
            changes, moves = self._changes[:known], self._moves[:known]
            self._products[newest, :known] = changes @ changes[newest]
            self._products[:known, newest] = self._products[newest, :known]
            products = self._products[:known, :known]
            # Nearly parallel residuals leave the weights undetermined; this keeps them small.
            least = 1e-10 * np.trace(products) + 1e-36
            right = (changes @ residual).astype(float)
            weights = np.linalg.solve(products + least * np.eye(known), right)
            np.subtract(image, weights.astype(np.float32) @ moves, out=state)
        self._residual, self._image[...] = residual, image
        self._steps += 1
