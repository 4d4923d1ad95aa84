"""Where light comes from, roughly: decides where paths are sent, never what they carry.

Every path is weighted by the probability that it was drawn with, so this model may be as coarse
as it likes: it moves the noise, not the mean. It is positive wherever light might be.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.reference.air import Air
from skybake.reference.directions import uniform
from skybake.reference.rays import (
    altitude_on_ray,
    distance_from_tangent,
    hits_ground,
    node_value,
    shell_of,
    tangent_altitude,
    transmittance_to_space,
)

ALTITUDES = 17
SUNS = 97
ELEVATIONS = 12
AZIMUTHS = 5
CELLS = ELEVATIONS * AZIMUTHS
STEPS = 16
ORDERS = 2


class Guide(NamedTuple):
    """A rough light field over altitude and the sun's zenith angle.

    Altitudes are quadratic from 0 to `top`, sun cosines quadratic away from the
    horizon.

    Attributes
    ----------
    direct : ndarray of float64, shape (ALTITUDES, SUNS)
        Transmittance toward the sun.
    ambient : ndarray of float64, shape (ALTITUDES, SUNS)
        4 pi times the mean radiance of scattered light.
    cells : ndarray of float64, shape (ALTITUDES, SUNS, ELEVATIONS * AZIMUTHS)
        Running sum of the probability that a direction is drawn in each cell.
    top : float
        Altitude of the top of the atmosphere. [km]
    """

    direct: npt.NDArray[np.float64]
    ambient: npt.NDArray[np.float64]
    cells: npt.NDArray[np.float64]
    top: float


def make_guide(air: Air) -> Guide:
    """Light field of isotropic scattering, by a few orders, steps and rays."""
    nodes = (ALTITUDES, SUNS)
    # Every place is lit a little, or no path would lead where the model is dark.
    ambient, cells = np.full(nodes, 1e-12), np.empty((*nodes, CELLS))
    guide = Guide(np.empty(nodes), ambient, cells, float(air.altitude[-1]))
    _fill_guide(air, guide, np.empty(nodes), np.empty(CELLS))
    return guide


@kernel
def _fill_guide(air, guide, next_ambient, radiance):
    for i in range(ALTITUDES):
        for j in range(SUNS):
            mu_s = _square(j, SUNS - 1)
            guide.direct[i, j] = transmittance_to_space(air, _altitude(i, guide.top), mu_s)
    for _ in range(ORDERS):
        for i in range(ALTITUDES):
            for j in range(SUNS):
                next_ambient[i, j] = _gather(air, guide, i, j, radiance)
        for i in range(ALTITUDES):
            for j in range(SUNS):
                guide.ambient[i, j] = next_ambient[i, j]
    _add_diffusion(air, guide)


@kernel
def _add_diffusion(air, guide):
    """Light that diffuses through a thick atmosphere, as 1 / depth; few orders leave it dark."""
    k_last = len(air.altitude) - 1
    for i in range(ALTITUDES):
        h = _altitude(i, guide.top)
        depth = 0.0
        for k in range(shell_of(air.altitude, h), k_last):
            thickness = air.altitude[k + 1] - max(h, air.altitude[k])
            depth += 0.5 * (air.extinction[k] + air.extinction[k + 1]) * max(0.0, thickness)
        for j in range(SUNS):
            mu_s = max(0.0, _square(j, SUNS - 1))
            # Only the excess over depth 1, so that a thin atmosphere keeps what was gathered.
            guide.ambient[i, j] += mu_s * max(0.0, depth - 1.0) / (1.0 + depth) ** 2


@kernel
def _gather(air, guide, i, j, radiance):
    """Fill the directions of one node from the guide's last state; returns its ambient light."""
    h = _altitude(i, guide.top)
    mu_s = _square(j, SUNS - 1)
    mean = 1e-12
    for cell in range(CELLS):
        radiance[cell] = _seen(air, guide, h, mu_s, cell)
        mean += radiance[cell] * _cell_solid_angle(cell) / (4.0 * math.pi)
    running = 0.0
    for cell in range(CELLS):
        running += (radiance[cell] + 0.1 * mean) * _cell_solid_angle(cell)
        guide.cells[i, j, cell] = running
    for cell in range(CELLS):
        guide.cells[i, j, cell] /= running
    return 4.0 * math.pi * mean


@kernel
def _altitude(i, top):
    return top * (i / (ALTITUDES - 1)) ** 2


@kernel
def _square(j, last):
    """From -1 to 1 over j = 0 to `last`, crowding at 0."""
    x = 2.0 * j / last - 1.0
    return x * abs(x)


@kernel
def _cell_solid_angle(cell):
    e = cell // AZIMUTHS
    return (_square(e + 1, ELEVATIONS) - _square(e, ELEVATIONS)) * 2.0 * math.pi / AZIMUTHS


