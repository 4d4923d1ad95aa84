"""Paths followed backward from the observer through clouds and air, each vertex lit by the sun."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.reference.air import Air
from skybake.reference.directions import (
    Direction,
    dot,
    draw_lobe,
    phase_and_lobe,
    scattering_at,
    uniform,
)
from skybake.reference.guide import Guide, look_up
from skybake.reference.paths import SURVIVAL
from skybake.reference.rays import (
    Cuts,
    altitude_on_ray,
    column,
    hits_ground,
    new_cuts,
    node_value,
    shell_of,
    tangent_altitude,
    trace,
    transmittance_to_space,
)
from skybake.reference.stretches import draw_vertex, new_stretches, weigh_stretches
from skybake.reference.tracking import (
    ESCAPES,
    LEAVES_CLOUDS,
    MEETS_GROUND,
    Clouds,
    altitude_of,
    clouds_transmittance,
    distance_to_cloud,
    fly,
    layer_extinction,
    moved,
    vertical_at,
)
from skybake.reference.turns import turn, turn_density

DUSK = 0.1
"""Cosine of the sun's zenith angle below which paths that leave the clouds are guided."""

BRANCHES = 0.2
"""Share of vertices at which a second path sets out around the sun: the narrow peak of droplets
is never met by chance alone."""

MOST_BRANCHES = 64
"""Paths that may wait for being followed."""


class CloudyScene(NamedTuple):
    """What light passes through at one wavelength.

    Attributes
    ----------
    air : Air
        The atmosphere, whose last constituents are the layers of clouds: their phase functions
        are there, and their extinction is not.
    peaks : ndarray of float64, shape (n, node)
        By `skybake.reference.majorants.air_peaks`.
    guide : Guide
        Of the air without clouds.
    clouds : Clouds
        Their extinction.
    """

    air: Air
    peaks: npt.NDArray[np.float64]
    guide: Guide
    clouds: Clouds


class _Room(NamedTuple):
    """Work space of a path: for its first ray, which is kept, and for those that follow."""

    first_cuts: Cuts
    first_stretches: npt.NDArray[np.float64]
    cuts: Cuts
    stretches: npt.NDArray[np.float64]
    coefficients: npt.NDArray[np.float64]
    layers: npt.NDArray[np.float64]
    branches: npt.NDArray[np.float64]


def mean_cloudy_radiance(
    scene: CloudyScene,
    sun: Direction,
    h: float,
    direction: Direction,
    samples: int,
    seed: np.uint64,
) -> float:
    """Mean over `samples` paths from altitude `h` above the origin."""
    air = scene.air
    first, later = (new_cuts(air), new_stretches(air)), (new_cuts(air), new_stretches(air))
    layers = np.zeros(len(air.scattering))
    layers[-len(scene.clouds.fields) :] = 1.0 / len(scene.clouds.fields)
    branches = np.empty((MOST_BRANCHES, 10))
    room = _Room(*first, *later, np.zeros(len(air.scattering)), layers, branches)
    state = np.array([seed], np.uint64)
    return float(_mean_radiance(scene, sun, h, direction, samples, room, state))


@kernel
def _mean_radiance(scene, sun, h, direction, samples, room, state):
    air, guide, clouds = scene.air, scene.guide, scene.clouds
    eye = (0.0, 0.0, h)
    ray = trace(air, h, direction[2], room.first_cuts)
    nu = dot(direction, sun)
    cumulative = room.first_stretches
    stretches = weigh_stretches(air, guide, ray, h, sun[2], nu, True, 1, cumulative)
    total = 0.0
    for i in range(samples):
        u = (i + uniform(state)) / samples
        free = distance_to_cloud(clouds, air.r_bottom, eye, direction, state)
        if stretches > 0:
            weight, s, h_vertex, shell = draw_vertex(air, ray, stretches, cumulative, u, state)
            if weight > 0.0 and s - ray.start < free:
                place = moved(eye, direction, s - ray.start)
                weight *= _collide(scene, room, place, h_vertex, shell < 0, True, False)
                total += _follow(
                    scene, sun, place, h_vertex, direction, shell < 0, weight, room, state
                )
        if free < math.inf:
            place = moved(eye, direction, free)
            h_vertex = max(0.0, altitude_of(air.r_bottom, place))
            weight = math.exp(-_depth_at(air, ray, ray.start + free))
            weight *= _collide(scene, room, place, h_vertex, False, False, True)
            total += _follow(scene, sun, place, h_vertex, direction, False, weight, room, state)
    return total / samples


