"""Building the tables of an atmosphere, and keeping them in memory and on disk."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from skybake.jit.kept import Kept
from skybake.jit.tables import (
    arrays_from_content,
    content_from_arrays,
    has_tables,
    read_tables,
    write_tables,
)
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import ScaledMedium, keep_unscaled, phase_groups, scale_medium
from skybake.optics.medium import Medium, pad_wavelengths
from skybake.optics.phase_basis import PhaseBasis, build_phase_basis
from skybake.scattering.aureole import Aureole, no_aureole
from skybake.scattering.closure import close_field
from skybake.scattering.field import (
    DiffuseField,
    altitude_layers,
    steep_twilight,
    sun_bins,
    sun_factors,
    twilight_scale,
)
from skybake.scattering.grid import ORDER, no_field, polarised_source
from skybake.scattering.harmonics import build_harmonics
from skybake.scattering.horizon_peaks import HorizonPeaks, no_horizon_peaks
from skybake.scattering.solver import solve_light
from skybake.scattering.table_shapes import are_tables_of
from skybake.scattering.tables import Atmosphere
from skybake.scattering.transmittance import build_columns
from skybake.transport.shells import altitude_shells

SCALAR = "scalar"
"""Method of all orders of scattering as if light were not polarised."""

KEPT = 4
"""Atmospheres kept in memory; the maps of a sequence share one, or each has its own."""

_DELTA_M = tuple(name for name in ScaledMedium._fields if name != "medium")


def build_atmosphere(medium: Medium, method: str, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Build the tables of a medium.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    method : {"full", "scalar", "hillaire"}
        All orders of scattering with polarised light, or as if light were not polarised, or
        Hillaire's closure.
    workers : Workers, optional
        Threads that do the work.

    Raises
    ------
    UnsolvableError
        If all orders were asked for, and the atmosphere is too thick or its peaks too strong.
    """
    dark = dark_atmosphere(medium, method, workers)
    if method != "hillaire":
        return solve_light(dark, workers)
    return dark._replace(field=close_field(dark, workers))


def dark_atmosphere(medium: Medium, method: str, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Build all tables except the diffuse field, which is left without light.

    Parameters are those of `build_atmosphere`.
    """
    padded = pad_wavelengths(medium)
    if method == SCALAR:
        padded = padded._replace(matrix=padded.matrix[:0])
    scaled = keep_unscaled(padded) if method == "hillaire" else scale_medium(padded, ORDER)
    return Atmosphere(
        medium=medium,
        scaled=scaled,
        shells=altitude_shells(medium),
        columns=build_columns(padded, workers=workers),
        field=no_field(scaled),
        aureole=no_aureole(scaled),
        horizon_peaks=no_horizon_peaks(scaled),
        basis=build_phase_basis(
            scaled.phase[..., : medium.ground_albedo.size], phase_groups(scaled)
        ),
    )


_recent: Kept[str, Atmosphere] = Kept(KEPT)


def load_atmosphere(medium: Medium, method: str, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Return the tables of a medium from memory or disk, or build and keep them.

    A file that is missing, or is not bit for bit what was written under its name, or
    whose arrays have other shapes than the medium asks for, is made anew;
    where none can be written the tables are built by every process.
    """
    key = atmosphere_key(medium, method)
    return _recent.get(key, lambda: _read_or_build(medium, method, key, workers))


def _read_or_build(medium: Medium, method: str, key: str, workers: Workers) -> Atmosphere:
    arrays = read_tables(key)
    if arrays is not None and are_tables_of(medium, arrays):
        return _from_arrays(medium, arrays)
    atmosphere = build_atmosphere(medium, method, workers)
    write_tables(key, _to_arrays(atmosphere))
    return atmosphere


def atmosphere_content(medium: Medium, method: str) -> bytes:
    """Return the tables of a medium as a file holds them, for another machine."""
    arrays = _to_arrays(load_atmosphere(medium, method))
    return content_from_arrays(atmosphere_key(medium, method), arrays)


def adopt_atmosphere(medium: Medium, method: str, content: bytes) -> None:
    """Keep tables in memory that another machine has built, see `atmosphere_content`.

    Content that is damaged is ignored: the tables are then built here.
    """
    key = atmosphere_key(medium, method)
    arrays = None if _recent.has(key) else arrays_from_content(key, content)
    if arrays is None or not are_tables_of(medium, arrays):
        return
    _recent.put(key, _from_arrays(medium, arrays))


def forget_atmospheres() -> None:
    """Free the memory that tables take; they stay on disk."""
    _recent.clear()


def is_stored(medium: Medium, method: str) -> bool:
    """Whether `load_atmosphere` would find a file."""
    return has_tables(atmosphere_key(medium, method))


def atmosphere_key(medium: Medium, method: str) -> str:
    """Name of a medium's tables: a digest of everything that they depend on but the code."""
    digest = hashlib.sha256(f"{method} {medium.r_bottom!r} {medium.r_top!r}".encode())
    for array in (value for value in medium if isinstance(value, np.ndarray)):
        digest.update(f"{array.shape}".encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:32]


def _to_arrays(atmosphere: Atmosphere) -> dict[str, Any]:
    scaled, field = atmosphere.scaled, atmosphere.field
    arrays = {
        f"delta_m_{name}": getattr(scaled, name) for name in scaled._fields if name != "medium"
    }
    return arrays | {
        "scaled_scattering": scaled.medium.scattering,
        "scaled_extinction": scaled.medium.extinction,
        "shells": atmosphere.shells,
        "columns": atmosphere.columns,
        "order": np.array(field.harmonics.order),
        "altitude": field.altitude,
        "sun_angle": field.sun_angle,
        "source": field.source,
        "radiance": field.radiance,
        "ground": field.ground,
        "aureole": atmosphere.aureole.source,
        "horizon_peaks": atmosphere.horizon_peaks.source,
        "basis_curves": atmosphere.basis.curves,
        "basis_weights": atmosphere.basis.weights,
    }


def _from_arrays(medium: Medium, arrays: dict[str, Any]) -> Atmosphere:
    delta_m_arrays = {
        name: arrays[f"delta_m_{name}"] for name in ScaledMedium._fields if name != "medium"
    }
    constituents = medium.scattering.shape[0]
    padded = pad_wavelengths(medium)
    scaled = padded._replace(
        scattering=arrays["scaled_scattering"],
        extinction=arrays["scaled_extinction"],
        phase=delta_m_arrays["phase"][:constituents],
        matrix=padded.matrix[:0],
    )
    scaled_medium = ScaledMedium(medium=scaled, **delta_m_arrays)
    twilight = twilight_scale(medium)
    field = DiffuseField(
        harmonics=build_harmonics(int(arrays["order"])),
        altitude=arrays["altitude"],
        layer=altitude_layers(scaled, arrays["altitude"]),
        sun_angle=arrays["sun_angle"],
        sun_bin=sun_bins(arrays["sun_angle"]),
        sun_factor=sun_factors(arrays["sun_angle"], twilight),
        twilight=twilight,
        steep_from=steep_twilight(medium),
        source=arrays["source"],
        polarised=polarised_source(scaled_medium),
        radiance=arrays["radiance"],
        ground=arrays["ground"],
    )
    return Atmosphere(
        medium=medium,
        scaled=scaled_medium,
        shells=arrays["shells"],
        columns=arrays["columns"],
        field=field,
        aureole=Aureole(arrays["aureole"]),
        horizon_peaks=HorizonPeaks(arrays["horizon_peaks"]),
        basis=PhaseBasis(arrays["basis_curves"], arrays["basis_weights"]),
    )
