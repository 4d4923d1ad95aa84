"""All tables of an atmosphere: what depends neither on the observer nor on the sun."""

from __future__ import annotations

import hashlib
import os
import threading
from collections import OrderedDict
from concurrent.futures import Future
from typing import Any, NamedTuple

import numpy as np

from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.legendre import Truncation, channel_groups, keep_peaks, truncate_peaks
from skybake.optics.lobes import Lobes, split_phase
from skybake.optics.medium import Array, Medium, pad_wavelengths
from skybake.scattering.closure import close_field
from skybake.scattering.field import DiffuseField, altitude_layers, sun_bins, sun_factors
from skybake.scattering.grid import ORDER
from skybake.scattering.harmonics import build_harmonics
from skybake.scattering.solver import solve_field
from skybake.scattering.store import (
    arrays_from_content,
    content_from_arrays,
    has_tables,
    read_tables,
    write_tables,
)
from skybake.scattering.table_shapes import are_tables_of
from skybake.scattering.transmittance import build_columns
from skybake.transport.shells import altitude_shells

KEPT = 4
"""Atmospheres that stay in memory: of a sequence all maps share one, or each has its own."""


class Atmosphere(NamedTuple):
    """Tables that rays look up.

    Attributes
    ----------
    cut : Truncation
        The medium without forward peaks, and what restores them; of wavelengths as
        `pad_wavelengths` leaves them, as is all of the rest but the lobes.
    shells : ndarray of float64
        Altitudes at which rays are cut into steps. [km]
    columns : ndarray of float64
        Columns toward the sun, see `build_columns`.
    field : DiffuseField
        The light that was scattered before.
    lobes : Lobes
        Curves that the phase functions of `cut` are sums of.
    """

    cut: Truncation
    shells: Array
    columns: Array
    field: DiffuseField
    lobes: Lobes


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
    InputError
        If all orders were asked for and the air is optically too thick.
    """
    padded = pad_wavelengths(medium)
    cut = truncate_peaks(padded, ORDER) if method == "full" else keep_peaks(padded)
    columns = build_columns(padded, workers=workers)
    solve = solve_field if method == "full" else close_field
    lobes = split_phase(cut.phase[..., : medium.ground_albedo.size], channel_groups(cut))
    return Atmosphere(cut, altitude_shells(medium), columns, solve(cut, columns, workers), lobes)


_recent: OrderedDict[str, Future[Atmosphere]] = OrderedDict()
_lock = threading.Lock()


def _leave_to_parent() -> None:
    """Let a forked process build itself what threads of its parent had begun to build."""
    global _lock  # noqa: PLW0603 - it may be held by a thread that is not there
    _lock = threading.Lock()
    for key in [key for key, tables in _recent.items() if not tables.done()]:
        del _recent[key]


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_leave_to_parent)


def load_atmosphere(medium: Medium, method: str, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Return the tables of a medium from memory or disk, or build and keep them.

    A file that is missing, or is not bit by bit what was once written under its name, or
    whose arrays have other shapes than the medium asks for, is made anew;
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

    Content that is not as it was made is left alone: the tables are then built here.
    """
    key = atmosphere_key(medium, method)
    arrays = None if key in _recent else arrays_from_content(key, content)
    if arrays is None or not are_tables_of(medium, arrays):
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
    return has_tables(atmosphere_key(medium, method))


def atmosphere_key(medium: Medium, method: str) -> str:
    """Name of a medium's tables: a digest of everything that they depend on but the code."""
    digest = hashlib.sha256(f"{method} {medium.r_bottom!r} {medium.r_top!r}".encode())
    for array in medium[2:]:
        digest.update(f"{array.shape}".encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:32]


def _to_arrays(atmosphere: Atmosphere) -> dict[str, Any]:
    cut, field = atmosphere.cut, atmosphere.field
    arrays = {f"cut_{name}": getattr(cut, name) for name in cut._fields if name != "medium"}
    return arrays | {
        "scaled_scattering": cut.medium.scattering,
        "scaled_extinction": cut.medium.extinction,
        "shells": atmosphere.shells,
        "columns": atmosphere.columns,
        "order": np.array(field.harmonics.order),
        "altitude": field.altitude,
        "sun_angle": field.sun_angle,
        "source": field.source,
        "radiance": field.radiance,
        "ground": field.ground,
        "lobe_curves": atmosphere.lobes.curves,
        "lobe_weights": atmosphere.lobes.weights,
    }


def _from_arrays(medium: Medium, arrays: dict[str, Any]) -> Atmosphere:
    cut_arrays = {name: arrays[f"cut_{name}"] for name in Truncation._fields if name != "medium"}
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
    cut = Truncation(medium=scaled, **cut_arrays)
    lobes = Lobes(arrays["lobe_curves"], arrays["lobe_weights"])
    return Atmosphere(cut, arrays["shells"], arrays["columns"], field, lobes)
