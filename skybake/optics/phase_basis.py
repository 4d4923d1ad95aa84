"""A basis of phase functions: a few curves that all wavelengths share, and sums of them.

The sky table is folded from wavelengths into RGB before its phase functions
are applied per pixel. That is exact if each phase function is a sum of curves
of the scattering angle alone, weighted by wavelength: Rayleigh scattering
needs two, a Henyey-Greenstein lobe with a spectral asymmetry about four.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from skybake.optics.medium import LANES, Array

TOLERANCE = 1.5e-3
"""Largest error of a phase function, relative to the rms of its group at that angle."""


class PhaseBasis(NamedTuple):
    """Shared curves and the weights that restore each phase function.

    Attributes
    ----------
    curves : ndarray of float64, shape (curve, SCATTERING_ANGLES)
        The first is 1 everywhere and carries what has no phase function. [sr⁻¹]
    weights : ndarray of float64, shape (phase function, wavelength, curve)
        ``weights @ curves`` are the phase functions.
    """

    curves: Array
    weights: Array


def build_phase_basis(
    phase: Array, groups: Sequence[Sequence[int]], tolerance: float = TOLERANCE
) -> PhaseBasis:
    """Split phase functions into the fewest shared curves.

    Parameters
    ----------
    phase : ndarray of float64, shape (phase function, SCATTERING_ANGLES, wavelength)
        Phase functions. [sr⁻¹]
    groups : sequence of sequences of int
        Phase functions that are alike, such as those of one constituent; each is in one.
    tolerance : float, optional
        Largest error at any angle and wavelength, relative to the group's rms there.

    Returns
    -------
    PhaseBasis
        By principal components of each group's functions relative to their rms,
        so that the sides count as much as a peak that is a thousand times higher.
    """
    angles, wavelengths = phase.shape[1:]
    curves = [np.ones((1, angles))]
    count = 1
    blocks = []
    for group in groups:
        functions = phase[list(group)].transpose(1, 0, 2).reshape(angles, -1)
        if np.ptp(functions) == 0.0:
            # Isotropic: the constant curve serves it.
            blocks.append((group, 0, functions[:1].T))
            continue
        scale = np.sqrt(np.mean(functions**2, axis=1))[:, None]
        relative = functions / scale
        values, vectors = np.linalg.eigh(relative.T @ relative)
        vectors = vectors[:, np.argsort(values)[::-1]]
        for rank in range(1, values.size + 1):
            kept = vectors[:, :rank]
            if np.abs(relative @ kept @ kept.T - relative).max() <= tolerance:
                break
        curves.append((relative @ kept * scale).T)
        blocks.append((group, count, kept))
        count += rank
    weights = np.zeros((phase.shape[0], wavelengths, count))
    for group, first, kept in blocks:
        block = kept.reshape(len(group), wavelengths, -1)
        weights[list(group), :, first : first + block.shape[2]] = block
    return PhaseBasis(np.concatenate(curves), weights)


def pad_basis(basis: PhaseBasis) -> PhaseBasis:
    """Add curves of zeros until their number is a multiple of `LANES`."""
    missing = -len(basis.curves) % LANES
    return PhaseBasis(
        np.pad(basis.curves, ((0, missing), (0, 0))),
        np.pad(basis.weights, ((0, 0), (0, 0), (0, missing))),
    )
