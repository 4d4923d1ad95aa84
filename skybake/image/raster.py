"""Canvases filled with the light of a scene, band by band."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from skybake.image.discs import shown_moon, shown_sun
from skybake.image.layers import RGB, Layer, Layers, Pixels
from skybake.image.scene import Scene
from skybake.image.splat import Splat
from skybake.projection.chart import Canvas, Chart, Part

if TYPE_CHECKING:
    from skybake.image.starry import StarSpots

CHANNELS = {
    "sky": RGB,
    "sun": RGB,
    "apart": (*RGB, "clouded.R", "clouded.G", "clouded.B", "A"),
    "transmittance": RGB,
    "moon": RGB,
    "stars": RGB,
    "stokes": ("S1.R", "S1.G", "S1.B", "S2.R", "S2.G", "S2.B"),
}
"""Layers that a raster fills: the sky with its clouds; the sun's disc; the clear sky, the sky with
its clouds, and the share that they hide; the transmittance of the air to space; the Moon's disc;
stars; and the polarisation of the sky."""

Evaluate = Callable[[np.ndarray, np.ndarray, np.ndarray], Pixels]

LOOKS_AT_ONCE = 16
"""Rows whose directions a thread finds at a time."""

LIMB_SAMPLES = 16
LIMB_COARSE = 0.05


class Raster:
    """The picture of a scene on a canvas.

    Parameters
    ----------
    scene : Scene
        What is shown.
    canvas : Canvas
        Where its pixels look.

    Attributes
    ----------
    peak : float
        Largest value that a disc or a star adds to a pixel.
    """

    def __init__(self, scene: Scene, canvas: Canvas) -> None:
        self._scene = scene
        self.canvas = canvas
        self._shown = [_Shown(scene, part) for part in canvas.parts]
        self.peak = max(each.peak for each in self._shown)

    def rows(self, first: int, last: int) -> Pixels:
        """Light of all layers in the rows first..last, shape (last - first, width, 3)."""
        pixels = self.layers(first, last).added()
        if self._scene.settings.encoding.clamp_negative:
            np.maximum(pixels, 0.0, out=pixels)
        return pixels

    def layers(self, first: int, last: int) -> Layers:
        """Layers of the rows first..last."""
        planes = []
        for name in self._scene.layer_names:
            plane = self._plane(name, first, last)
            if plane is not None:
                planes.append(plane)
        return Layers(last - first, self.canvas.width, tuple(planes))

    def band(self, name: str, first: int, last: int) -> Pixels:
        """Return one layer of the rows first..last, of those of `CHANNELS`."""
        plane = self._plane(name, first, last)
        if plane is None:
            return np.zeros((last - first, self.canvas.width, len(CHANNELS[name])), np.float32)
        whole = Layers(last - first, self.canvas.width, (plane,)).plane(name)
        return np.zeros(0, np.float32) if whole is None else whole

    def _plane(self, name: str, first: int, last: int) -> Layer | None:
        if len(self._shown) == 1:
            return self._shown[0].plane(name, first, last)
        channels = CHANNELS[name]
        pixels = np.zeros((last - first, self.canvas.width, len(channels)), np.float32)
        for shown in self._shown:
            shown.fill(name, first, last, pixels)
        return Layer(name, channels, 0, pixels)


class _Shown:
    """A part of a canvas, and the part of the scene that it shows."""

    def __init__(self, scene: Scene, part: Part) -> None:
        self._scene, self._part = scene, part
        self._chart = part.chart
        self._points: dict[str, Splat | StarSpots] = {
            "sun": Splat(shown_sun(scene), part.chart),
            "moon": Splat(shown_moon(scene), part.chart),
        }
        if "stars" in scene.layer_names:
            from skybake.image.starry import StarSpots

            self._points["stars"] = StarSpots(scene, part.chart)
        self.peak = max(each.peak for each in self._points.values())

    def plane(self, name: str, first: int, last: int) -> Layer | None:
        """Return a layer of the chart's rows first..last, or None where it is black."""
        if name in self._points:
            begin, pixels = self._points[name].rows(first, last)
            return Layer(name, RGB, begin, pixels) if len(pixels) else None
        evaluate = _EVALUATE[name]
        pixels = evaluate(self._scene, self._chart, first, last)
        return Layer(name, CHANNELS[name], 0, pixels)

    def fill(self, name: str, first: int, last: int, out: Pixels) -> None:
        """Write a layer into a band of the canvas that begins at row `first`."""
        part, chart = self._part, self._chart
        begin, end = max(first, part.row), min(last, part.row + chart.height)
        if begin >= end:
            return
        low, high = begin - part.row, end - part.row
        if part.flip in {"rows", "both"}:
            low, high = chart.height - high, chart.height - low
        plane = self.plane(name, low, high)
        if plane is None:
            return
        place = out[begin - first : end - first, part.column : part.column + chart.width]
        if part.flip in {"rows", "both"}:
            place = place[::-1]
        if part.flip in {"columns", "both"}:
            place = place[:, ::-1]
        place[plane.first_row : plane.first_row + len(plane.pixels)] = plane.pixels


