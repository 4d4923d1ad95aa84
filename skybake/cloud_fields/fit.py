"""Makes fields of surfaces that have the cover and the optical depth that were asked for."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import SURFACE, CloudField
from skybake.cloud_fields.near_clearance import with_near_clearance
from skybake.cloud_fields.surface import STEP, surface_detail, surface_extinction
from skybake.cloud_fields.surface_bounds import with_clearance
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS

LEAST_DEPTH = 0.2
"""Optical depth from which a column counts as covered, or this share of the mean if that is
below 1."""

_BLURS = 7
# Prime, so that columns meet nodes and noise at every phase.
_COLUMNS = 139
_FEW_COLUMNS = 67
_TRIALS = 12
_CLOSE = 5e-4


class Surface(NamedTuple):
    """Clouds whose cover and optical depth are still to be adjusted.

    Attributes
    ----------
    nodes : ndarray of float32, shape (z, y, x)
        Distance from their surface, negative inside. [km]
    base : float
        Altitude of the lowest nodes. [km]
    profile : ndarray of float64, shape (z,)
        Relative extinction inside, at the nodes' heights.
    others
        As in `CloudField`.
    """

    nodes: npt.NDArray[np.float32]
    spacing: npt.NDArray[np.float64]
    base: float
    profile: npt.NDArray[np.float64]
    edge: float
    widest_edge: float
    condensation: float
    displacement: npt.NDArray[np.float64]
    noise: npt.NDArray[np.int8]


def fitted_field(
    surface: Surface, cover: float, optical_depth: float, farthest: float
) -> CloudField:
    """Move a surface and scale its extinction until cover and optical depth are met.

    Parameters
    ----------
    surface : Surface
        The clouds.
    cover : float
        Share of columns whose optical depth is above `LEAST_DEPTH`, in (0, 1].
    optical_depth : float
        Mean of those columns.
    farthest : float
        By which the surface may be moved inward or outward; where that is not enough, cover is
        not met. [km]
    """
    field = _unfitted(surface)
    depths = np.empty((_COLUMNS, _COLUMNS), np.float32)

    def cover_at(offset: float) -> float:
        _column_depths(field, offset, depths)
        return _cover(depths, _scale(depths, optical_depth), optical_depth)

    offset = _root(cover_at, cover, farthest)
    relative = _column_depths(field, offset, depths)
    field = field._replace(
        extinction=field.extinction * _scale(relative, optical_depth),
        shift=np.full(_BLURS, offset),
    )
    field = field._replace(shift=_mean_keeping_shifts(field))
    return with_near_clearance(with_clearance(field))


def _root(cover_at: Callable[[float], float], cover: float, farthest: float) -> float:
    """Return the offset at which there is this cover, which grows with it.

    It is the least that was found with full cover, where that is wanted.
    """
    low, high = -farthest, farthest
    below, above = 0.0, 1.0
    offset, found = 0.0, cover_at(0.0)
    best, nearest = offset, abs(found - cover)
    for trial in range(_TRIALS):
        if cover < 1.0 and nearest < _CLOSE:
            return best
        if found < cover:
            low, below = offset, found
        else:
            high, above = offset, found
        # Halfway in turn with between the ends, which alone would approach from one side only.
        is_half = cover >= 1.0 or trial % 2
        share = 0.5 if is_half else (cover - below) / max(above - below, 1e-9)
        offset = low + min(max(share, 0.1), 0.9) * (high - low)
        found = cover_at(offset)
        if abs(found - cover) < nearest:
            best, nearest = offset, abs(found - cover)
    return best if cover < 1.0 else high


def _unfitted(surface: Surface) -> CloudField:
    levels, rows, columns = surface.nodes.shape
    dz, dy, dx = (float(each) for each in surface.spacing)
    distance = np.clip(np.rint(surface.nodes / STEP), -32767, 32767).astype(np.int16)
    periods = 1.0 / surface.displacement[:, 5]
    return CloudField(
        kind=SURFACE,
        values=np.zeros((1, 1, 1), np.float32),
        distance=distance,
        spacing=surface.spacing,
        period=np.array([columns * dx, rows * dy]),
        origin=np.zeros(2),
        base=surface.base,
        top=surface.base + (levels - 1) * dz,
        extinction=surface.profile,
        edge=surface.edge,
        widest_edge=surface.widest_edge,
        condensation=surface.condensation,
        shift=np.zeros(_BLURS),
        largest_blur=max(0.25 * float(periods.max()), surface.widest_edge - surface.edge),
        displacement=surface.displacement,
        noise=surface.noise,
        clearance=np.zeros((1, 1, 1), np.float32),
        block=np.ones(3),
        near_clearance=np.zeros((1, 1, 1), np.uint8),
        near_unit=1.0,
        near_blur=0.0,
        patch=0.0,
        shifts=np.zeros((1, 1, 2)),
        erosion=0.0,
        vanishing=0.0,
    )


def _column_depths(
    field: CloudField, offset: float, depths: npt.NDArray[np.float32]
) -> npt.NDArray[np.float32]:
    moved = field._replace(shift=np.full(_BLURS, offset))

    def measure(first: int, last: int) -> None:
        _measure_columns(moved, 0.0, depths, first, last)

    ALL_CPUS.run_rows(len(depths), measure, chunk=8)
    return depths


def _scale(relative: npt.NDArray[np.float32], optical_depth: float) -> float:
    """Return the factor with which columns that count as covered have a mean optical depth."""
    threshold, deepest = _threshold(optical_depth), float(relative.max())
    if deepest <= 0.0:
        return 0.0
    scale = optical_depth / deepest
    for _ in range(30):
        covered = relative[scale * relative > threshold]
        if not covered.size:
            scale *= 2.0
            continue
        better = optical_depth / float(covered.mean(dtype=np.float64))
        if abs(better - scale) <= 1e-6 * scale:
            break
        scale = better
    return scale


def _cover(depths: npt.NDArray[np.float32], scale: float, optical_depth: float) -> float:
    return float((scale * depths > _threshold(optical_depth)).mean())


def _threshold(optical_depth: float) -> float:
    return LEAST_DEPTH * min(optical_depth, 1.0)


def mean_depth(field: CloudField) -> float:
    """Return the mean optical depth of vertical columns."""
    depths = np.empty((_COLUMNS, _COLUMNS), np.float32)

    def measure(first: int, last: int) -> None:
        _measure_columns(field, 0.0, depths, first, last)

    ALL_CPUS.run_rows(_COLUMNS, measure, chunk=8)
    return float(depths.mean(dtype=np.float64))


def _mean_keeping_shifts(field: CloudField) -> npt.NDArray[np.float64]:
    """Return the shift of each blur with which the mean extinction is that without blur."""
    shifts = field.shift.copy()
    depths = np.empty((_FEW_COLUMNS, _FEW_COLUMNS), np.float32)

    def mean(blur: float, shift: float) -> float:
        moved = field._replace(shift=np.full(_BLURS, shift))

        def measure(first: int, last: int) -> None:
            _measure_columns(moved, blur, depths, first, last)

        ALL_CPUS.run_rows(_FEW_COLUMNS, measure, chunk=16)
        return float(depths.mean(dtype=np.float64))

    wanted = mean(0.0, shifts[0])
    for i in range(1, _BLURS):
        blur = field.largest_blur * (i / (_BLURS - 1)) ** 2
        before, step = float(shifts[i - 1]), 0.25 * field.edge
        low = mean(blur, before) - wanted
        high = mean(blur, before + step) - wanted
        for _ in range(2):
            if high == low:
                break
            after = before + step - high * step / (high - low)
            after = min(max(after, shifts[0] - field.widest_edge), shifts[0] + field.widest_edge)
            before, step, low = before + step, after - before - step, high
            high = mean(blur, after) - wanted
        shifts[i] = before + step
    return shifts


@kernel
def _measure_columns(field, blur, depths, first, last):
    """Optical depths of vertical columns of rows from `first` to below `last`."""
    count = depths.shape[0]
    levels = field.distance.shape[0] - 1
    dz = field.spacing[0]
    detail = surface_detail(field, blur)
    for j in range(first, last):
        y = (j + 0.5) / count * field.period[1]
        for i in range(count):
            x = (i + 0.5) / count * field.period[0]
            total = 0.0
            for k in range(levels):
                altitude = field.base + (k + 0.5) * dz
                total += surface_extinction(field, x, y, altitude, detail)
            depths[j, i] = total * dz