@kernel
def _depth_at(air, ray, s):
    """Optical depth of the air on a ray from its start to the place `s`."""
    cuts = ray.cuts
    if ray.segments == 0 or s <= cuts.s[0]:
        return 0.0
    i = np.searchsorted(cuts.s[: ray.segments + 1], s) - 1
    if i >= ray.segments:
        return cuts.depth[ray.segments]
    k = cuts.shell[i]
    before = node_value(air.altitude, air.extinction, k, cuts.h[i])
    h = altitude_on_ray(air.r_bottom, ray.h_tangent, s)
    here = node_value(air.altitude, air.extinction, k, h)
    return cuts.depth[i] + column(air, ray.h_tangent, k, cuts.s[i], before, s, here)


@kernel
def _collide(scene, room, place, h, at_ground, in_air, in_clouds):
    """Write what scatters at a vertex to the room's coefficients; returns its albedo."""
    air, clouds, each = scene.air, scene.clouds, room.coefficients
    shell = shell_of(air.altitude, h)
    scattering = scattering_at(air, shell, h, each)
    if at_ground:
        return air.albedo
    extinction = 0.0
    if in_air:
        extinction = node_value(air.altitude, air.extinction, shell, h)
    else:
        scattering = 0.0
        each[:] = 0.0
    if in_clouds:
        first = len(each) - len(clouds.fields)
        for i in range(len(clouds.fields)):
            each[first + i] = layer_extinction(clouds, i, air.r_bottom, place, h)
            scattering += each[first + i]
            extinction += each[first + i]
    return scattering / extinction if extinction > 0.0 else 0.0


@kernel
def _follow(scene, sun, place, h, direction, at_ground, weight, room, state):
    """Radiance that a path brings from its first vertex on, per unit solar irradiance.

    Parameters
    ----------
    place, h, at_ground
        The vertex, what scatters at which is in the room's coefficients.
    weight : float
        Of the vertex, its albedo included.
    """
    air, clouds, each = scene.air, scene.clouds, room.coefficients
    radiance = 0.0
    first_weight, first_promise = weight, 0.0
    order = 1
    waiting = 0
    while True:
        mu_s = dot(vertical_at(air.r_bottom, place), sun)
        if weight > 0.0:
            sent = _toward_observer(air, each, mu_s, direction, sun, at_ground)
            sunlit = _sunlit(scene, place, h, mu_s, sun, state) if sent > 0.0 else 0.0
            if sunlit > 0.0:
                radiance += weight * sent * sunlit * transmittance_to_space(air, h, mu_s)
            promise = weight * look_up(scene.guide, scene.guide.ambient, h, mu_s)
            if order == 1:
                first_promise = promise
            # Paths toward the sun are worth what the peak of a phase function sends back.
            gain = max(1.0, 4.0 * math.pi * sent)
            kept = max(gain * weight / first_weight, promise / first_promise) / SURVIVAL
            if kept < 1.0:
                weight = weight / kept if uniform(state) < kept else 0.0
        if weight > 0.0:
            direction, weight, waiting = _turn(
                scene, sun, place, h, direction, at_ground, weight, order, waiting, room, state
            )
        if weight <= 0.0:
            if waiting == 0:
                return radiance
            waiting -= 1
            branch = room.branches[waiting]
            place, h = (branch[0], branch[1], branch[2]), branch[3]
            direction = (branch[4], branch[5], branch[6])
            weight, order = branch[7], int(branch[8])
            mu_s = branch[9]
        order += 1
        end, place, h, _ = fly(air, scene.peaks, clouds, place, direction, mu_s < DUSK, state)
        at_ground = end == MEETS_GROUND
        if end == ESCAPES:
            weight = 0.0
            continue
        if end == LEAVES_CLOUDS:
            leap, place, h, at_ground = _leap(scene, sun, place, h, direction, order, room, state)
            weight *= leap
        if weight > 0.0:
            weight *= _collide(scene, room, place, h, at_ground, True, end != LEAVES_CLOUDS)


