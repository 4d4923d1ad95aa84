"""A field without clouds, which fields of voxels start from as well."""

from __future__ import annotations

import numpy as np

from skybake.cloud_fields.field import CONSTANT, CloudField


def empty_field() -> CloudField:
    """Return a field without clouds."""
    return CloudField(
        kind=CONSTANT,
        values=np.zeros((1, 1, 1), np.float32),
        distance=np.zeros((1, 1, 1), np.int16),
        spacing=np.ones(3),
        period=np.ones(2),
        origin=np.zeros(2),
        base=0.0,
        top=0.0,
        extinction=np.zeros(1),
        edge=0.0,
        widest_edge=0.0,
        condensation=0.0,
        shift=np.zeros(1),
        largest_blur=0.0,
        displacement=np.zeros((0, 9)),
        noise=np.zeros((1, 1, 1), np.int8),
        clearance=np.ones((1, 1, 1), np.float32),
        block=np.ones(3),
        near_clearance=np.zeros((1, 1, 1), np.uint8),
        near_unit=1.0,
        near_blur=0.0,
        patch=0.0,
        shifts=np.zeros((1, 1, 2)),
        erosion=0.0,
        vanishing=0.0,
    )
