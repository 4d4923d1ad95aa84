"""Where cumuli stand, how large they are, and of which bubbles they consist."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.noise import random_map

_SMALLEST, _LARGEST = 0.14, 1.6
_SIZE_SLOPE = -1.7
_SAMPLES = 192
_CANDIDATES = 6000


class Bubbles(NamedTuple):
    """Spheres of rising air.

    Attributes
    ----------
    centre : ndarray of float64, shape (bubble, 3)
        x and y on the tile and height above the base. [km]
    radius : ndarray of float64, shape (bubble,)
        In km.
    """

    centre: npt.NDArray[np.float64]
    radius: npt.NDArray[np.float64]


class _Cumuli(NamedTuple):
    place: npt.NDArray[np.float64]
    diameter: npt.NDArray[np.float64]
    height: npt.NDArray[np.float64]
    stretch: npt.NDArray[np.float64]
    bearing: npt.NDArray[np.float64]


def cumulus_bubbles(
    cover: float, size: float, depth: float, period: float, seed: int
) -> tuple[Bubbles, Bubbles, Bubbles]:
    """Return three generations of bubbles: towers, bulges on them, and bulges on those.

    Parameters
    ----------
    cover : float
        Share of the tile that their outlines cover, about.
    size, depth : float
        Diameter at which numbers begin to fall faster, and the height of such a cloud. [km]
    period : float
        Of the square tile. [km]
    seed : int
        Another one, other clouds.

    Notes
    -----
    Numbers go with the diameter to the power of -1.7 (Neggers, Jonker and Siebesma 2003, J.
    Atmos. Sci. 60).
    """
    rng = np.random.default_rng([seed, 2])
    cumuli = _placed(rng, cover, size, depth, period, seed)
    towers = _towers(rng, cumuli, size)
    bulges = _bulges(rng, towers, 9, (0.25, 0.62), -0.25, 0.05 * size)
    small = _bulges(rng, bulges, 5, (0.3, 0.6), -0.3, 0.036 * size)
    return towers, bulges, small


def _placed(
    rng: np.random.Generator, cover: float, size: float, depth: float, period: float, seed: int
) -> _Cumuli:
    """Place cumuli, large ones apart and more where the air rises, until the cover is reached."""
    power = _SIZE_SLOPE + 1.0
    low, high = (_SMALLEST * size) ** power, (_LARGEST * size) ** power
    diameters = (low + rng.random(_CANDIDATES) * (high - low)) ** (1.0 / power)
    shape, extent = (_SAMPLES, _SAMPLES), (period, period)
    weather = random_map(shape, extent, _SIZE_SLOPE, (0.3 * size, 0.3 * period), (seed, 3))
    # In a nearly closed deck there are no regions without clouds.
    rising = 1.0 / (1.0 + np.exp(-2.5 * (1.0 - cover) * weather - 4.0 * (cover - 0.5)))
    grid = (np.arange(_SAMPLES) + 0.5) * (period / _SAMPLES)
    covered = np.zeros(shape, bool)
    chosen: list[int] = []
    places = np.empty((_CANDIDATES, 2))
    stretches, bearings = rng.uniform(1.0, 1.7, _CANDIDATES), rng.uniform(0.0, np.pi, _CANDIDATES)
    for i, diameter in enumerate(diameters):
        if covered.mean() >= cover:
            break
        for _ in range(40):
            x, y = rng.random(2) * period
            row, column = int(y / period * _SAMPLES), int(x / period * _SAMPLES)
            if covered[row, column] or rng.random() > rising[row, column]:
                continue
            if chosen:
                apart = np.abs(places[chosen] - (x, y))
                apart = np.hypot(*np.minimum(apart, period - apart).T)
                lanes = (0.5 - 0.4 * cover) * (diameters[chosen] + diameter)
                if (apart < lanes).any() and rng.random() > 0.1 * cover + cover**6:
                    continue
            chosen.append(i)
            places[i] = x, y
            dx, dy = (np.abs(grid - each) for each in (x, y))
            dx, dy = np.minimum(dx, period - dx), np.minimum(dy, period - dy)
            covered |= dx[None] ** 2 + dy[:, None] ** 2 < (0.46 * diameter) ** 2
            break
    taken = np.array(chosen, int)
    diameter = diameters[taken]
    height = depth * np.minimum(1.0, diameter / size) ** 0.8 * rng.uniform(0.55, 1.2, len(taken))
    return _Cumuli(places[taken], diameter, height, stretches[taken], bearings[taken])


def _towers(rng: np.random.Generator, cumuli: _Cumuli, size: float) -> Bubbles:
    """Return columns of bubbles, of which the tallest stands near the middle of its cloud."""
    count = 2 + rng.poisson(2.0 + 5.0 * cumuli.diameter / size)
    of = np.repeat(np.arange(len(count)), count)
    is_first = np.concatenate([[True], of[1:] != of[:-1]]) if len(of) else np.zeros(0, bool)
    diameter = cumuli.diameter[of]
    out = 0.4 * np.sqrt(rng.random(len(of))) * np.where(is_first, 0.4, 1.0)
    phi = rng.uniform(0.0, 2.0 * np.pi, len(of))
    along = out * diameter * np.cos(phi) * cumuli.stretch[of]
    across = out * diameter * np.sin(phi) / cumuli.stretch[of]
    cos, sin = np.cos(cumuli.bearing[of]), np.sin(cumuli.bearing[of])
    foot = cumuli.place[of] + np.stack([cos * along - sin * across, sin * along + cos * across], 1)
    lower = 1.0 - 1.1 * out**1.2
    top = cumuli.height[of] * np.where(is_first, 1.0, lower * rng.uniform(0.35, 1.0, len(of)))
    radius = diameter * rng.uniform(0.1, 0.24, len(of)) * np.where(is_first, 1.2, 1.0)
    lean = rng.normal(0.0, 0.09, (len(of), 2)) * top[:, None]
    rises = np.maximum(1, np.ceil(top / (0.75 * radius)).astype(int))
    tower = np.repeat(np.arange(len(of)), rises)
    step = np.arange(len(tower)) - np.repeat(np.cumsum(rises) - rises, rises)
    share = (step + 0.3) / rises[tower]
    # Towers narrow toward their top, where the youngest air is, and bulge in between.
    r = radius[tower] * rng.uniform(0.7, 1.1, len(tower)) * (1.3 - 0.75 * share**0.8)
    z = np.maximum(0.15 * r, np.minimum(share * top[tower], top[tower] - r))
    wander = rng.normal(0.0, 0.16, (len(tower), 2)) * radius[tower][:, None]
    centre = foot[tower] + lean[tower] * share[:, None] + wander
    return Bubbles(np.column_stack([centre, z]), r)


def _bulges(
    rng: np.random.Generator,
    bubbles: Bubbles,
    count: int,
    sizes: tuple[float, float],
    lowest: float,
    smallest: float,
) -> Bubbles:
    """Return smaller bubbles on bubbles, most of them on their upper halves.

    Parameters
    ----------
    rng : Generator
        Is used up.
    bubbles : Bubbles
        On which they sit.
    count : int
        On each.
    sizes : tuple of float
        Smallest and largest radius, in that of the bubble below; small ones are more.
    lowest : float
        Sine of the elevation of the lowest.
    smallest : float
        Radius below which there are none. [km]
    """
    of = np.repeat(np.arange(len(bubbles.radius)), count)
    share = sizes[0] + (sizes[1] - sizes[0]) * rng.random(len(of)) ** 2
    up = rng.uniform(lowest, 1.0, len(of))
    phi = rng.uniform(0.0, 2.0 * np.pi, len(of))
    out = np.sqrt(1.0 - up**2)
    below = bubbles.radius[of]
    away = below * rng.uniform(0.7, 0.98, len(of))
    direction = np.column_stack([out * np.cos(phi), out * np.sin(phi), up])
    centre = bubbles.centre[of] + away[:, None] * direction
    radius = share * below
    is_kept = (radius >= smallest) & (centre[:, 2] > 0.2 * radius)
    return Bubbles(centre[is_kept], radius[is_kept])
