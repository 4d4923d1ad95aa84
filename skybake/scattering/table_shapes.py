"""Shapes that the tables of an atmosphere must have before kernels read them unchecked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from skybake.optics.delta_m import PEAK_NODES
from skybake.optics.medium import Medium, pad_wavelengths
from skybake.optics.phase import SCATTERING_ANGLES
from skybake.scattering.aureole import ANGLES, ORDERS
from skybake.scattering.horizon_peaks import SIDE
from skybake.scattering.polarised import ORDERS as ORDERS_OF_SPIN
from skybake.scattering.transmittance import SHAPE

Shape = tuple[int | str, ...]

_PHASES = ("phase function", SCATTERING_ANGLES, "padded wavelength")
_BY_CONSTITUENT = ("constituent", "padded wavelength")

# Sizes by what they count: the same words are the same number.
_SHAPES: dict[str, tuple[type, Shape]] = {
    "delta_m_moments": (np.float64, ("constituent", "moment", "padded wavelength")),
    "delta_m_peaked": (np.int64, ("peak",)),
    "delta_m_fraction": (np.float64, _BY_CONSTITUENT),
    "delta_m_scattering": (np.float64, _BY_CONSTITUENT),
    "delta_m_mixture": (np.float64, ("padded wavelength",)),
    "delta_m_phase": (np.float64, _PHASES),
    "delta_m_matrix_moments": (np.float64, ("polarising", 3, "spin", "padded wavelength")),
    "scaled_scattering": (np.float64, _BY_CONSTITUENT),
    "scaled_extinction": (np.float64, _BY_CONSTITUENT),
    "shells": (np.float64, ("shell",)),
    "columns": (np.float64, (*SHAPE, "constituent")),
    "order": (np.int64, ()),
    "altitude": (np.float64, ("altitude",)),
    "sun_angle": (np.float64, ("sun",)),
    "source": (np.float64, ("constituent", "moment", "padded wavelength")),
    "radiance": (np.float32, ("altitude", "sun", "harmonic", "padded wavelength")),
    "ground": (np.float64, ("sun", "padded wavelength")),
    "aureole": (np.float32, ("aureole altitude", "aureole sun", "aureole angle", "aureole term")),
    "horizon_peaks": (
        np.float32,
        ("peak altitude", "peak sun", "elevation", "peak term"),
    ),
    "basis_curves": (np.float64, ("basis curve", SCATTERING_ANGLES)),
    "basis_weights": (np.float64, ("phase function", "wavelength", "basis curve")),
}


def are_tables_of(medium: Medium, arrays: Mapping[str, Any]) -> bool:
    """Whether arrays can be the stored tables of a medium, by their names, types and shapes."""
    if set(arrays) != set(_SHAPES):
        return False
    sizes = {
        "constituent": medium.scattering.shape[0],
        "wavelength": medium.ground_albedo.size,
        "padded wavelength": pad_wavelengths(medium).ground_albedo.size,
    }
    for name, (kind, shape) in _SHAPES.items():
        if arrays[name].dtype != kind or not _fits(arrays[name].shape, shape, sizes):
            return False
    order, peaked = int(arrays["order"]), arrays["delta_m_peaked"]
    related = {
        "moment": order + 1,
        "harmonic": (order + 1) * (order + 2) // 2 + (ORDERS_OF_SPIN if sizes["polarising"] else 0),
        "phase function": sizes["constituent"] + len(PEAK_NODES) * sizes["peak"],
    }
    if sizes["polarising"]:
        related |= {"polarising": sizes["constituent"], "spin": order + 1}
    if sizes["aureole angle"] > 0:
        related |= {"aureole altitude": sizes["altitude"], "aureole sun": sizes["sun"]}
        related["aureole angle"] = ANGLES
    related["aureole term"] = ORDERS * sizes["padded wavelength"]
    if sizes["elevation"] > 0:
        related |= {"peak altitude": sizes["altitude"], "peak sun": sizes["sun"]}
        related["elevation"] = 2 * SIDE
        related["peak term"] = (order + 1) * sizes["padded wavelength"]
    return (
        all(sizes[name] == size for name, size in related.items())
        and sizes["sun"] >= 4
        and min(sizes["altitude"], sizes["shell"]) >= 2
        and bool(((peaked >= 0) & (peaked < sizes["constituent"])).all())
    )


def _fits(got: tuple[int, ...], shape: Shape, sizes: dict[str, int]) -> bool:
    """Compare a shape; words that have no number yet take the one that they meet."""
    if len(got) != len(shape):
        return False
    expected = [
        sizes.setdefault(size, count) if isinstance(size, str) else size
        for size, count in zip(shape, got, strict=True)
    ]
    return list(got) == expected
