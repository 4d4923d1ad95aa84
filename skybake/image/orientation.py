"""A picture of directions, by which one sees whether a program opens maps the right way round."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.angles import direction_from_angles
from skybake.formats.lettering import draw_text, text_width
from skybake.image.settings import MapSettings
from skybake.image.target_model import TargetAxes
from skybake.projection.chart import Chart

Array = npt.NDArray[np.float64]

_LETTERS = 96
_STEP = math.radians(30.0)
_LINE = math.radians(0.25)
_RING = math.radians(3.0)
_OWN_AXES = TargetAxes(east="+X", north="-Z", up="+Y")
_INK, _PAPER, _SUN = (1.0, 1.0, 1.0), (0.02, 0.02, 0.02), (1.0, 0.85, 0.2)


class _Label(NamedTuple):
    """Text on a plane that touches the sphere of directions.

    Attributes
    ----------
    mask : ndarray of float64, shape (row, column)
        Opacity of the ink.
    right, up, forward : ndarray of float64, shape (3,)
        TargetAxes of the plane; forward is where it touches.
    half_width, half_height : float
        Of the mask on the plane, as tangents.
    """

    mask: Array
    right: Array
    up: Array
    forward: Array
    half_width: float
    half_height: float


def direction_colours(directions: Array) -> Array:
    """Return red, green, blue = 1/2 + d / 2 of directions d: toward east, up and south."""
    return 0.5 + 0.5 * directions


class Orientation:
    """The picture: colours of directions and, if it is lettered, what people look for.

    Parameters
    ----------
    settings : MapSettings
        Of the map whose place it takes. Its rotation counts, and where the sun is.
    is_lettered : bool
        Draw lines each 30 degrees, points of the compass, axes and the sun on the colours.
    """

    def __init__(self, settings: MapSettings, *, is_lettered: bool = True) -> None:
        self._rotation = settings.view.rotation
        lighting = settings.lighting
        self._sun = direction_from_angles(lighting.sun_azimuth, lighting.sun_elevation)
        self._labels = tuple(_labels(settings, self._sun)) if is_lettered else None

    def rows(self, chart: Chart, first: int, last: int) -> npt.NDArray[np.float32]:
        """Return the rows first..last of a chart, shape (row, column, 3), from 0 to 1."""
        zenith, bearing = np.broadcast_arrays(*chart.angles(first, last))
        directions = direction_from_angles(bearing + self._rotation, math.pi / 2.0 - zenith)
        pixels = direction_colours(directions)
        if self._labels is not None:
            footprint = np.broadcast_to(chart.footprints(first, last), zenith.shape)
            _draw_lines(pixels, directions, footprint)
            toward_sun = directions @ self._sun
            _mix(pixels, _ring(toward_sun, footprint, 2.5 * _LINE), _PAPER)
            _mix(pixels, _ring(toward_sun, footprint, _LINE), _SUN)
            for label in self._labels:
                _draw(pixels, directions, label)
        nowhere = chart.looks_nowhere(first, last)
        if nowhere is not None:
            pixels[nowhere] = 0.0
        return pixels.astype(np.float32)


def _labels(settings: MapSettings, sun: Array) -> Iterator[_Label]:
    axes, north = _axes(settings)
    for i, (point, axis) in enumerate(
        (
            ("N", axes.north),
            ("E", axes.east),
            ("S", _opposite(axes.north)),
            ("W", _opposite(axes.east)),
        )
    ):
        yield _upright(point, i * math.pi / 2.0, 9.0, 12.0)
        yield _upright(axis, north + i * math.pi / 2.0, -8.0, 8.0)
    for degrees in range(0, 360, 30):
        if degrees % 90:
            yield _upright(str(degrees), math.radians(degrees), 3.5, 4.5)
    # With their tops to the north, as on a map below and as seen by one who lies on the back.
    tops = np.array([0.0, 0.0, -1.0])
    for text, axis, y in (("UP", axes.up, 1.0), ("DOWN", _opposite(axes.up), -1.0)):
        yield _on_plane(f"{text} {axis}", np.array([0.0, y, 0.0]), tops, math.radians(9.0))
    bearing, height = math.atan2(sun[0], -sun[2]), math.degrees(math.asin(sun[1]))
    yield _upright("sun", bearing, max(height - 6.5, -89.0), 5.0)
    if settings.encoding.target is not None:
        for i in range(4):
            yield _upright(f"for {settings.encoding.target}", i * math.pi / 2.0, -20.0, 5.0)


def _axes(settings: MapSettings) -> tuple[TargetAxes, float]:
    """Return the axes whose names stand on the picture, and the bearing that is their north."""
    view, name = settings.view, settings.encoding.target
    if name is None:
        return _OWN_AXES, view.rotation
    from skybake.image.target import find_target

    target = find_target(name)
    return target.axes, view.rotation - target.turn(view.projection.name)


def _opposite(axis: str) -> str:
    return ("-" if axis[0] == "+" else "+") + axis[1:]


def _upright(text: str, bearing: float, elevation: float, height: float) -> _Label:
    """Return level text at a bearing [rad] and an elevation, of a height [both deg]."""
    lift = math.radians(elevation)
    forward = direction_from_angles(bearing, lift)
    up = direction_from_angles(bearing, lift + math.pi / 2.0)
    return _on_plane(text, forward, up, math.radians(height))


def _on_plane(text: str, forward: Array, up: Array, height: float) -> _Label:
    margin = _LETTERS // 3
    width = text_width(text, _LETTERS) + 2 * margin
    pixels = np.zeros((_LETTERS + 2 * margin, width, 3), np.uint8)
    draw_text(pixels, text, margin, margin + round(0.87 * _LETTERS), _LETTERS, (1.0, 1.0, 1.0))
    half_height = math.tan(0.5 * height) * pixels.shape[0] / _LETTERS
    return _Label(
        mask=pixels[..., 0] / 255.0,
        right=np.cross(forward, up),
        up=up,
        forward=forward,
        half_width=half_height * width / pixels.shape[0],
        half_height=half_height,
    )


def _draw(pixels: Array, directions: Array, label: _Label) -> None:
    """Draw a label in white with a dark edge on the pixels that show it."""
    before = directions @ label.forward
    reach = math.atan(math.hypot(label.half_width, label.half_height))
    row, column = np.nonzero(before > math.cos(reach))
    if not row.size:
        return
    seen = directions[row, column] / before[row, column, None]
    rows, columns = label.mask.shape
    x = ((seen @ label.right / label.half_width + 1.0) * 0.5 * columns).astype(np.int64)
    y = ((1.0 - seen @ label.up / label.half_height) * 0.5 * rows).astype(np.int64)
    inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
    row, column, x, y = row[inside], column[inside], x[inside], y[inside]
    spot = pixels[row, column]
    edge = max(1, _LETTERS // 16)
    outline = np.zeros(x.shape)
    for down in (-edge, 0, edge):
        for along in (-edge, 0, edge):
            near = label.mask[np.clip(y + down, 0, rows - 1), np.clip(x + along, 0, columns - 1)]
            outline = np.maximum(outline, near)
    _mix(spot, outline, _PAPER)
    _mix(spot, label.mask[y, x], _INK)
    pixels[row, column] = spot


def _draw_lines(pixels: Array, directions: Array, footprint: Array) -> None:
    """Draw lines of equal bearing and elevation each 30 degrees, and the horizon brighter."""
    x, y, z = np.moveaxis(directions, -1, 0)
    elevation = np.arcsin(np.clip(y, -1.0, 1.0))
    bearing = np.arctan2(x, -z)
    aside = np.abs(bearing - _STEP * np.round(bearing / _STEP)) * np.hypot(x, z)
    beside = np.abs(elevation - _STEP * np.round(elevation / _STEP))
    _mix(pixels, 0.5 * _covered(np.minimum(aside, beside), footprint), _PAPER)
    _mix(pixels, _covered(np.abs(elevation), footprint), _INK)


def _ring(cosine: Array, footprint: Array, half_width: float) -> Array:
    """Opacity of a ring around the sun, and of a spot where it is."""
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    ring = _covered(np.abs(angle - _RING), footprint, half_width)
    return np.maximum(ring, _covered(angle, footprint, 2.0 * half_width))


def _covered(distance: Array, footprint: Array, half_width: float = _LINE) -> Array:
    """Share of a pixel that a line covers, at least a pixel wide, by the distance of its middle."""
    reach = np.maximum(half_width, 0.5 * footprint)
    share: Array = np.clip((reach - distance) / footprint + 0.5, 0.0, 1.0)
    return share


def _mix(pixels: Array, opacity: Array, colour: tuple[float, float, float]) -> None:
    pixels += opacity[..., None] * (np.array(colour) - pixels)
