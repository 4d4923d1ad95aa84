"""Paths followed backward from the observer, each vertex lit by the sun."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.reference.air import Air
from skybake.reference.directions import (
    Direction,
    advance,
    dot,
    draw_cosine,
    draw_lobe,
    phase_and_lobe,
    scattering_at,
    uniform,
)
from skybake.reference.guide import Guide, look_up
from skybake.reference.occultation import Occultation, no_occultation, uncovered_share
from skybake.reference.polarised import (
    add_sunlight,
    begin_track,
    lose_polarisation,
    new_track,
    no_track,
    turn_track,
)
from skybake.reference.rays import (
    Cuts,
    new_cuts,
    node_value,
    shell_of,
    trace,
    transmittance_to_space,
)
from skybake.reference.stretches import draw_vertex, new_stretches, weigh_stretches
from skybake.reference.turns import turn

SURVIVAL = 0.3
"""Paths that weigh less than this, and by the guide promise less, play Russian roulette."""


@kernel
def follow(
    air, guide, sun, occultation, observer, ray, stretches, cumulative, u, up, h, direction,
    first, last, scratch, track, state,
):  # fmt: skip
    """Radiance that one path brings, orders `first` to `last`, per unit solar irradiance.

    Parameters
    ----------
    occultation : Occultation
        What is in front of the sun.
    observer : float
        Distance of the path's start from the planet's centre, along (0, 0, 1). [km]
    ray, stretches, cumulative
        The path's first ray, from `up`, `h` along `direction`.
    u : float
        Random number that chooses the first stretch.
    scratch : tuple
        Cuts, stretches and coefficients for the rays that follow.
    track : Track
        Follows polarisation, if it is not empty.
    """
    cuts, later_cumulative, each = scratch
    radiance = 0.0
    weight = 1.0
    first_weight = 0.0
    first_promise = 0.0
    order = 1
    begin_track(track, up, direction)
    while True:
        if stretches == 0:
            return radiance
        step_weight, s, h_vertex, shell = draw_vertex(air, ray, stretches, cumulative, u, state)
        weight *= step_weight
        up = advance(up, air.r_bottom + h, direction, s - ray.start)
        h = h_vertex
        mu_s = dot(up, sun)
        at_ground = shell < 0
        if at_ground:
            weight *= air.albedo
            lose_polarisation(track)
            total = scattering_at(air, 0, 0.0, each)
        else:
            total = scattering_at(air, shell, h, each)
            if total <= 0.0:
                return radiance
            weight *= total / node_value(air.altitude, air.extinction, shell, h)
        if weight <= 0.0:
            return radiance
        if order >= first:
            light = _sunlight(air, each, total, h, mu_s, direction, sun, at_ground)
            light = weight * _uncovered(light, occultation, air.r_bottom + h, up, observer)
            radiance += light
            add_sunlight(air, each, track, direction, sun, light, at_ground)
        if order >= last:
            return radiance
        promise = weight * look_up(guide, guide.ambient, h, mu_s)
        if order == 1:
            first_weight = weight
            first_promise = promise
        kept = max(weight / first_weight, promise / first_promise)
        survival = min(1.0, kept / SURVIVAL)
        if survival < 1.0:
            if uniform(state) >= survival:
                return radiance
            weight /= survival
        turned, step_weight = turn(
            air, guide, each, total, h, up, direction, sun, at_ground, order, state
        )
        turn_track(air, each, track, direction, turned, at_ground)
        direction = turned
        if step_weight <= 0.0:
            return radiance
        weight *= step_weight
        mu = dot(up, direction)
        ray = trace(air, h, mu, cuts)
        cumulative = later_cumulative
        stretches = weigh_stretches(
            air, guide, ray, h, mu_s, dot(direction, sun), order + 1 >= first, order + 1, cumulative
        )
        u = uniform(state)
        order += 1


@kernel
def _uncovered(light, occultation, r, up, observer):
    """Light of a vertex in the direction `up` from the planet's centre that passes the moon."""
    if light <= 0.0:
        return 0.0
    return light * uncovered_share(occultation, r * up[0], r * up[1], r * up[2] - observer)


@kernel
def _sunlight(air, each, total, h, mu_s, direction, sun, at_ground):
    """Sunlight that a vertex sends back along `direction`, per unit of what it scatters."""
    if at_ground:
        toward_observer = max(0.0, mu_s) / math.pi
    else:
        toward_observer, _ = phase_and_lobe(air, each, total, direction, sun)
    if toward_observer <= 0.0:
        return 0.0
    return toward_observer * transmittance_to_space(air, h, mu_s)


class _Room(NamedTuple):
    """Work space of paths: for their first rays, which are kept, and for those that follow."""

    first_cuts: Cuts
    first_stretches: npt.NDArray[np.float64]
    first_coefficients: npt.NDArray[np.float64]
    cuts: Cuts
    stretches: npt.NDArray[np.float64]
    coefficients: npt.NDArray[np.float64]


