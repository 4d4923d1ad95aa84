"""Airglow: light that the upper air of Earth emits by itself."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from skybake.optics.medium import Array

_TABLE = Path(__file__).parents[1] / "data" / "night" / "airglow.csv"
_FIRST_ROW = 5

RAYLEIGH = 1e10 / (4.0 * math.pi)
"""Photons of 1 R. [m⁻² s⁻¹ sr⁻¹]"""

PHOTON_ENERGY = 6.62607015e-34 * 299792458.0 / 1e-9
"""Energy of a photon times its wavelength. [J nm]"""

CONTINUUM_STEP = 10.0
"""Wavelengths between which the continuum is summed as lines. [nm]"""

STEPS = 48
"""Points in a layer along a ray."""


class Layer(NamedTuple):
    """Emission at one height.

    Attributes
    ----------
    height, spread : float
        Of the layer's middle above the ground, and its standard deviation. [km]
    wavelengths, radiance : ndarray of float64, shape (line,)
        Lines [nm] and their radiance in the zenith [W m⁻² sr⁻¹].
    """

    height: float
    spread: float
    wavelengths: Array
    radiance: Array


@cache
def airglow_layers() -> tuple[Layer, ...]:
    """Return the layers about 92 and 250 km, at scale 1.

    Between them are the green line at 97 km, sodium, OH and the continuum, which share a layer of
    9 km, and the red lines of oxygen, whose layer is 60 km thick (half widths).
    """
    rows = [
        line.split(",") for line in _TABLE.read_text(encoding="utf-8").splitlines()[_FIRST_ROW:]
    ]
    lines = [
        (float(wavelength), float(rayleigh), float(height))
        for kind, wavelength, rayleigh, height in rows
        if kind != "continuum"
    ]
    nodes, levels = np.array([row[1:3] for row in rows if row[0] == "continuum"], float).T
    steps = np.arange(nodes[0], nodes[-1] + CONTINUUM_STEP, CONTINUUM_STEP)
    # Ten ångströms are a nanometre.
    per_step = np.interp(steps, nodes, levels) * 10.0 * CONTINUUM_STEP
    lines += [(*each, 90.0) for each in zip(steps, per_step, strict=True)]
    wavelengths, rayleighs, heights = np.array(lines).T
    radiance = rayleighs * RAYLEIGH * PHOTON_ENERGY / wavelengths
    is_high = heights > 150.0
    half_width = 2.0 * math.sqrt(2.0 * math.log(2.0))
    return (
        Layer(92.0, 9.0 / half_width, wavelengths[~is_high], radiance[~is_high]),
        Layer(250.0, 60.0 / half_width, wavelengths[is_high], radiance[is_high]),
    )


def path_through(layer: Layer, r_bottom: float, radius: float, mu: Array) -> tuple[Array, Array]:
    """Length of rays in a layer over its thickness, before and behind the point closest to Earth.

    Parameters
    ----------
    layer : Layer
        A layer with a density that is a Gaussian of the height.
    r_bottom, radius : float
        Distances of the ground and of the observer from the planet's centre. [km]
    mu : ndarray of float64, shape (ray,)
        Cosines of zenith angles.

    Returns
    -------
    near, far : ndarray of float64, shape (ray,)
        1 and 0 make what is seen in the zenith from below. What is far is seen through the air
        below the layer, unless the ground hides it.
    """
    closest = radius * np.sqrt(np.maximum(1.0 - mu * mu, 0.0))
    turn = np.maximum(-radius * mu, 0.0)
    hits = (mu < 0.0) & (closest < r_bottom)
    # Heights, rather than distances, at even quantiles: rays graze the layer in any way.
    edges = layer.height + layer.spread * np.linspace(-3.5, 3.5, STEPS + 1)
    total = np.zeros((2, mu.size))
    for low, high in pairwise(edges.tolist()):
        height = 0.5 * (low + high)
        density = math.exp(-0.5 * ((height - layer.height) / layer.spread) ** 2)
        density /= layer.spread * math.sqrt(2.0 * math.pi)
        below, above = (
            np.sqrt(np.maximum((r_bottom + edge) ** 2 - closest**2, 0.0)) for edge in (low, high)
        )
        # Along the ray, counted from the closest point: from -above to -below, and back.
        start = radius * mu
        ahead = np.clip(-below, start, None) - np.clip(-above, start, None)
        behind = np.clip(above, start, None) - np.clip(below, start, None)
        total[0] += density * np.where(turn > 0.0, ahead, 0.0)
        total[1] += density * np.where(hits, 0.0, behind)
    return total[0], total[1]
