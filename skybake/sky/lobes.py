"""Phase functions as sums of a few curves that all wavelengths share.

The sky table is folded from wavelengths into RGB before its phase functions
are applied per pixel. That is exact if each phase function is a sum of curves
of the scattering angle alone, weighted by wavelength: Rayleigh scattering
needs two, a Henyey-Greenstein lobe with a spectral asymmetry about four.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skybake.optics.medium import Array

TOLERANCE = 1.5e-3
"""Largest error of a phase function at any angle, relative to its mean over wavelengths."""


class Lobes(NamedTuple):
    """Shared curves and the weights that restore each phase function.

    Attributes
    ----------
    curves : ndarray of float64, shape (lobe, SCATTERING_ANGLES)
        The first is 1 everywhere and carries what has no phase function. [sr⁻¹]
    weights : ndarray of float64, shape (constituent, wavelength, lobe)
        ``weights @ curves`` are the phase functions.
    """

    curves: Array
    weights: Array


def split_phase(phase: Array, tolerance: float = TOLERANCE) -> Lobes:
    """Split phase functions into the fewest shared curves.

    Parameters
    ----------
    phase : ndarray of float64, shape (channel, SCATTERING_ANGLES, wavelength)
        Phase functions. [sr⁻¹]
    tolerance : float, optional
        Largest relative error at any angle and wavelength.

    Returns
    -------
    Lobes
        By singular values of each constituent's functions relative to their mean
        over wavelengths, so that the sides count as much as a peak that is a
        thousand times higher.
    """
    curves = [np.ones(phase.shape[1])]
    blocks = []
    for functions in phase:
        scale = functions.mean(axis=1)
        if np.ptp(functions) == 0.0:
            # Isotropic: the constant curve serves it.
            blocks.append((0, functions[:1].T))
            continue
        left, values, right = np.linalg.svd(functions / scale[:, None], full_matrices=False)
        weighted = left * values
        for rank in range(1, values.size + 1):
            error = np.abs(weighted[:, :rank] @ right[:rank] - functions / scale[:, None])
            if (error <= tolerance * (functions / scale[:, None])).all():
                break
        blocks.append((len(curves), right[:rank].T))
        curves.extend((weighted[:, :rank] * scale[:, None]).T)
    weights = np.zeros((phase.shape[0], phase.shape[2], len(curves)))
    for c, (first, block) in enumerate(blocks):
        weights[c, :, first : first + block.shape[1]] = block
    return Lobes(np.stack(curves), weights)