@kernel
def _turn(scene, sun, place, h, direction, at_ground, weight, order, waiting, room, state):
    """Next direction of a path and its weight, and how many paths wait: it may have branched."""
    air, guide, each, layers = scene.air, scene.guide, room.coefficients, room.layers
    up = vertical_at(air.r_bottom, place)
    total = _sum(each)
    in_cloud = not at_ground and total > 0.0 and _cloud_share(scene.clouds, each) > 0.5 * total
    share = BRANCHES if waiting < MOST_BRANCHES else 0.0
    if uniform(state) < share:
        turned = draw_lobe(air, layers, 1.0, sun, state)
        if in_cloud:
            wanted, density = phase_and_lobe(air, each, total, direction, turned)
        else:
            wanted, density = turn_density(
                air, guide, each, total, h, up, direction, sun, at_ground, order, turned
            )
        _, sun_lobe = phase_and_lobe(air, layers, 1.0, turned, sun)
        branch = room.branches[waiting]
        branch[0], branch[1], branch[2] = place
        branch[3] = h
        branch[4], branch[5], branch[6] = turned
        branch[7] = weight * wanted / (density + share * sun_lobe)
        branch[8] = order
        branch[9] = dot(up, sun)
        waiting += 1
    if in_cloud:
        turned = draw_lobe(air, each, total, direction, state)
        wanted, density = phase_and_lobe(air, each, total, direction, turned)
    else:
        turned, _ = turn(air, guide, each, total, h, up, direction, sun, at_ground, order, state)
        wanted, density = turn_density(
            air, guide, each, total, h, up, direction, sun, at_ground, order, turned
        )
    _, sun_lobe = phase_and_lobe(air, layers, 1.0, turned, sun)
    density += share * sun_lobe
    return turned, weight * wanted / density if density > 0.0 else 0.0, waiting


@kernel
def _sum(values):
    total = 0.0
    for value in values:
        total += value
    return total


@kernel
def _leap(scene, sun, place, h, direction, order, room, state):
    """Guide a path that has no cloud ahead: weight, place and altitude of its next vertex."""
    air = scene.air
    up = vertical_at(air.r_bottom, place)
    ray = trace(air, h, dot(up, direction), room.cuts)
    nu = dot(direction, sun)
    stretches = weigh_stretches(
        air, scene.guide, ray, h, dot(up, sun), nu, True, order, room.stretches
    )
    if stretches == 0:
        return 0.0, place, h, False
    weight, s, h_vertex, shell = draw_vertex(
        air, ray, stretches, room.stretches, uniform(state), state
    )
    return weight, moved(place, direction, s - ray.start), h_vertex, shell < 0


@kernel
def _cloud_share(clouds, each):
    """Scattering coefficient of clouds among what scatters at a vertex. [km⁻¹]"""
    scattering = 0.0
    for i in range(len(each) - len(clouds.fields), len(each)):
        scattering += each[i]
    return scattering


@kernel
def _sunlit(scene, place, h, mu_s, sun, state):
    """Estimate of the transmittance of clouds toward the sun; 0 where the planet is before it."""
    radius = scene.air.r_bottom
    if hits_ground(tangent_altitude(radius, h, mu_s), mu_s):
        return 0.0
    return clouds_transmittance(scene.clouds, radius, place, sun, state)


@kernel
def _toward_observer(air, each, mu_s, direction, sun, at_ground):
    """Share of its sunlight that a vertex sends back along `direction`. [sr⁻¹]"""
    if at_ground:
        return max(0.0, mu_s) / math.pi
    phase, _ = phase_and_lobe(air, each, _sum(each), direction, sun)
    return phase
