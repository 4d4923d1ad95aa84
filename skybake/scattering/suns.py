"""Where the sun is at the samples of a fan's rays: between which nodes, and in which azimuth."""

from __future__ import annotations

import math

from skybake.jit.kernel import kernel
from skybake.scattering.field import (
    fast_acos,
    fill_cubic_weights,
    fill_linear_weights,
    find_suns,
)


@kernel
def fill_suns(field, rays, first, count, t, radius, mu_here, angle, node, weights, cosine):
    """Find the sun between nodes at a sample, for each ray of a fan.

    Parameters
    ----------
    field : DiffuseField
        Its nodes.
    rays : ndarray of float64, shape (ray, 4)
        As of `Fans`.
    first, count : int
        The fan's rays.
    t, radius, mu_here : float
        The sample's distance from the start and from the planet's centre [km], and the cosine of
        the ray's zenith angle there.
    angle : ndarray of float64, shape (ray,)
        Receives the sun's zenith angle. [rad]
    node, weights, cosine : ndarray, shape (ray,), (ray, 4) and (ray,)
        Receive results of `sun_weights` and the cosine of the sun's azimuth from the ray's.

    Returns
    -------
    (int, int)
        First of the nodes that any ray needs, and the one after the last.

    Notes
    -----
    The loops are apart so that those which only compute are vectorised.
    """
    last_angle = field.sun_angle[-1]
    for q in range(count):
        r, mu_s, nu = rays[first + q, 0], rays[first + q, 2], rays[first + q, 3]
        mu_s_here = min(max((r * mu_s + t * nu) / radius, -1.0), 1.0)
        sines = math.sqrt((1.0 - mu_here * mu_here) * (1.0 - mu_s_here * mu_s_here))
        across = 1.0 if sines < 1e-12 else (nu - mu_here * mu_s_here) / sines
        cosine[q] = min(max(across, -1.0), 1.0)
        angle[q] = min(fast_acos(mu_s_here), last_angle)
    least, most = field.sun_angle.size, 0
    for q in range(count):
        node[q] = find_suns(field, angle[q])
        least, most = min(least, node[q]), max(most, node[q])
    for q in range(count):
        fill_cubic_weights(field, angle[q], node[q], weights[q])
    if field.steep_from < math.inf:
        for q in range(count):
            if angle[q] > field.steep_from:
                fill_linear_weights(field, angle[q], node[q], weights[q])
    return least, most + 4
