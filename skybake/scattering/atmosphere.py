"""Building the tables of an atmosphere, and keeping them in memory and on disk."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from concurrent.futures import Future
from typing import Any

import numpy as np

from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import ScaledMedium, keep_unscaled, phase_groups, scale_medium
from skybake.optics.medium import Medium, pad_wavelengths
from skybake.optics.phase_basis import PhaseBasis, build_phase_basis
from skybake.scattering.closure import close_field
from skybake.scattering.field import DiffuseField, altitude_layers, sun_bins, sun_factors
from skybake.scattering.grid import ORDER, no_field
from skybake.scattering.harmonics import build_harmonics
from skybake.scattering.solver import solve_field
from skybake.scattering.store import (
    arrays_from_content,
    content_from_arrays,
    read_tables,
    stored_tables,
    write_tables,
)
from skybake.scattering.tables import Atmosphere
from skybake.scattering.transmittance import build_columns
from skybake.transport.shells import altitude_shells

KEPT = 4
"""Atmospheres that stay in memory: of a sequence all maps share one, or each has its own."""


def build_atmosphere(medium: Medium, method: str, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Build the tables of a medium.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    method : {"full", "hillaire"}
        All orders of scattering, or Hillaire's closure.
    workers : Workers, optional
        Who does the work.

    Raises
    ------
    TooThickError
        If all orders were asked for and the atmosphere is optically too thick.
    """
    dark = dark_atmosphere(medium, method, workers)
    solve = solve_field if method == "full" else close_field
    return dark._replace(field=solve(dark, workers))


def dark_atmosphere(medium: Medium, method: str, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Build all tables but the diffuse field, which is left without light.

    Parameters are those of `build_atmosphere`.
    """
    padded = pad_wavelengths(medium)
    scaled = scale_medium(padded, ORDER) if method == "full" else keep_unscaled(padded)
    return Atmosphere(
        medium=medium,
        scaled=scaled,
        shells=altitude_shells(medium),
        columns=build_columns(padded, workers=workers),
        field=no_field(scaled),
        basis=build_phase_basis(
            scaled.phase[..., : medium.ground_albedo.size], phase_groups(scaled)
        ),
    )


_recent: OrderedDict[str, Future[Atmosphere]] = OrderedDict()
_lock = threading.Lock()


def load_atmosphere(medium: Medium, method: str, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Return the tables of a medium from memory or disk, or build and keep them.

    A file that is missing or not, bit by bit, what was once written is made anew;
    where none can be written the tables are built by every process.
    """
    key = atmosphere_key(medium, method)
    with _lock:
        kept = _recent.pop(key, None)
        pending = _recent[key] = kept or Future()
        while len(_recent) > KEPT:
            _recent.popitem(last=False)
    if kept is None:
        # Of several threads that need the same tables one makes them, and the others wait.
        try:
            pending.set_result(_read_or_build(medium, method, key, workers))
        except BaseException as error:
            _recent.pop(key, None)
            pending.set_exception(error)
            raise
    return pending.result()


def _read_or_build(medium: Medium, method: str, key: str, workers: Workers) -> Atmosphere:
    arrays = read_tables(key)
    if arrays is not None:
        return _from_arrays(medium, arrays)
    atmosphere = build_atmosphere(medium, method, workers)
    write_tables(key, _to_arrays(atmosphere))
    return atmosphere


def atmosphere_content(medium: Medium, method: str) -> bytes:
    """Return the tables of a medium as a file holds them, for another machine."""
    return content_from_arrays(_to_arrays(load_atmosphere(medium, method)))


def adopt_atmosphere(medium: Medium, method: str, content: bytes) -> None:
    """Keep tables in memory that another machine has built, see `atmosphere_content`.

    Content that is not as it was made is left alone: the tables are then built here.
    """
    key = atmosphere_key(medium, method)
    arrays = None if key in _recent else arrays_from_content(content)
    if arrays is None:
        return
    adopted: Future[Atmosphere] = Future()
    adopted.set_result(_from_arrays(medium, arrays))
    with _lock:
        _recent[key] = adopted


def forget_atmospheres() -> None:
    """Free the memory that tables take; they stay on disk."""
    _recent.clear()


def is_stored(medium: Medium, method: str) -> bool:
    """Whether `load_atmosphere` would find a file."""
    return stored_tables(atmosphere_key(medium, method)) is not None


def atmosphere_key(medium: Medium, method: str) -> str:
    """Name of a medium's tables: a digest of everything that they depend on but the code."""
    digest = hashlib.sha256(f"{method} {medium.r_bottom!r} {medium.r_top!r}".encode())
    for array in medium[2:]:
        digest.update(f"{array.shape}".encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:32]


def _to_arrays(atmosphere: Atmosphere) -> dict[str, Any]:
    scaled, field = atmosphere.scaled, atmosphere.field
    arrays = {f"cut_{name}": getattr(scaled, name) for name in scaled._fields if name != "medium"}
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
        "lobe_curves": atmosphere.basis.curves,
        "lobe_weights": atmosphere.basis.weights,
    }


def _from_arrays(medium: Medium, arrays: dict[str, Any]) -> Atmosphere:
    cut_arrays = {name: arrays[f"cut_{name}"] for name in ScaledMedium._fields if name != "medium"}
    constituents = medium.scattering.shape[0]
    scaled = pad_wavelengths(medium)._replace(
        scattering=arrays["scaled_scattering"],
        extinction=arrays["scaled_extinction"],
        phase=cut_arrays["phase"][:constituents],
    )
    field = DiffuseField(
        harmonics=build_harmonics(int(arrays["order"])),
        altitude=arrays["altitude"],
        layer=altitude_layers(scaled, arrays["altitude"]),
        sun_angle=arrays["sun_angle"],
        sun_bin=sun_bins(arrays["sun_angle"]),
        sun_factor=sun_factors(arrays["sun_angle"]),
        source=arrays["source"],
        radiance=arrays["radiance"],
        ground=arrays["ground"],
    )
    return Atmosphere(
        medium=medium,
        scaled=ScaledMedium(medium=scaled, **cut_arrays),
        shells=arrays["shells"],
        columns=arrays["columns"],
        field=field,
        basis=PhaseBasis(arrays["lobe_curves"], arrays["lobe_weights"]),
    )
