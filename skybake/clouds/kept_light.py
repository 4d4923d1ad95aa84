"""The light of clouds, kept on disk beside solved atmospheres."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.clouds.air import ClearAir
from skybake.clouds.layer import Reflectance, SolvedLayer
from skybake.clouds.light import LayerLight
from skybake.clouds.unlit import Layer
from skybake.jit.cache import CLOUD_LIGHT_PREFIX, source_hash
from skybake.jit.tables import LARGEST_LIGHTS, read_tables, write_tables
from skybake.optics.medium import Array
from skybake.scattering.atmosphere import atmosphere_key

Floats = npt.NDArray[np.float32]

_LIGHT = "light."
_OF_AIR = ("lit", "through", "distance")
_OF_LAYER = ("leaving", "mean_radiance", "down", "down_clear")
_REFLECTANCE = "reflectance."


class KeptLight(NamedTuple):
    """The light of layers, from the highest down, and that of the air around them.

    Attributes
    ----------
    layers : list of SolvedLayer
        Of all suns.
    lit, through : ndarray of float32
        Of `fill_lit` at the nodes of an observer's directions.
    distance : ndarray of float64, shape (node, stretch + 1)
        Along them. [km]
    """

    layers: list[SolvedLayer]
    lit: Floats
    through: Floats
    distance: Array


def read_light(key: str) -> KeptLight | None:
    """Return the light of a name that `light_key` gave; None where none is kept."""
    arrays = read_tables(key)
    return None if arrays is None else _from_arrays(arrays)


def keep_light(key: str, light: KeptLight) -> None:
    """Keep light on disk, unless it exceeds the room for all."""
    arrays = _to_arrays(light)
    if sum(np.asarray(each).nbytes for each in arrays.values()) < LARGEST_LIGHTS:
        write_tables(key, arrays)


def light_key(
    layers: Sequence[Layer], air: ClearAir, altitude: float, sun: Array, weights: Array
) -> str:
    """Name the light of layers and of the air by all that it depends on.

    Parameters
    ----------
    layers : sequence of Layer
        From the highest down.
    air, altitude, sun, weights
        As of `skybake.clouds.cloudscape.Cloudscape`.
    """
    given: list[Any] = [atmosphere_key(air.atmosphere.medium, air.method), air.sun_radius]
    given += [altitude, sun, weights, source_hash("clouds"), np.__version__]
    for layer in layers:
        grid = layer.grid
        given += [layer.order, grid.base, grid.spacing, grid.extinction]
        given += [layer.phase, layer.middle, *layer.field]
    digest = hashlib.sha256()
    for each in given:
        head = f"{each.shape}" if isinstance(each, np.ndarray) else repr(each)
        digest.update(f"{len(head)} {head}".encode())
        if isinstance(each, np.ndarray):
            digest.update(np.ascontiguousarray(each).data)
    return f"{CLOUD_LIGHT_PREFIX}{digest.hexdigest()[:32]}"


def _to_arrays(light: KeptLight) -> dict[str, Any]:
    arrays: dict[str, Any] = {"layers": len(light.layers)}
    arrays |= {name: getattr(light, name) for name in _OF_AIR}
    for number, layer in enumerate(light.layers):
        for name, value in layer.light._asdict().items():
            arrays[f"{number}.{_LIGHT}{name}"] = value
        for name, value in layer.reflectance._asdict().items():
            arrays[f"{number}.{_REFLECTANCE}{name}"] = value
        for name in _OF_LAYER:
            arrays[f"{number}.{name}"] = getattr(layer, name)
    return arrays


def _from_arrays(arrays: dict[str, Any]) -> KeptLight:
    solved = []
    for number in range(int(arrays["layers"])):
        # Numbers are arrays without an axis, and kernels are compiled for numbers.
        light = {
            name: value if value.ndim else value.item()
            for name in LayerLight._fields
            for value in [arrays[f"{number}.{_LIGHT}{name}"]]
        }
        parts: dict[str, Any] = {name: arrays[f"{number}.{name}"] for name in _OF_LAYER}
        reflects = (arrays[f"{number}.{_REFLECTANCE}{name}"] for name in Reflectance._fields)
        parts["reflectance"] = Reflectance(*reflects)
        solved.append(SolvedLayer(LayerLight(**light), **parts))
    return KeptLight(solved, *(arrays[name] for name in _OF_AIR))
