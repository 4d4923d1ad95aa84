"""The aureole of a low sun: light that peaks alone have scattered, on paths that are bent.

`ScaledMedium` lets light that was scattered only within forward peaks go straight on from
the sun. Around a low sun that is not enough: a degree higher the light has come through
much less air, a degree lower through the ground. The field of the difference, between such
light on its true path and on the straight one, is held around the sun.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.delta_m import ScaledMedium
from skybake.optics.medium import Array
from skybake.scattering.field import altitude_weight, fast_acos, sun_weights
from skybake.transport.exponential import fast_exp
from skybake.transport.geometry import radius_at

LAST_ANGLE = math.radians(50.0)
"""Angle from the sun up to which peaks scatter the difference to the observer. [rad]"""

ANGLES = 16
"""Nodes of that angle."""

ORDERS = 3
"""Terms in the position angle about the sun: it is the difference of above and below, most of
it in the term of order 1."""

NARROWEST = math.cos(LAST_ANGLE)


class Aureole(NamedTuple):
    """What peaks scatter of the difference between bent and straight paths.

    Attributes
    ----------
    source : ndarray of float32, shape (altitude, sun, angle, order * wavelength)
        Per unit irradiance and scattering coefficient of what is peaked, at the altitudes
        and suns of the diffuse field: terms cos(order * psi), psi being the position angle
        about the sun from the zenith's side. There are `ANGLES`, at equal distances from
        the sun up to `LAST_ANGLE`, or none in a medium whose peaks are too weak to matter. [sr⁻¹]
    """

    source: npt.NDArray[np.float32]


class AureoleScratch(NamedTuple):
    """Work space of `add_aureole`; each thread needs its own.

    Attributes
    ----------
    sun, angle : ndarray of float64, shape (4,)
        Weights of nodes.
    emitted : ndarray of float64, shape (2, wavelength)
        What a step's samples scatter in peaks toward the observer.
    series : ndarray of float32, shape (order * wavelength,)
        Terms of the position angle at a step.
    """

    sun: Array
    angle: Array
    emitted: Array
    series: npt.NDArray[np.float32]


def no_aureole(scaled: ScaledMedium) -> Aureole:
    """Aureole of a medium without peaks that matter."""
    return Aureole(np.zeros((1, 1, 0, ORDERS * scaled.mixture.size), np.float32))


def allocate_aureole_scratch(scaled: ScaledMedium) -> AureoleScratch:
    """Make the work space for rays through a medium."""
    wavelengths = scaled.mixture.size
    return AureoleScratch(
        sun=np.empty(4),
        angle=np.empty(4),
        emitted=np.empty((2, wavelengths)),
        series=np.empty(ORDERS * wavelengths, np.float32),
    )


@kernel
def add_aureole(aureole, field, scaled, fans, begin, end, samples, scratch, out):
    """Add what peaks scatter out of the difference, for rays that pass near the sun.

    Parameters
    ----------
    aureole : Aureole
        The difference.
    field : DiffuseField
        Its nodes of altitude and sun.
    scaled : ScaledMedium
        The atmosphere.
    fans : Fans
        The rays.
    begin, end, samples
        Fans, and the result of `trace` for their starts, in the truncated medium.
    scratch : AureoleScratch
        Work space.
    out : ndarray of float32, shape (ray, wavelength)
        Receives radiance per unit irradiance. [sr⁻¹]
    """
    for fan in range(begin, end):
        r, mu = fans.starts[fan, 0], fans.starts[fan, 1]
        first = samples.first[fan - begin]
        last = first + samples.number[fan - begin]
        for i in range(fans.first[fan], fans.first[fan + 1]):
            mu_s, nu = fans.rays[i, 2], fans.rays[i, 3]
            if nu <= NARROWEST:
                continue
            node = _fill_angle_weights(nu, scratch.angle)
            for n in range(first, last, 2):
                share = fill_peak_emission(scaled, samples, n, scratch.emitted)
                if share < 0.0:
                    continue
                t = (1.0 - share) * samples.distance[n] + share * samples.distance[n + 1]
                radius = radius_at(r, mu, t)
                mu_here = min(max((r * mu + t) / radius, -1.0), 1.0)
                mu_s_here = min(max((r * mu_s + t * nu) / radius, -1.0), 1.0)
                sines = math.sqrt((1.0 - nu * nu) * (1.0 - mu_s_here * mu_s_here))
                upward = 1.0 if sines < 1e-12 else (mu_here - nu * mu_s_here) / sines
                _fill_series(
                    aureole, field, radius - scaled.medium.r_bottom, mu_s_here, node, scratch
                )
                _add_series(scratch, min(max(upward, -1.0), 1.0), out[i])


@kernel
def _fill_angle_weights(nu, out):
    """First of the four nodes around an angle to the sun, and Lagrange's weights of them."""
    x = fast_acos(nu) / LAST_ANGLE * (ANGLES - 1)
    first = min(max(int(x) - 1, 0), ANGLES - 4)
    a, b, c, d = x - first, x - first - 1.0, x - first - 2.0, x - first - 3.0
    out[0] = -b * c * d / 6.0
    out[1] = a * c * d / 2.0
    out[2] = -a * b * d / 2.0
    out[3] = a * b * c / 6.0
    return first


@kernel
def fill_peak_emission(scaled, samples, n, out):
    """Write what the two samples of a step scatter in peaks; the second's share or, of 0, -1.

    Light that peaks have scattered is dimmed by all extinction on its way to the observer;
    the samples know that of the truncated medium.
    """
    sums = 0.0
    second = 0.0
    for i in range(2):
        for k in range(out.shape[1]):
            scattering = 0.0
            depth = 0.0
            for c in scaled.peaked:
                scattering += samples.density[n + i, c] * scaled.scattering[c, k]
                depth += (
                    scaled.fraction[c, k] * scaled.scattering[c, k] * samples.column_to[n + i, c]
                )
            out[i, k] = samples.weight[n + i, k] * scattering * fast_exp(-depth)
            sums += out[i, k]
            second += i * out[i, k]
    for k in range(out.shape[1]):
        out[0, k] += out[1, k]
    return second / sums if sums > 0.0 else -1.0


@kernel
def _fill_series(aureole, field, h, mu_s, node, scratch):
    """Interpolate the terms of the position angle between altitudes, suns and angles."""
    low, u = altitude_weight(field, h)
    first = sun_weights(field, mu_s, scratch.sun)
    series = scratch.series
    series[:] = np.float32(0.0)
    for i in range(2):
        share = u if i == 1 else 1.0 - u
        for j in range(4):
            for q in range(4):
                weight = np.float32(share * scratch.sun[j] * scratch.angle[q])
                values = aureole.source[low + i, first + j, node + q]
                for k in range(series.size):
                    series[k] += weight * values[k]


@kernel
def _add_series(scratch, cosine, out):
    """Add what is emitted times the sum over the terms of a position angle."""
    wavelengths = out.size
    before, now = cosine, 1.0
    for m in range(ORDERS):
        for k in range(wavelengths):
            out[k] += np.float32(now * scratch.emitted[0, k]) * scratch.series[m * wavelengths + k]
        before, now = now, 2.0 * cosine * now - before
