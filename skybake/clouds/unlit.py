"""A layer of clouds before light falls on it."""

from __future__ import annotations

from dataclasses import dataclass

from skybake.cloud_fields.field import CloudField
from skybake.clouds.layer import Grid
from skybake.optics.medium import Array


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer: where its clouds are, the voxels of its light, and how it scatters.

    Attributes
    ----------
    field : CloudField
        Where clouds are.
    grid : Grid
        Mean extinction on the voxels of its light.
    phase : ndarray of float64, shape (SCATTERING_ANGLES, channel)
        Phase function of what is scattered once. [sr⁻¹]
    middle : ndarray of float64, shape (SCATTERING_ANGLES,)
        Of what is scattered more often. [sr⁻¹]
    order : int
        Degree to which its light is resolved.
    """

    field: CloudField
    grid: Grid
    phase: Array
    middle: Array
    order: int
