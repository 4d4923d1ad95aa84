"""Where the pixels of any map look, in numbers that kernels read.

The same formulas as those of the charts of `skybake.projection`, one direction at a time.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.projection.chart import Canvas, Chart, Part, Projection
from skybake.projection.equirect import EquirectChart
from skybake.projection.fisheye import FisheyeChart
from skybake.projection.gnomonic import GnomonicChart
from skybake.projection.octahedral import OctahedralChart

EQUIRECT, GNOMONIC, FISHEYE, OCTAHEDRAL = range(4)

NOWHERE = -1

# A direction on the edge of a cube belongs to one of two faces, or by rounding to neither.
_ROUNDING = 1e-9
_SMALLEST = 1e-300


class Layout(NamedTuple):
    """All charts of a map.

    Attributes
    ----------
    kind : ndarray of int64, shape (chart,)
        `EQUIRECT` and so on.
    axes : ndarray of float64, shape (chart, 3, 3)
        Right, up and forward of gnomonic and fisheye charts.
    numbers : ndarray of float64, shape (chart, 2)
        Step of rows [rad] and the row of the zenith; tangents of half the width and height; step of
        rows and half the angle across [rad].
    size : ndarray of int64, shape (chart, 2)
        Rows and columns.
    place : ndarray of int64, shape (chart, 3)
        Index of a chart's first pixel among all pixels of the map, and the steps to the next
        row and to the next column.
    """

    kind: npt.NDArray[np.int64]
    axes: npt.NDArray[np.float64]
    numbers: npt.NDArray[np.float64]
    size: npt.NDArray[np.int64]
    place: npt.NDArray[np.int64]


def layout_of(projection: Projection) -> Layout:
    """Return the layout of a map, whose canvases follow each other in one array of pixels."""
    kinds, axes, numbers, sizes, places = [], [], [], [], []
    before = 0
    for canvas in projection.canvases():
        for part in canvas.parts:
            kind, frame, values = _formula(part.chart)
            kinds.append(kind)
            axes.append(frame)
            numbers.append(values)
            sizes.append((part.chart.height, part.chart.width))
            places.append(_place(canvas, part, before))
        before += canvas.height * canvas.width
    return Layout(
        np.array(kinds, np.int64),
        np.array(axes, np.float64),
        np.array(numbers, np.float64),
        np.array(sizes, np.int64),
        np.array(places, np.int64),
    )


def _formula(chart: Chart) -> tuple[int, npt.NDArray[np.float64], tuple[float, float]]:
    nothing = np.zeros((3, 3))
    if isinstance(chart, EquirectChart):
        at_poles = chart.rows == "poles"
        step = math.pi / (chart.height - 1 if at_poles else chart.height)
        return EQUIRECT, nothing, (step, 0.5 if at_poles else 0.0)
    if isinstance(chart, GnomonicChart):
        return GNOMONIC, np.stack(chart.frame), (chart.half_width, chart.half_height)
    if isinstance(chart, FisheyeChart):
        return FISHEYE, np.stack(chart.frame), (chart.fov / chart.height, 0.5 * chart.fov)
    if isinstance(chart, OctahedralChart):
        return OCTAHEDRAL, nothing, (0.0, 0.0)
    raise TypeError(f"chart: must be one of skybake.projection, got {chart!r}")


def _place(canvas: Canvas, part: Part, before: int) -> tuple[int, int, int]:
    rows_flip, columns_flip = part.flip in {"rows", "both"}, part.flip in {"columns", "both"}
    first_row = part.row + (part.chart.height - 1 if rows_flip else 0)
    first_column = part.column + (part.chart.width - 1 if columns_flip else 0)
    return (
        before + first_row * canvas.width + first_column,
        -canvas.width if rows_flip else canvas.width,
        -1 if columns_flip else 1,
    )


@kernel
def direction_at(layout, chart, row, column):
    """Direction of a place, in pixels from a chart's upper left corner.

    Places beside the chart are those that follow on the sphere.

    Returns
    -------
    x, y, z : float
        Unit vector.
    density : float
        Solid angle to area on the chart, in some unit; 0 outside the sphere.
    """
    kind, first, second = layout.kind[chart], layout.numbers[chart, 0], layout.numbers[chart, 1]
    rows, columns = layout.size[chart, 0], layout.size[chart, 1]
    if kind == EQUIRECT:
        zenith = (row - second) * first
        bearing = column * 2.0 * math.pi / columns
        sine = math.sin(zenith)
        x, y, z = sine * math.sin(bearing), math.cos(zenith), -sine * math.cos(bearing)
        return x, y, z, max(sine, 0.0)
    u, v = 2.0 * column / columns - 1.0, 2.0 * row / rows - 1.0
    if kind == OCTAHEDRAL:
        x, y, z = u, 1.0 - abs(u) - abs(v), v
        if y < 0.0:
            x, z = math.copysign(1.0 - abs(v), u), math.copysign(1.0 - abs(u), v)
        nearer = 1.0 / math.sqrt(x * x + y * y + z * z)
        return x * nearer, y * nearer, z * nearer, nearer * nearer * nearer
    if kind == GNOMONIC:
        right, down = u * first, v * second
        nearer = 1.0 / math.sqrt(1.0 + right * right + down * down)
        right, down, forward = right * nearer, down * nearer, nearer
        density = nearer * nearer * nearer
    else:
        right, down = u * second, v * second
        aside = math.sqrt(right * right + down * down)
        density = math.sin(aside) / aside if aside > _SMALLEST else 1.0
        right, down, forward = right * density, down * density, math.cos(aside)
        density = max(density, 0.0)
    axes = layout.axes[chart]
    x = forward * axes[2, 0] + right * axes[0, 0] - down * axes[1, 0]
    y = forward * axes[2, 1] + right * axes[0, 1] - down * axes[1, 1]
    z = forward * axes[2, 2] + right * axes[0, 2] - down * axes[1, 2]
    return x, y, z, density


@kernel
def place_of(layout, x, y, z):
    """Chart that shows a direction, and the row and column in it; `NOWHERE` if there is none."""
    for chart in range(layout.kind.size):
        kind, first, second = layout.kind[chart], layout.numbers[chart, 0], layout.numbers[chart, 1]
        rows, columns = layout.size[chart, 0], layout.size[chart, 1]
        if kind == EQUIRECT:
            row = _arctangent(math.sqrt(x * x + z * z), y) / first + second
            turns = _arctangent(x, -z) / (2.0 * math.pi)
            return chart, row, (turns + 1.0 if turns < 0.0 else turns) * columns
        if kind == OCTAHEDRAL:
            nearer = 1.0 / (abs(x) + abs(y) + abs(z))
            u, v = x * nearer, z * nearer
            if y < 0.0:
                u, v = math.copysign(1.0 - abs(v), u), math.copysign(1.0 - abs(u), v)
            return chart, 0.5 * (v + 1.0) * rows, 0.5 * (u + 1.0) * columns
        axes = layout.axes[chart]
        forward = x * axes[2, 0] + y * axes[2, 1] + z * axes[2, 2]
        if kind == GNOMONIC and forward <= 0.0:
            continue
        right = x * axes[0, 0] + y * axes[0, 1] + z * axes[0, 2]
        down = -(x * axes[1, 0] + y * axes[1, 1] + z * axes[1, 2])
        if kind == GNOMONIC:
            u, v = right / (forward * first), down / (forward * second)
            if abs(u) <= 1.0 + _ROUNDING and abs(v) <= 1.0 + _ROUNDING:
                return chart, 0.5 * (v + 1.0) * rows, 0.5 * (u + 1.0) * columns
        else:
            aside = math.sqrt(right * right + down * down)
            off_axis = math.atan2(aside, forward)
            if off_axis <= second:
                stretch = off_axis / max(aside, _SMALLEST)
                return chart, (down * stretch + second) / first, (right * stretch + second) / first
    return NOWHERE, 0.0, 0.0


@kernel
def _arctangent(y, x):
    """Arc tangent of y / x in the right quadrant, within 2e-8 rad, without a library call.

    References
    ----------
    Abramowitz and Stegun, 4.4.49.
    """
    steep = abs(y) > abs(x)
    low, high = min(abs(x), abs(y)), max(abs(x), abs(y))
    a = low / max(high, _SMALLEST)
    b = a * a
    series = 0.0429096138 + b * (-0.0161657367 + b * 0.0028662257)
    series = -0.1420889944 + b * (0.1065626393 + b * (-0.0752896400 + b * series))
    angle = a * (1.0 + b * (-0.3333314528 + b * (0.1999355085 + b * series)))
    if steep:
        angle = 0.5 * math.pi - angle
    if x < 0.0:
        angle = math.pi - angle
    return -angle if y < 0.0 else angle
