"""The light of clouds, kept on disk beside solved atmospheres."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from skybake.clouds.air import ClearAir
from skybake.clouds.layer import SolvedLayer
from skybake.clouds.light import LayerLight
from skybake.clouds.unlit import Layer
from skybake.jit.cache import CLOUD_LIGHT_PREFIX
from skybake.jit.tables import LARGEST_LIGHTS, read_tables, write_tables
from skybake.optics.medium import Array
from skybake.scattering.atmosphere import atmosphere_key

_LIGHT = "light."
_OF_LAYER = ("leaving", "mean_radiance", "down", "down_clear", "reflectance")


def kept_light(key: str, solve: Callable[[], list[SolvedLayer]]) -> list[SolvedLayer]:
    """Return light that was solved for before, or solve for it and keep it.

    Parameters
    ----------
    key : str
        Of `light_key`.
    solve : callable
        Solves for the light of all layers.
    """
    arrays = read_tables(key)
    if arrays is not None:
        return _from_arrays(arrays)
    solved = solve()
    arrays = _to_arrays(solved)
    # What exceeds the room for all would be removed at once.
    if sum(np.asarray(each).nbytes for each in arrays.values()) < LARGEST_LIGHTS:
        write_tables(key, arrays)
    return solved


def light_key(
    layers: Sequence[Layer], air: ClearAir, altitude: float, sun: Array, weights: Array
) -> str:
    """Name the light of layers by all that it depends on but the code.

    Parameters
    ----------
    layers : sequence of Layer
        From the highest down.
    air, altitude, sun, weights
        As of `skybake.clouds.cloudscape.Cloudscape`.
    """
    given: list[Any] = [atmosphere_key(air.atmosphere.medium, air.method), air.sun_radius]
    given += [altitude, sun, weights, np.__version__]
    for layer in layers:
        grid = layer.grid
        given += [layer.order, layer.field.top, grid.base, grid.spacing, grid.extinction]
        given += [layer.phase, layer.middle]
    digest = hashlib.sha256()
    for each in given:
        head = f"{each.shape}" if isinstance(each, np.ndarray) else repr(each)
        digest.update(f"{len(head)} {head}".encode())
        if isinstance(each, np.ndarray):
            digest.update(np.ascontiguousarray(each).data)
    return f"{CLOUD_LIGHT_PREFIX}{digest.hexdigest()[:32]}"


def _to_arrays(solved: list[SolvedLayer]) -> dict[str, Any]:
    arrays: dict[str, Any] = {"layers": len(solved)}
    for number, layer in enumerate(solved):
        for name, value in layer.light._asdict().items():
            arrays[f"{number}.{_LIGHT}{name}"] = value
        for name in _OF_LAYER:
            arrays[f"{number}.{name}"] = getattr(layer, name)
    return arrays


def _from_arrays(arrays: dict[str, Any]) -> list[SolvedLayer]:
    solved = []
    for number in range(int(arrays["layers"])):
        # Numbers are arrays without an axis, and kernels are compiled for numbers.
        light = {
            name: value if value.ndim else value.item()
            for name in LayerLight._fields
            for value in [arrays[f"{number}.{_LIGHT}{name}"]]
        }
        parts = {name: arrays[f"{number}.{name}"] for name in _OF_LAYER}
        solved.append(SolvedLayer(LayerLight(**light), **parts))
    return solved
