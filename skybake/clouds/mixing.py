"""Acceleration of passes over one large state, of which few copies are kept."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
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
        self._row = np.zeros(MEMORY)
        self._steps = 0

    def step(self, state: Floats, image: Floats) -> None:
        """Write the next state to `state`; both are flat, and `image` is what a pass made of it."""
        known = min(self._steps, MEMORY)
        newest = (self._steps - 1) % MEMORY
        right, weights = np.zeros(MEMORY), np.zeros(MEMORY)
        _note(state, image, self._residual, self._image, self._changes, self._moves, newest, known)
        if known:
            _multiply(self._changes, newest, self._residual, known, self._row, right)
            self._products[newest, :known] = self._products[:known, newest] = self._row[:known]
            products = self._products[:known, :known]
            # Nearly parallel residuals leave the weights undetermined; this keeps them small.
            least = 1e-10 * np.trace(products) + 1e-36
            weights[:known] = np.linalg.solve(products + least * np.eye(known), right[:known])
        _mix(image, self._moves, weights, known, state)
        self._steps += 1


@kernel
def _note(state, image, residual, image_before, changes, moves, newest, known):
    """Keep a pass, and by what it differs from the one before."""
    for i in range(state.size):
        value = image[i] - state[i]
        if known > 0:
            changes[newest, i] = value - residual[i]
            moves[newest, i] = image[i] - image_before[i]
        residual[i] = value
        image_before[i] = image[i]


@kernel
def _multiply(changes, newest, residual, known, row, right):
    """Products of all changes with the newest, and with the residual."""
    last = changes[newest]
    for q in range(known):
        change = changes[q]
        with_last = with_residual = 0.0
        for i in range(residual.size):
            with_last += float(change[i]) * last[i]
            with_residual += float(change[i]) * residual[i]
        row[q] = with_last
        right[q] = with_residual


@kernel
def _mix(image, moves, weights, known, state):
    for i in range(state.size):
        state[i] = image[i]
    for q in range(known):
        weight, move = np.float32(weights[q]), moves[q]
        for i in range(state.size):
            state[i] -= weight * move[i]
