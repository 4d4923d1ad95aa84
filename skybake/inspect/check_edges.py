"""Whether pictures go on where their edges meet: poles, the back of a map, edges of a cube."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from skybake.inspect.finding import Finding
from skybake.inspect.seen import Seen
from skybake.projection.cells import Array
from skybake.projection.cubemap import FaceChart
from skybake.projection.equirect import EquirectChart

TIMES = 4.0
"""How many times the usual step from texel to texel a step across an edge may be."""

QUANTILE = 0.75
"""Of steps, that is compared: ground is often flat, and a sun on an edge is seldom long."""

FLAT = 0.02
"""Step that is none, as a share of the mean."""

_SAMPLES = 32
_FACES = 6


def edge_findings(seen: Sequence[Seen]) -> Iterator[Finding]:
    """Yield edges of a map at which its pictures do not go on.

    Parameters
    ----------
    seen : sequence of Seen
        An equirect map, or six faces; nothing is found in others.
    """
    if len(seen) == 1 and isinstance(seen[0].chart, EquirectChart):
        grey = seen[0].rgb.mean(axis=2, dtype=np.float64)
        yield from _wrap_findings(grey)
        yield from _pole_findings(grey)
    elif len(seen) == _FACES and all(isinstance(one.chart, FaceChart) for one in seen):
        yield from _cube_findings(seen)


def _wrap_findings(grey: Array) -> Iterator[Finding]:
    seam = np.abs(grey[:, 0] - grey[:, -1])
    inner = 0.5 * (np.abs(grey[:, 1] - grey[:, 0]) + np.abs(grey[:, -1] - grey[:, -2]))
    step, usual = _relative(seam, grey), _relative(inner, grey)
    if step > TIMES * usual + FLAT:
        yield Finding(
            "wrap", True, f"the left and the right edge differ by {_percent(step, usual)}"
        )


def _pole_findings(grey: Array) -> Iterator[Finding]:
    half = grey.shape[1] // 2
    if len(grey) < 3:
        return
    for name, (row, second, third) in (("first", grey[:3]), ("last", grey[:-4:-1])):
        across = np.abs(row - np.roll(row, half))
        both = np.stack([row, second])
        step, usual = _relative(across, both), _relative(np.abs(second - third), both)
        if step > TIMES * usual + FLAT:
            yield Finding(
                "pole",
                True,
                f"opposite pixels of the {name} row, around the pole, differ by "
                f"{_percent(step, usual)}",
            )


def _cube_findings(seen: Sequence[Seen]) -> Iterator[Finding]:
    greys = [one.rgb.mean(axis=2, dtype=np.float64) for one in seen]
    borders = [_border(one, grey) for one, grey in zip(seen, greys, strict=True)]
    edge = seen[0].chart.width
    reach = math.cos(2.0 * math.pi / 2.0 / edge)
    steps: list[Array] = []
    for i, (vectors, values, _) in enumerate(borders):
        others = [one for j, one in enumerate(borders) if j != i]
        near = np.concatenate([one[0] for one in others])
        beyond = np.concatenate([one[1] for one in others])
        chosen = np.linspace(0, len(values) - 1, min(len(values), 4 * _SAMPLES)).astype(int)
        cosine = vectors[chosen] @ near.T
        nearest = cosine.argmax(axis=1)
        is_beside = cosine[np.arange(len(chosen)), nearest] > reach
        steps.append(np.abs(values[chosen] - beyond[nearest])[is_beside])
    for i, (each, (_, level, inner)) in enumerate(zip(steps, borders, strict=True)):
        step, usual = _relative(each, level), _relative(inner, level)
        if step > TIMES * usual + FLAT:
            yield Finding(
                "cube-edges",
                True,
                f"the face toward {_axis(borders[i][0])} and its neighbours differ by "
                f"{_percent(step, usual)}",
            )


def _border(one: Seen, grey: Array) -> tuple[Array, Array, Array]:
    """Directions and values of the texels at a face's edges, and their steps inward."""
    vectors = one.vectors()
    sides = (
        ((0, slice(None)), (1, slice(None))),
        ((-1, slice(None)), (-2, slice(None))),
        ((slice(None), 0), (slice(None), 1)),
        ((slice(None), -1), (slice(None), -2)),
    )
    if len(grey) == 1:
        return vectors[0], grey[0], np.zeros(1)
    return (
        np.concatenate([vectors[outer] for outer, _ in sides]),
        np.concatenate([grey[outer] for outer, _ in sides]),
        np.concatenate([np.abs(grey[outer] - grey[inner]) for outer, inner in sides]),
    )


def _axis(vectors: Array) -> str:
    """Name of the axis in the middle of directions."""
    middle = vectors.mean(axis=0)
    axis = int(np.abs(middle).argmax())
    return f"{'+' if middle[axis] > 0.0 else '-'}{'XYZ'[axis]}"


def _relative(steps: Array, level: Array) -> float:
    mean = float(np.abs(level).mean())
    return float(np.quantile(steps, QUANTILE)) / mean if mean > 0.0 and steps.size else 0.0


def _percent(step: float, usual: float) -> str:
    return f"{step:.1%} of the mean, and neighbours elsewhere by {usual:.1%}"