@kernel
def _seen(air, guide, h, mu_s, cell):
    mu = 0.5 * (_square(cell // AZIMUTHS, ELEVATIONS) + _square(cell // AZIMUTHS + 1, ELEVATIONS))
    azimuth = (cell % AZIMUTHS + 0.5) * math.pi / AZIMUTHS
    nu = mu * mu_s + math.cos(azimuth) * math.sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s))
    h_tangent = tangent_altitude(air.r_bottom, h, mu)
    start = math.copysign(distance_from_tangent(air.r_bottom, h_tangent, h), mu)
    ground = hits_ground(h_tangent, mu)
    if ground:
        end = -distance_from_tangent(air.r_bottom, h_tangent, 0.0)
    else:
        end = distance_from_tangent(air.r_bottom, h_tangent, guide.top)
    radiance = 0.0
    depth = 0.0
    mu_s_there = mu_s
    for step in range(STEPS):
        before = (end - start) * (step / STEPS) ** 2
        length = (end - start) * ((step + 1) / STEPS) ** 2 - before
        t = before + 0.5 * length
        h_there = min(max(altitude_on_ray(air.r_bottom, h_tangent, start + t), 0.0), guide.top)
        mu_s_there = ((air.r_bottom + h) * mu_s + t * nu) / (air.r_bottom + h_there)
        k = shell_of(air.altitude, h_there)
        scattering = 0.0
        for c in range(len(air.scattering)):
            scattering += node_value(air.altitude, air.scattering[c], k, h_there)
        light = look_up(guide, guide.direct, h_there, mu_s_there)
        light += look_up(guide, guide.ambient, h_there, mu_s_there)
        half_depth = 0.5 * node_value(air.altitude, air.extinction, k, h_there) * length
        depth += half_depth
        radiance += math.exp(-depth) * scattering * length / (4.0 * math.pi) * light
        depth += half_depth
    if ground:
        light = 4.0 * max(0.0, mu_s_there) * look_up(guide, guide.direct, 0.0, mu_s_there)
        light += look_up(guide, guide.ambient, 0.0, mu_s_there)
        radiance += math.exp(-depth) * air.albedo / (4.0 * math.pi) * light
    return radiance


@kernel
def _sun_place(mu_s):
    root = math.copysign(math.sqrt(min(1.0, abs(mu_s))), mu_s)
    return 0.5 * (root + 1.0) * (SUNS - 1)


@kernel
def _altitude_place(guide, h):
    return math.sqrt(min(1.0, max(0.0, h / guide.top))) * (ALTITUDES - 1)


@kernel
def look_up(guide, table, h, mu_s):
    """One of the guide's tables around altitude `h` with the sun at cosine `mu_s`."""
    x = _altitude_place(guide, h)
    y = _sun_place(mu_s)
    i = min(int(x), ALTITUDES - 2)
    j = min(int(y), SUNS - 2)
    u = x - i
    v = y - j
    low = (1.0 - v) * table[i, j] + v * table[i, j + 1]
    high = (1.0 - v) * table[i + 1, j] + v * table[i + 1, j + 1]
    return (1.0 - u) * low + u * high


@kernel
def draw_guided(guide, h, mu_s, up, sun, state):
    """Direction drawn by the guide's radiance at the nearest of its altitudes and suns."""
    cells = guide.cells[round(_altitude_place(guide, h)), round(_sun_place(mu_s))]
    cell = min(np.searchsorted(cells, uniform(state), side="right"), CELLS - 1)
    e = cell // AZIMUTHS
    low = _square(e, ELEVATIONS)
    mu = low + (_square(e + 1, ELEVATIONS) - low) * uniform(state)
    azimuth = (cell % AZIMUTHS + uniform(state)) * math.pi / AZIMUTHS
    if uniform(state) < 0.5:
        azimuth = -azimuth
    a, b = _horizontal_axes(up, sun)
    sine = math.sqrt(max(0.0, 1.0 - mu * mu))
    u = sine * math.cos(azimuth)
    v = sine * math.sin(azimuth)
    x = mu * up[0] + u * a[0] + v * b[0]
    y = mu * up[1] + u * a[1] + v * b[1]
    z = mu * up[2] + u * a[2] + v * b[2]
    norm = 1.0 / math.sqrt(x * x + y * y + z * z)
    return x * norm, y * norm, z * norm


@kernel
def guided_density(guide, h, mu_s, up, sun, direction):
    """Density per solid angle with which `draw_guided` draws `direction`."""
    cells = guide.cells[round(_altitude_place(guide, h)), round(_sun_place(mu_s))]
    mu = up[0] * direction[0] + up[1] * direction[1] + up[2] * direction[2]
    root = math.copysign(math.sqrt(min(1.0, abs(mu))), mu)
    e = min(int(0.5 * (root + 1.0) * ELEVATIONS), ELEVATIONS - 1)
    a, b = _horizontal_axes(up, sun)
    along = a[0] * direction[0] + a[1] * direction[1] + a[2] * direction[2]
    across = b[0] * direction[0] + b[1] * direction[1] + b[2] * direction[2]
    azimuth = abs(math.atan2(across, along))
    cell = e * AZIMUTHS + min(int(azimuth / math.pi * AZIMUTHS), AZIMUTHS - 1)
    probability = cells[cell] - (cells[cell - 1] if cell > 0 else 0.0)
    return probability / _cell_solid_angle(cell)


@kernel
def _horizontal_axes(up, sun):
    """Horizontal vectors toward the sun's azimuth and 90 degrees from it."""
    mu_s = up[0] * sun[0] + up[1] * sun[1] + up[2] * sun[2]
    x, y, z = sun[0] - mu_s * up[0], sun[1] - mu_s * up[1], sun[2] - mu_s * up[2]
    norm2 = x * x + y * y + z * z
    if norm2 < 1e-20:
        # The sun is overhead or underfoot: any horizontal axis serves.
        x, y, z = (0.0, -up[2], up[1]) if abs(up[0]) < 0.5 else (up[1], -up[0], 0.0)
        norm2 = x * x + y * y + z * z
    norm = 1.0 / math.sqrt(norm2)
    a = (x * norm, y * norm, z * norm)
    b = (up[1] * a[2] - up[2] * a[1], up[2] * a[0] - up[0] * a[2], up[0] * a[1] - up[1] * a[0])
    return a, b