def sky_pixels(scene: Scene, chart: Chart, first: int, last: int) -> Pixels:
    """Light of the sky and the ground in a chart's rows, without the sun's disc, RGB."""
    return _smooth_pixels(scene, chart, first, last, _seen(scene, scene.evaluate))


def _apart_pixels(scene: Scene, chart: Chart, first: int, last: int) -> Pixels:
    from skybake.image.apart import evaluate_apart

    evaluate = _seen(scene, partial(evaluate_apart, scene))
    return _smooth_pixels(scene, chart, first, last, evaluate)


def _seen(scene: Scene, evaluate: Evaluate) -> Evaluate:
    """Return what evaluates pixels with what the view shows below the horizon."""
    if scene.settings.view.below_horizon == "ground":
        return evaluate
    from skybake.image.below_horizon import without_ground

    return without_ground(scene, evaluate)


def _transmittance_pixels(scene: Scene, chart: Chart, first: int, last: int) -> Pixels:
    from skybake.image.apart import evaluate_transmittance

    return _smooth_pixels(scene, chart, first, last, partial(evaluate_transmittance, scene))


def _stokes_pixels(scene: Scene, chart: Chart, first: int, last: int) -> Pixels:
    from skybake.image.polarised import evaluate_stokes

    evaluate = _seen(scene, partial(evaluate_stokes, scene))
    return _smooth_pixels(scene, chart, first, last, evaluate)


_EVALUATE: dict[str, Callable[[Scene, Chart, int, int], Pixels]] = {
    "sky": sky_pixels,
    "apart": _apart_pixels,
    "transmittance": _transmittance_pixels,
    "stokes": _stokes_pixels,
}


def _smooth_pixels(scene: Scene, chart: Chart, first: int, last: int, evaluate: Evaluate) -> Pixels:
    zenith, bearing, footprint = _looks(scene, chart, first, last)
    azimuth = bearing - scene.sun_bearing
    pixels = evaluate(zenith, azimuth, footprint)
    limb = _limb(scene, zenith, footprint)
    if limb.any():
        _smooth_limb(evaluate, zenith, azimuth, footprint, limb, pixels)
    nowhere = chart.looks_nowhere(first, last)
    if nowhere is not None:
        pixels[nowhere] = 0.0
    return pixels


def _looks(
    scene: Scene, chart: Chart, first: int, last: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """As of a chart, found by all workers where each pixel has directions of its own."""
    if chart.is_separable or last - first <= LOOKS_AT_ONCE:
        return chart.looks(first, last)
    found = {}

    def work(begin: int, end: int) -> None:
        found[begin] = chart.looks(first + begin, first + end)

    scene.workers.run_rows(last - first, work, chunk=LOOKS_AT_ONCE)
    # What all rows share is in each part.
    zenith, bearing, footprint = (
        each[0] if len(each[0]) < LOOKS_AT_ONCE else np.concatenate(each)
        for each in zip(*(found[begin] for begin in sorted(found)), strict=True)
    )
    return zenith, bearing, footprint


def _limb(scene: Scene, zenith: np.ndarray, footprint: np.ndarray) -> np.ndarray:
    """Pixels that hold a part of the limb, where the limb is only a few pixels high."""
    first, last = scene.table.zenith_first, scene.table.zenith_horizon
    if first == 0.0:
        return np.zeros(zenith.shape, np.bool_)
    is_coarse = footprint >= LIMB_COARSE * (last - first)
    overlaps: np.ndarray = (zenith + 0.5 * footprint > first) & (zenith - 0.5 * footprint < last)
    return overlaps & is_coarse


def _smooth_limb(
    evaluate: Evaluate,
    zenith: np.ndarray,
    azimuth: np.ndarray,
    footprint: np.ndarray,
    limb: np.ndarray,
    pixels: Pixels,
) -> None:
    """Evaluate pixels at the limb by several samples each.

    Seen from space the atmosphere is a thin line; within a pixel it falls from bright to black.
    """
    shape = pixels.shape[:2]
    across = (np.arange(LIMB_SAMPLES) + 0.5) / LIMB_SAMPLES - 0.5
    height = np.broadcast_to(footprint, zenith.shape)[limb][:, None]
    fine = zenith[limb][:, None] + height * across
    if zenith.shape[1] == 1:
        samples = evaluate(
            fine.reshape(-1, 1), azimuth, np.repeat(height, LIMB_SAMPLES, 0) / LIMB_SAMPLES
        )
        pixels[limb[:, 0]] = samples.reshape(-1, LIMB_SAMPLES, shape[1], pixels.shape[2]).mean(
            axis=1
        )
        return
    around = np.broadcast_to(azimuth, shape)[limb]
    around = np.broadcast_to(around[:, None], fine.shape)
    pixels[limb] = evaluate(fine, around, height / LIMB_SAMPLES).mean(axis=1)