def _new_room(air: Air) -> _Room:
    constituents = len(air.scattering)
    first = new_cuts(air), new_stretches(air), np.zeros(constituents)
    return _Room(*first, new_cuts(air), new_stretches(air), np.zeros(constituents))


def mean_radiance(
    air: Air,
    guide: Guide,
    sun: Direction,
    occultation: Occultation,
    h: float,
    direction: Direction,
    first: int,
    last: int,
    samples: int,
    seed: np.uint64,
) -> float:
    """Mean over `samples` paths from altitude `h` under the vertical (0, 0, 1)."""
    state = np.array([seed], np.uint64)
    return float(
        _mean_radiance(
            air, guide, sun, occultation, h, direction, first, last, samples, _new_room(air),
            no_track(), state,
        )
    )  # fmt: skip


def mean_stokes(
    air: Air,
    guide: Guide,
    sun: Direction,
    h: float,
    direction: Direction,
    first: int,
    samples: int,
    seed: np.uint64,
) -> npt.NDArray[np.float64]:
    """Mean (I, Q, U) of the orders from `first` on over paths as of `mean_radiance`."""
    state, track = np.array([seed], np.uint64), new_track()
    last = np.iinfo(np.int64).max
    _mean_radiance(
        air, guide, sun, no_occultation(), h, direction, first, last, samples, _new_room(air),
        track, state,
    )  # fmt: skip
    return track.stokes / samples


@kernel
def _mean_radiance(
    air, guide, sun, occultation, h, direction, first, last, samples, room, track, state
):  # fmt: skip
    up = (0.0, 0.0, 1.0)
    scratch = (room.cuts, room.stretches, room.coefficients)
    ray = trace(air, h, direction[2], room.first_cuts)
    cumulative = room.first_stretches
    stretches = weigh_stretches(
        air, guide, ray, h, sun[2], dot(direction, sun), first <= 1, 1, cumulative
    )
    total = 0.0
    for i in range(samples):
        u = (i + uniform(state)) / samples
        total += follow(
            air,
            guide,
            sun,
            occultation,
            air.r_bottom + h,
            ray,
            stretches,
            cumulative,
            u,
            up,
            h,
            direction,
            first,
            last,
            scratch,
            track,
            state,
        )
    return total / samples


def mean_irradiance(
    air: Air,
    guide: Guide,
    sun: Direction,
    occultation: Occultation,
    h: float,
    facing: float,
    samples: int,
    seed: np.uint64,
) -> float:
    """Mean diffuse irradiance on a horizontal plane over `samples` paths.

    Parameters
    ----------
    facing : float
        1 for light from above, -1 for light from below.
    """
    state = np.array([seed], np.uint64)
    room = _new_room(air)
    light = air, guide, sun, occultation
    return float(_mean_irradiance(*light, h, facing, samples, room, no_track(), state))


@kernel
def _mean_irradiance(air, guide, sun, occultation, h, facing, samples, room, track, state):
    up = (0.0, 0.0, 1.0)
    normal = (0.0, 0.0, facing)
    scratch = (room.cuts, room.stretches, room.coefficients)
    cumulative = room.first_stretches
    top = air.altitude[-1]
    coefficients = room.first_coefficients
    scattering = 0.0
    # Outside, all light comes from the cone that the atmosphere fills.
    cone = 1.0
    if h < top:
        scattering = scattering_at(air, shell_of(air.altitude, h), h, coefficients)
    else:
        cone = ((air.r_bottom + top) / (air.r_bottom + h)) ** 2
    around_sun = 0.5 if scattering > 0.0 and facing * sun[2] > 0.0 else 0.0
    total = 0.0
    for _ in range(samples):
        if uniform(state) < around_sun:
            direction = draw_lobe(air, coefficients, scattering, sun, state)
        else:
            direction = draw_cosine(normal, cone, state)
        cosine = dot(direction, normal)
        if cosine <= 0.0:
            continue
        density = (1.0 - around_sun) * cosine / (math.pi * cone)
        if around_sun > 0.0:
            _, lobe = phase_and_lobe(air, coefficients, scattering, direction, sun)
            density += around_sun * lobe
        ray = trace(air, h, direction[2], room.first_cuts)
        stretches = weigh_stretches(
            air, guide, ray, h, sun[2], dot(direction, sun), True, 1, cumulative
        )
        total += (cosine / density) * follow(
            air, guide, sun, occultation, air.r_bottom + h, ray, stretches, cumulative,
            uniform(state), up, h, direction, 1, np.iinfo(np.int64).max, scratch, track, state,
        )  # fmt: skip
    return total / samples
