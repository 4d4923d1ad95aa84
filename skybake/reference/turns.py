"""Where a path that is followed backward turns at a vertex."""

from __future__ import annotations

import math

from skybake.jit.kernel import kernel
from skybake.reference.directions import dot, draw_cosine, draw_lobe, phase_and_lobe, uniform
from skybake.reference.guide import draw_guided, guided_density

TOWARD_SUN = 0.3
"""Share of a path's first turns drawn around the sun: an aureole is never met by chance alone."""

GUIDED = 0.35
"""Share of a path's first turns drawn by the guide, such as toward the glow of twilight."""


@kernel
def turn(air, guide, each, total, h, up, direction, sun, at_ground, order, state):
    """Next direction of a path, drawn around the last one or around the sun, and its weight."""
    # A long path whose every turn were drawn so would multiply weights up to 1 / (1 - shares).
    toward_sun = TOWARD_SUN / order if total > 0.0 else 0.0
    guided = GUIDED / order
    mu_s = dot(up, sun)
    pick = uniform(state)
    if pick < toward_sun:
        turned = draw_lobe(air, each, total, sun, state)
    elif pick < toward_sun + guided:
        turned = draw_guided(guide, h, mu_s, up, sun, state)
    elif at_ground:
        turned = draw_cosine(up, 1.0, state)
    else:
        turned = draw_lobe(air, each, total, direction, state)
    wanted, density = turn_density(
        air, guide, each, total, h, up, direction, sun, at_ground, order, turned
    )
    return turned, wanted / density if density > 0.0 else 0.0


@kernel
def turn_density(air, guide, each, total, h, up, direction, sun, at_ground, order, turned):
    """Return what a vertex sends back of light from `turned`, and the density of drawing that."""
    toward_sun = TOWARD_SUN / order if total > 0.0 else 0.0
    guided = GUIDED / order
    if at_ground:
        wanted = max(0.0, dot(up, turned)) / math.pi
        lobe = wanted
    else:
        wanted, lobe = phase_and_lobe(air, each, total, direction, turned)
    density = (1.0 - toward_sun - guided) * lobe
    density += guided * guided_density(guide, h, dot(up, sun), up, sun, turned)
    if toward_sun > 0.0:
        _, sun_lobe = phase_and_lobe(air, each, total, turned, sun)
        density += toward_sun * sun_lobe
    return wanted, density
