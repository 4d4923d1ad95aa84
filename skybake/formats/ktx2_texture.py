"""KTX 2 files of flat textures and volumes, such as tables that shaders look up."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError, OutputError
from skybake.formats.ktx2_container import INDEX_AT, beginning, index_entry
from skybake.formats.spec import HALF_MAX, Attribute
from skybake.formats.targets import faults_of
from skybake.formats.texels import TEXEL_FORMATS
from skybake.formats.whole_files import WholeFiles

_TYPES = {"half": "<f2", "float": "<f4"}
_RGB, _RGBA = 3, 4


def write_ktx2_texture(
    path: Path,
    values: npt.NDArray[np.float32],
    *,
    pixel: str = "float",
    attributes: Mapping[str, Attribute] | None = None,
    files: WholeFiles | None = None,
) -> None:
    """Write a texture of one level, uncompressed, as four channels.

    Parameters
    ----------
    path : Path
        The file.
    values : ndarray of float32, shape (height, width, 3 or 4) or (depth, height, width, 3 or 4)
        Row 0 is the first in the file, and so is slice 0; a fourth channel that is not given is 1.
    pixel : {"float", "half"}, optional
        Type of the channels.
    attributes : mapping of str to Attribute, optional
        Key/value pairs, as text; `colorInteropID` decides the primaries too.
    files : WholeFiles, optional
        The set that the file is to appear with; by default it appears at once.

    Raises
    ------
    InputError
        For an unknown `pixel`.
    OutputError
        If the file cannot be written, or a value does not fit its type.
    ValueError
        If the shape is another, or an attribute has a name that KTX reserves.
    """
    if pixel not in _TYPES:
        raise InputError(f"pixel: must be one of {', '.join(_TYPES)}, got {pixel!r}")
    if values.ndim not in (3, 4) or values.shape[-1] not in (_RGB, _RGBA) or not values.size:
        raise ValueError(f"texture must have 3 or 4 channels and 2 or 3 axes, got {values.shape}")
    _check_range(path, values, pixel)
    form = TEXEL_FORMATS[pixel]
    texels = np.ones((*values.shape[:-1], _RGBA), _TYPES[pixel])
    texels[..., : values.shape[-1]] = values
    height, width = values.shape[-3:-1]
    depth = values.shape[0] if values.ndim == 4 else 0
    start = beginning(
        form, (width, height, depth), faces=1, levels=1, zstd=False, attributes=attributes or {}
    )
    # A level begins at a multiple of a texel's size.
    start += bytes(-len(start) % math.lcm(form.size, 4))
    plain = texels.tobytes()
    with ExitStack() as stack:
        if files is None:
            files = stack.enter_context(WholeFiles())
        temporary = files.add(path)
        with faults_of(path), temporary.open("wb") as file:
            file.write(start + plain)
            file.seek(INDEX_AT)
            file.write(index_entry(len(start), len(plain), len(plain)))


def _check_range(path: Path, values: npt.NDArray[np.float32], pixel: str) -> None:
    low, high = float(values.min()), float(values.max())
    if not np.isfinite(low + high):
        got = high if np.isfinite(low) else low
        raise OutputError(f"{path}: values must be finite, got {got}")
    largest = max(-low, high)
    if pixel == "half" and largest > HALF_MAX:
        raise OutputError(
            f"{path}: values in half must be at most {HALF_MAX:g}, got {largest:g}; use a larger "
            "unit or float"
        )
