"""Straight rays in a spherical atmosphere.

A ray starts at radius r with the cosine mu of its zenith angle. All lengths
are in km and in double precision, in which r*r - b*b keeps micrometres even a
million km away.
"""

from __future__ import annotations

import math

from skybake.jit.kernel import kernel


@kernel
def squared_closest_approach(r, mu):
    """Square of the distance between the planet's centre and the ray's line. [km²]"""
    return r * r * (1.0 - mu * mu)


@kernel
def distance_to_exit(r, mu, r_top):
    """Distance at which a ray leaves the sphere `r_top`, or 0 if it misses it. [km]"""
    half_chord_squared = r_top * r_top - squared_closest_approach(r, mu)
    if half_chord_squared <= 0.0:
        return 0.0
    return max(0.0, -r * mu + math.sqrt(half_chord_squared))


@kernel
def distance_to_entry(r, mu, r_sphere):
    """Distance at which a ray from outside enters a sphere; inf if it misses it. [km]"""
    half_chord_squared = r_sphere * r_sphere - squared_closest_approach(r, mu)
    if half_chord_squared < 0.0 or mu >= 0.0:
        return math.inf
    return max(0.0, -r * mu - math.sqrt(half_chord_squared))


@kernel
def radius_at(r, mu, t):
    """Radius of the point at distance `t` along the ray. [km]"""
    return math.sqrt(max(0.0, r * r + t * (t + 2.0 * r * mu)))


@kernel
def shadow_interval(r, mu, mu_s, nu, r_bottom, t_first, t_last):
    """Part of a ray that is in the planet's shadow.

    Parameters
    ----------
    r, mu : float
        Start of the ray and cosine of its zenith angle. [km]
    mu_s, nu : float
        Cosines of the sun's zenith angle at the start and of the angle between
        ray and sun.
    r_bottom : float
        Radius of the planet. [km]
    t_first, t_last : float
        Ends of the ray within the atmosphere; it does not enter the ground between. [km]

    Returns
    -------
    (float, float)
        Distances at which the shadow begins and ends; inf and inf where the
        whole ray is lit. [km]

    Notes
    -----
    The shadow is the half of the cylinder |x|² - (x·s)² < r_bottom² that lies
    behind the planet, x·s < 0. A ray outside the planet crosses the cylinder's
    surface on one side only, so the sign of x·s anywhere inside decides which.
    """
    a = 1.0 - nu * nu
    half_b = r * (mu - mu_s * nu)
    c = r * r * (1.0 - mu_s * mu_s) - r_bottom * r_bottom
    if a < 1e-14:
        if c >= 0.0:
            return math.inf, math.inf
        first, last = t_first, t_last
    else:
        discriminant = half_b * half_b - a * c
        if discriminant <= 0.0:
            return math.inf, math.inf
        root = math.sqrt(discriminant)
        first = max((-half_b - root) / a, t_first)
        last = min((-half_b + root) / a, t_last)
    if first >= last or r * mu_s + 0.5 * (first + last) * nu >= 0.0:
        return math.inf, math.inf
    return first, last
