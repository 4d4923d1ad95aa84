"""The light that a point of a layer sends to the eye."""

from __future__ import annotations

import math

from skybake.cloud_fields.field import detailed_extinction
from skybake.clouds.harmonics import fill_harmonics
from skybake.clouds.light import fill_blend, fill_corners, fill_diffuse, sun_depth, sun_share
from skybake.clouds.particles import DEEPEST, TERMS
from skybake.jit.kernel import inlined_kernel, kernel
from skybake.transport.exponential import fast_exp

DARK = 7.0
"""Optical depth toward the sun, without forward peaks, beyond which its rest does not matter."""


@kernel
def prepare_ray(light, radius, altitude, direction, sun, distance, scratch):
    """Prepare what holds along a ray: phase functions, and harmonics where it enters the layer.

    Returns
    -------
    float
        Of `sun_share`.
    """
    px, py = distance * direction[0], distance * direction[1]
    pz = altitude + distance * direction[2] + radius
    r = math.sqrt(px * px + py * py + pz * pz)
    ux, uy, uz = px / r, py / r, pz / r
    # The tile's axes are the observer's, turned by the shortest way to the local vertical.
    for which in range(2):
        source = direction if which == 0 else sun
        x, y, z = source[0], source[1], source[2]
        along = x * ux + y * uy + z * uz
        both = (along + z) / (1.0 + uz)
        local = scratch.local[which]
        local[0], local[1] = x - both * ux, y - both * uy
        local[2] = along
    local = scratch.local[0]
    fill_harmonics(-local[0], -local[1], -local[2], light.order, scratch.harmonic)
    for p in range(scratch.harmonic.size):
        scratch.toward[p] = light.scatter[p] * scratch.harmonic[p]
    nu = direction[0] * sun[0] + direction[1] * sun[1] + direction[2] * sun[2]
    angles = light.truncated.shape[0]
    middle = angles // 2
    if nu > 0.0:
        place = middle * math.sqrt(math.sqrt(max(1.0 - nu, 0.0)))
    else:
        place = 2 * middle - middle * math.sqrt(math.sqrt(max(1.0 + nu, 0.0)))
    i = min(int(place), angles - 2)
    u = place - i
    for c in range(scratch.truncated.size):
        low, high = light.truncated[i, c], light.truncated[i + 1, c]
        scratch.truncated[c] = low + u * (high - low)
        for q in range(TERMS):
            low, high = light.peak[i, c, q], light.peak[i + 1, c, q]
            scratch.peak[c, q] = low + u * (high - low)
    place = sun_share(light, scratch.local[1, 2])
    fill_blend(light, place, scratch.blend)
    return place


@inlined_kernel
def fill_source(field, light, marching, place, x, y, h, blur, detail, erosion, to_eye, scratch):
    """Write what a point sends to the eye, of the sun and of diffuse light, by its opacity.

    Parameters
    ----------
    field, light, marching
        As of `skybake.clouds.march.fill_march`.
    place : float
        Of `prepare_ray`.
    x, y, h, blur, detail, erosion
        As of `skybake.cloud_fields.field.detailed_clearance` and `detailed_extinction`.
    to_eye : float
        Optical depth of all particles up to the eye, those of peaks included.
    scratch : MarchScratch
        Whose `source` receives it, by channel.
    """
    toward_sun = _depth_to_sun(
        field, light, marching, place, x, y, h, blur, detail, erosion, scratch
    )
    fill_diffuse(
        light,
        place,
        scratch.blend,
        scratch.corner,
        scratch.weight,
        scratch.toward,
        scratch.moments,
        scratch.source,
    )
    keep = 1.0 - light.fraction
    to_sun = toward_sun / keep
    sharp = fast_exp(-light.fraction * (to_sun + to_eye)) / keep
    beam = fast_exp(-toward_sun)
    series = min(to_sun, DEEPEST)
    fz = (h - light.base) / light.spacing[0] - 0.5
    for c in range(scratch.source.size):
        peak = scratch.peak[c, TERMS - 1]
        for q in range(TERMS - 2, -1, -1):
            peak = peak * series + scratch.peak[c, q]
        lit = _irradiance(light, place, scratch.blend, fz, c) * beam
        scratch.source[c] += lit * (scratch.truncated[c] + sharp * peak)


@inlined_kernel
def _depth_to_sun(field, light, marching, place, x, y, h, blur, detail, erosion, scratch):
    """Optical depth toward the sun without forward peaks; leaves the point's own corners."""
    corner, weight = scratch.corner, scratch.weight
    if marching.taps == 0:
        fill_corners(light, x, y, h, corner, weight)
        return sun_depth(light, place, corner, weight)
    toward = scratch.local[1]
    east, north, up = toward[0], toward[1], toward[2]
    s = marching.reach
    fill_corners(light, x + s * east, y + s * north, h + s * up, corner, weight)
    depth = sun_depth(light, place, corner, weight)
    if depth < DARK:
        # Where details are left out, samples need not be nearer to each other than these.
        taps = min(marching.taps, max(math.ceil(marching.reach / max(blur, 1e-6)), 2))
        near, apart = 0.0, marching.reach / taps
        for q in range(taps):
            s = apart * (q + 0.5)
            px, py, pz = x + s * east, y + s * north, h + s * up
            near += detailed_extinction(field, px, py, pz, detail, erosion)
        depth += near * apart * (1.0 - light.fraction)
    fill_corners(light, x, y, h, corner, weight)
    return depth


@inlined_kernel
def _irradiance(light, place, blend, fz, channel):
    """Irradiance by the sun between levels and suns."""
    levels = light.irradiance.shape[1]
    z = min(max(fz, 0.0), levels - 1.0)
    k = min(int(z), max(levels - 2, 0))
    w = z - k
    first = int(place)
    share = place - first
    upper = min(k + 1, levels - 1)
    low, high = light.irradiance[first, k, channel], light.irradiance[first, upper, channel]
    value = blend[2, channel] * (low + w * (high - low))
    if share > 0.0:
        low = light.irradiance[first + 1, k, channel]
        high = light.irradiance[first + 1, upper, channel]
        value += blend[3, channel] * (low + w * (high - low))
    return value
