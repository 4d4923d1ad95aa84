"""Phase functions and directions: evaluating the former, drawing the latter."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.reference.rays import node_value

Direction = tuple[float, float, float]

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_A = np.uint64(0xBF58476D1CE4E5B9)
_MIX_B = np.uint64(0x94D049BB133111EB)
_S11, _S27, _S30, _S31 = np.uint64(11), np.uint64(27), np.uint64(30), np.uint64(31)


@kernel
def uniform(state):
    """Next random number in [0, 1) of SplitMix64 (Steele et al. 2014); `state` is one uint64."""
    state[0] += _GOLDEN
    z = state[0]
    z = (z ^ (z >> _S30)) * _MIX_A
    z = (z ^ (z >> _S27)) * _MIX_B
    z ^= z >> _S31
    return float(z >> _S11) * 2.0**-53


@kernel
def dot(a, b):
    """Scalar product of two triples."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def advance(up, radius, direction, distance):
    """Vertical at the place `distance` along `direction` from radius `radius` under `up`."""
    x = up[0] * radius + direction[0] * distance
    y = up[1] * radius + direction[1] * distance
    z = up[2] * radius + direction[2] * distance
    norm = 1.0 / math.sqrt(x * x + y * y + z * z)
    return x * norm, y * norm, z * norm


@kernel
def around(axis, versine, azimuth):
    """Direction at 1 - cosine = `versine` from `axis`, turned by `azimuth` (Duff et al. 2017)."""
    sine = math.sqrt(max(0.0, versine * (2.0 - versine)))
    x, y, z = axis
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    u = sine * math.cos(azimuth)
    v = sine * math.sin(azimuth)
    w = 1.0 - versine
    dx = u * (1.0 + sign * x * x * a) + v * b + w * x
    dy = u * sign * b + v * (sign + y * y * a) + w * y
    dz = -u * sign * x - v * y + w * z
    norm = 1.0 / math.sqrt(dx * dx + dy * dy + dz * dz)
    return dx * norm, dy * norm, dz * norm


@kernel
def angle_node(intervals, a, b):
    """Place of the angle between two directions among `scattering_angles`, in intervals from 0."""
    # Half the distance between the directions is sin(theta/2), half that of the
    # opposite one cos(theta/2); both to full precision.
    dx, dy, dz = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    forward2 = 0.25 * (dx * dx + dy * dy + dz * dz)
    half = 0.5 * intervals
    if forward2 <= 0.5:
        return half * min(1.0, math.sqrt(math.sqrt(2.0 * forward2)))
    dx, dy, dz = a[0] + b[0], a[1] + b[1], a[2] + b[2]
    backward2 = 0.25 * (dx * dx + dy * dy + dz * dz)
    return intervals - half * min(1.0, math.sqrt(math.sqrt(2.0 * backward2)))


@kernel
def scattering_at(air, k, h, each):
    """Write every constituent's scattering coefficient into `each`; returns their sum, in km⁻¹."""
    total = 0.0
    for c in range(len(each)):
        each[c] = max(0.0, node_value(air.altitude, air.scattering[c], k, h))
        total += each[c]
    return total


@kernel
def phase_and_lobe(air, each, total, a, b):
    """Phase function of the mixture between `a` and `b`, and the density it is drawn with."""
    intervals = air.phase.shape[1] - 1
    node = angle_node(intervals, a, b)
    i = min(int(node), intervals - 1)
    f = node - i
    phase = 0.0
    lobe = 0.0
    for c in range(len(each)):
        share = each[c] / total
        phase += share * ((1.0 - f) * air.phase[c, i] + f * air.phase[c, i + 1])
        lobe += share * air.lobe[c, i]
    return phase, lobe


@kernel
def draw_lobe(air, each, total, axis, state):
    """Direction around `axis` by the phase functions' histograms."""
    pick = uniform(state) * total
    c = 0
    while c < len(each) - 1 and (pick >= each[c] or each[c] <= 0.0):
        pick -= each[c]
        c += 1
    cumulative = air.lobe_cumulative[c]
    u = uniform(state)
    i = min(max(np.searchsorted(cumulative, u, side="right") - 1, 0), len(cumulative) - 2)
    low = _versine(i, len(cumulative) - 1)
    high = _versine(i + 1, len(cumulative) - 1)
    return around(axis, low + (high - low) * uniform(state), 2.0 * math.pi * uniform(state))


@kernel
def draw_cosine(axis, cone, state):
    """Direction with density proportional to its cosine to `axis`, where sin² is below `cone`."""
    u = cone * uniform(state)
    # 1 - sqrt(1 - u), without the cancellation on the axis.
    return around(axis, u / (1.0 + math.sqrt(1.0 - u)), 2.0 * math.pi * uniform(state))


@kernel
def _versine(i, intervals):
    """1 - cosine of the i-th of `scattering_angles`, which is x⁴ in their forward half."""
    x = 2.0 * min(i, intervals - i) / intervals
    return x**4 if 2 * i <= intervals else 2.0 - x**4
