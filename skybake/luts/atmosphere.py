"""All tables of an atmosphere: what depends neither on the observer nor on the sun.

They are built once and kept on disk as plain arrays, named by everything that
they depend on. A file is a SHA-256 digest of the rest, then arrays in numpy's own
format: their names, and each of them.
"""

from __future__ import annotations

import hashlib
import os
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from skybake.luts.closure import close_field
from skybake.luts.field import DiffuseField, altitude_layers, sun_bins, sun_factors
from skybake.luts.grid import ORDER
from skybake.luts.harmonics import build_harmonics
from skybake.luts.solver import solve_field
from skybake.luts.transmittance import build_columns
from skybake.optics.legendre import Truncation, channel_groups, keep_peaks, truncate_peaks
from skybake.optics.lobes import Lobes, split_phase
from skybake.optics.medium import Array, Medium, pad_wavelengths
from skybake.transport.kernel import cache_directory
from skybake.transport.shells import altitude_shells

LARGEST_STORE = 1 << 30
"""Size beyond which the tables unused for longest are removed. [byte]"""

_DIGEST_SIZE = hashlib.sha256().digest_size


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


def build_atmosphere(medium: Medium, method: str) -> Atmosphere:
    """Build the tables of a medium.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    method : {"full", "hillaire"}
        All orders of scattering, or Hillaire's closure.

    Raises
    ------
    InputError
        If all orders were asked for and the air is optically too thick.
    """
    padded = pad_wavelengths(medium)
    cut = truncate_peaks(padded, ORDER) if method == "full" else keep_peaks(padded)
    columns = build_columns(padded)
    solve = solve_field if method == "full" else close_field
    lobes = split_phase(cut.phase[..., : medium.ground_albedo.size], channel_groups(cut))
    return Atmosphere(cut, altitude_shells(medium), columns, solve(cut, columns), lobes)


def load_atmosphere(medium: Medium, method: str) -> Atmosphere:
    """Return the tables of a medium from disk, or build and keep them.

    A file that is missing or not, bit by bit, what was once written is made anew;
    where none can be written the tables are built every time.
    """
    path = _path(medium, method)
    if path is None:
        return build_atmosphere(medium, method)
    arrays = _read(path)
    if arrays is not None:
        return _from_arrays(medium, arrays)
    atmosphere = build_atmosphere(medium, method)
    _store(path, atmosphere)
    return atmosphere


def is_stored(medium: Medium, method: str) -> bool:
    """Whether `load_atmosphere` would find a file."""
    path = _path(medium, method)
    return path is not None and path.exists()


def _path(medium: Medium, method: str) -> Path | None:
    """File of a medium's tables, named by its arrays and by the code that makes them."""
    directory = cache_directory()
    if directory is None:
        return None
    digest = hashlib.sha256(f"{method} {medium.r_bottom!r} {medium.r_top!r}".encode())
    for array in medium[2:]:
        digest.update(f"{array.shape}".encode() + np.ascontiguousarray(array).tobytes())
    return directory / "atmospheres" / f"{digest.hexdigest()[:32]}.tables"


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


def _read(path: Path) -> dict[str, Any] | None:
    """Return the arrays of a file, or None if it is missing or not as it was written.

    The digest is checked before anything else is read: damaged arrays can fail in
    any way, or only look right.
    """
    try:
        whole = path.read_bytes()
    except OSError:
        return None
    if _digest(memoryview(whole)[_DIGEST_SIZE:]) != whole[:_DIGEST_SIZE]:
        return None
    # The time of last use decides what goes first when the folder is full.
    with suppress(OSError):
        os.utime(path)
    stream = BytesIO(whole)
    stream.seek(_DIGEST_SIZE)
    names = np.load(stream, allow_pickle=False)
    return {str(name): np.load(stream, allow_pickle=False) for name in names}


def _store(path: Path, atmosphere: Atmosphere) -> None:
    """Write tables beside their name and rename them; a full disk only costs the reuse."""
    arrays = _to_arrays(atmosphere)
    stream = BytesIO()
    for array in (np.array(list(arrays)), *arrays.values()):
        np.save(stream, array, allow_pickle=False)
    temporary = path.with_name(f".{path.stem}-{os.getpid()}{path.suffix}")
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with temporary.open("wb") as file:
                file.write(_digest(stream.getbuffer()))
                file.write(stream.getbuffer())
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
        _remove_oldest(path.parent)


def _digest(content: memoryview) -> bytes:
    return hashlib.sha256(content).digest()


def _remove_oldest(folder: Path) -> None:
    """Keep the folder below `LARGEST_STORE`."""
    files = sorted(folder.glob("*.tables"), key=lambda file: file.stat().st_mtime, reverse=True)
    total = 0
    for file in files:
        total += file.stat().st_size
        if total > LARGEST_STORE:
            file.unlink(missing_ok=True)
