"""Voxels of OpenVDB files, which its Python module reads."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from skybake.cloud_fields.light_grid import ExtinctionGrid
from skybake.errors import InputError

_MODULES = ("openvdb", "pyopenvdb")
_UP = {"y": (1, 0, 2), "z": (2, 1, 0)}


def read_vdb(path: Path, name: str, scale: float, unit: float, up: str) -> ExtinctionGrid:
    """Read a grid of scalars.

    Parameters
    ----------
    path : Path
        Of the ``.vdb``.
    name : str
        Of the grid.
    scale : float
        Extinction where the grid is 1. [km⁻¹]
    unit : float
        Length of the file's unit. [km]
    up : {"y", "z"}
        The file's axis that points up; with y up, z runs east and x north, which keeps
        handedness.

    Returns
    -------
    ExtinctionGrid
        Of the box around all voxels that are set, whose base is at 0.

    Raises
    ------
    InputError
        If no module of OpenVDB is installed, the file or the grid cannot be read, or it is empty.
    """
    openvdb = _module(path)
    try:
        names = [grid.name for grid in openvdb.readAllGridMetadata(str(path))]
    except Exception as error:
        raise InputError(f"{path}: must be a file of OpenVDB ({error})") from error
    if name not in names:
        raise InputError(f"{path}: must hold the grid {name}, got {', '.join(names) or 'none'}")
    grid = openvdb.read(str(path), name)
    if grid.activeVoxelCount() == 0:
        raise InputError(f"{path}: grid {name} must have voxels, got none")
    low, high = grid.evalActiveVoxelBoundingBox()
    array = np.zeros([b - a + 1 for a, b in zip(low, high, strict=True)], np.float32)
    try:
        grid.copyToArray(array, ijk=low)
    except (TypeError, ValueError) as error:
        raise InputError(f"{path}: grid {name} must be of scalars ({error})") from error
    axes = _UP[up]
    spacing = np.array([grid.transform.voxelSize()[axis] for axis in axes], np.float64) * unit
    values = np.ascontiguousarray(np.transpose(array, axes)) * np.float32(scale)
    return ExtinctionGrid(values, spacing, 0.0)


def _module(path: Path) -> Any:
    for name in _MODULES:
        try:
            return import_module(name)
        except ModuleNotFoundError as error:
            if error.name != name:
                raise _unloadable(path, name, error) from error
        except ImportError as error:
            raise _unloadable(path, name, error) from error
    raise InputError(f"{path}: needs the Python module openvdb, which is not installed")


def _unloadable(path: Path, name: str, error: ImportError) -> InputError:
    return InputError(f"{path}: needs the Python module {name}, which does not load ({error})")
