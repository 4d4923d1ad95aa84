"""Maps in another projection, size or rotation, with the energy that they have."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from skybake.environment.bright import Bright, add_missed, bright_texels, gains_of
from skybake.environment.environment import Environment, Pixels, charts_of, flat_pixels
from skybake.environment.gather import Source, Target, add_excess, gather, receive
from skybake.environment.layout import Layout, layout_of
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.projection.chart import Chart, Projection
from skybake.projection.fisheye import Fisheye
from skybake.projection.perspective import Perspective

SAMPLES_PER_TEXEL = 1.5
"""Samples of the new map across a texel of the old one; at least two are across its own pixels."""

FEWEST_SAMPLES, FEW_PER_TEXEL, FEW_SAMPLES = 1e6, 8, 3e6
"""Of a whole map: where texels are few each has to count right, as long as that is quick."""

CHUNKS = 32
"""Parts of a chart's rows that are worked on apart, whatever the number of threads, so that sums
have the same bits."""

_PARTIAL = (Fisheye, Perspective)

_SURVEYED_ROWS = 64
_WHOLE = 0.01


def resample(
    environment: Environment,
    projection: Projection,
    rotation: float = 0.0,
    workers: Workers = ALL_CPUS,
) -> Environment:
    """Lay a map out anew.

    Parameters
    ----------
    environment : Environment
        The map.
    projection : Projection
        Where the new pixels look.
    rotation : float, optional
        Compass bearing that the new map's -Z looks to. [rad]
    workers : Workers, optional
        Threads that do the work; the result has the same bits for any number.

    Returns
    -------
    Environment
        Its energy, the sum of pixels times solid angles, is that of the old one within 0.1 %,
        if both show the whole sphere. Directions that the old one does not show are black.

    Raises
    ------
    CancelledError
        If the workers were stopped.

    Notes
    -----
    Pixels that are as large as texels, or larger, are means of the texels under them, so that a
    map in its own projection, size and rotation stays as it is. Smaller ones blend neighbours, also
    over the edges of faces and the poles.
    """
    pixels = flat_pixels(environment.pixels)
    ratio = math.sqrt(_pixel_size(projection) / _pixel_size(environment.projection))
    turn = rotation - environment.rotation
    bright = bright_texels(environment.projection, pixels, workers)
    source = Source(
        layout_of(environment.projection),
        pixels,
        min(max(2.0 * (1.0 - ratio), 0.0), 1.0),
        math.cos(turn),
        math.sin(turn),
        bright.threshold,
        bright.texel,
    )
    fineness = _fineness(projection, ratio, len(pixels))
    pictures = _collect(projection, source, bright, fineness, workers)
    return replace(
        environment,
        pixels=pictures,
        projection=projection,
        rotation=rotation,
        warnings=(*environment.warnings, *_black(environment.projection, projection)),
    )


def _black(old: Projection, new: Projection) -> tuple[str, ...]:
    """Say how much of the sphere a map does not show that another is made of."""
    if not isinstance(old, _PARTIAL) or isinstance(new, _PARTIAL):
        return ()
    seen = sum(
        float(np.broadcast_to(sizes, (len(sizes), chart.width)).sum())
        for canvas in old.canvases()
        for chart in (part.chart for part in canvas.parts)
        for sizes in (chart.solid_angles(0, chart.height),)
    )
    missing = 1.0 - seen / (4.0 * math.pi)
    return (f"{missing:.0%} of all directions are black, which the {old.name} map does not show",)


@dataclass
class _Job:
    """Some rows of a chart, and their place in a picture."""

    target: Target
    chart: Chart
    place: Pixels
    touched: npt.NDArray[np.bool_] | None = None


def _collect(
    projection: Projection,
    source: Source,
    bright: Bright,
    fineness: tuple[int, int],
    workers: Workers,
) -> tuple[Pixels, ...]:
    layout = layout_of(projection)
    pictures = tuple(
        np.zeros((canvas.height, canvas.width, 3), np.float32) for canvas in projection.canvases()
    )
    jobs = list(_jobs(projection, layout, pictures, fineness))
    received = np.zeros((len(jobs), bright.texel.size))

    def collect(first: int, last: int) -> None:
        for job, seen in zip(jobs[first:last], received[first:last], strict=True):
            _gather(job, source, seen)

    workers.run_rows(len(jobs), collect)
    total = received.sum(axis=0)
    gains = gains_of(bright, total, source, layout)

    def finish(first: int, last: int) -> None:
        for job in jobs[first:last]:
            if job.touched is not None:
                pixels = np.ascontiguousarray(job.place)
                add_excess(job.target, source, gains, job.touched, pixels)
                job.place[...] = pixels

    workers.run_rows(len(jobs), finish)
    add_missed(bright, total, source, projection, pictures)
    return pictures


def _gather(job: _Job, source: Source, received: npt.NDArray[np.float64]) -> None:
    rows, columns, _ = job.place.shape
    first, last = job.target.first, job.target.first + rows
    pixels, touched = np.empty((rows, columns, 3), np.float32), np.empty((rows, columns), np.bool_)
    gather(job.target, source, pixels, touched)
    nowhere = job.chart.looks_nowhere(first, last)
    if nowhere is not None:
        pixels[nowhere], touched[nowhere] = 0.0, False
    job.place[...] = pixels
    if touched.any():
        job.touched = touched
        sizes = np.ascontiguousarray(job.chart.solid_angles(first, last))
        receive(job.target, source, touched, sizes, received)


def _jobs(
    projection: Projection, layout: Layout, pictures: tuple[Pixels, ...], fineness: tuple[int, int]
) -> Iterator[_Job]:
    for number, (chart, place) in enumerate(charts_of(projection, pictures)):
        step = -(-chart.height // CHUNKS)
        for first in range(0, chart.height, step):
            rows = place[first : first + step]
            yield _Job(Target(layout, number, first, *fineness), chart, rows)


def _fineness(projection: Projection, ratio: float, texels: int) -> tuple[int, int]:
    """Return the samples across a pixel, given its width in texels, and their divisor.

    Pixels that may consist of whole texels have as many samples in each.
    """
    count = sum(canvas.width * canvas.height for canvas in projection.canvases())
    samples = max(FEWEST_SAMPLES, min(FEW_PER_TEXEL * texels, FEW_SAMPLES))
    across = max(2.0, SAMPLES_PER_TEXEL * ratio, math.sqrt(samples / count))
    multiple = round(ratio) if ratio > 1.0 and abs(ratio / round(ratio) - 1.0) < _WHOLE else 1
    return multiple * math.ceil(across / multiple), multiple


def _pixel_size(projection: Projection) -> float:
    """Solid angle of a pixel, the mean over some rows of a chart. [sr]"""
    chart = projection.canvases()[0].parts[0].chart
    rows = np.linspace(0, chart.height - 1, min(chart.height, _SURVEYED_ROWS)).astype(int)
    sizes = np.concatenate([chart.solid_angles(row, row + 1).ravel() for row in rows.tolist()])
    return float(sizes[sizes > 0.0].mean())
