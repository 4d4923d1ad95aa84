"""Keeping the linear polarisation of an atmosphere's field in memory and on disk."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from skybake.errors import InputError
from skybake.jit.kept import Kept
from skybake.jit.tables import read_tables, write_tables
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.scattering.atmosphere import atmosphere_key
from skybake.scattering.spin_harmonics import harmonic_count
from skybake.scattering.stokes import Polarisation, polarisation_of
from skybake.scattering.stokes_solver import ORDER, solve_polarisation
from skybake.scattering.tables import Atmosphere

KEPT = 4
"""Polarisations kept in memory."""

_recent: Kept[str, Polarisation] = Kept(KEPT)


def load_polarisation(atmosphere: Atmosphere, workers: Workers = ALL_CPUS) -> Polarisation:
    """Return the polarisation of a field from memory or disk, or solve for it and keep it.

    Parameters
    ----------
    atmosphere : Atmosphere
        The field, and what scatters it.
    workers : Workers, optional
        Who does the work.

    Raises
    ------
    InputError
        If the field was solved for as if light were not polarised, or there is no air.
    """
    if not atmosphere.medium.extinction.any():
        raise InputError("polarisation: world must have something that scatters light, got none")
    if not len(atmosphere.scaled.matrix_moments):
        raise InputError("polarisation: method must be full, the only one that has it")
    medium = atmosphere_key(atmosphere.medium, "polarisation")
    key = hashlib.sha256(f"{medium} {ORDER}".encode()).hexdigest()[:32]
    return _recent.get(key, lambda: _read_or_solve(atmosphere, key, workers))


def _read_or_solve(atmosphere: Atmosphere, key: str, workers: Workers) -> Polarisation:
    arrays = read_tables(key)
    if arrays is not None and _is_polarisation_of(atmosphere, arrays):
        return polarisation_of(atmosphere.scaled, int(arrays["order"]), arrays["moments"])
    polarisation = solve_polarisation(atmosphere, workers)
    order = np.array(polarisation.harmonics.order)
    write_tables(key, {"order": order, "moments": polarisation.moments})
    return polarisation


def _is_polarisation_of(atmosphere: Atmosphere, arrays: dict[str, Any]) -> bool:
    """Whether arrays can be the stored moments of a field, by their names, types and shapes."""
    if set(arrays) != {"order", "moments"} or arrays["order"].shape != ():
        return False
    field, order = atmosphere.field, int(arrays["order"])
    if not 2 <= order <= ORDER:
        return False
    size = 2 * harmonic_count(order) * atmosphere.scaled.mixture.size
    moments = arrays["moments"]
    shape = *field.radiance.shape[:2], size
    return bool(moments.dtype == np.float32) and bool(moments.shape == shape)
