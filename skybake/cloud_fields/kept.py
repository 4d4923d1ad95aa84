"""Fields that are kept on disk, beside solved atmospheres."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

import numpy as np

from skybake.cloud_fields.field import CloudField
from skybake.jit.cache import CLOUDS_PREFIX, source_hash
from skybake.jit.tables import read_tables, write_tables


def kept_field(name: str, shape: tuple[float, ...], build: Callable[..., CloudField]) -> CloudField:
    """Return a field that was built before, or build and keep it.

    Parameters
    ----------
    name : str
        Of the kind of cloud.
    shape : tuple of float
        Arguments of `build`: all that the field depends on besides the code.
    build : callable
        Makes the field.
    """
    key = _key(name, shape)
    arrays = read_tables(key)
    if arrays is not None and set(arrays) == set(CloudField._fields):
        return _from_arrays(arrays)
    arrays = build(*shape)._asdict()
    write_tables(key, arrays)
    return _from_arrays(arrays)


def _key(name: str, shape: tuple[float, ...]) -> str:
    text = repr(
        (name, [float(each) for each in shape], source_hash("cloud_fields"), np.__version__)
    )
    return f"{CLOUDS_PREFIX}{hashlib.sha256(text.encode()).hexdigest()[:32]}"


def _from_arrays(arrays: dict[str, Any]) -> CloudField:
    """Return a field of arrays, in which numbers may be arrays without an axis.

    Built or read, the arrays are of one layout: kernels would be compiled anew for another.
    """
    plain = {
        name: np.require(value, requirements=["C", "A", "W"])
        if np.ndim(value)
        else np.asarray(value).item()
        for name, value in arrays.items()
    }
    return CloudField(**plain)
