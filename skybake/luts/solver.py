"""All orders of scattering: the diffuse field by iteration of one scattering after another."""

from __future__ import annotations

import math

import numpy as np

from skybake.errors import InputError
from skybake.luts.anderson import Anderson
from skybake.luts.field import (
    DiffuseField,
    altitude_weight,
    count_degrees,
    fill_ground_irradiance,
    fill_scattering,
    sun_weights,
)
from skybake.luts.grid import ORDER, Grid, build_grid, empty_field, project
from skybake.luts.harmonics import fill_harmonics
from skybake.luts.ray import trace_rays
from skybake.optics.legendre import Truncation, legendre_polynomials
from skybake.optics.medium import Array, altitude_nodes
from skybake.transport.kernel import kernel, run_rows
from skybake.transport.shells import altitude_shells
from skybake.transport.trace import allocate_samples, trace

FIRST_SHELLS = 15
SHELLS = 13
TOLERANCE = 4e-3
"""Last relative change, where a scattering leaves little; the square of what is lost in
one scales it, since in thick air a small change is not a small error."""

LEAST_TOLERANCE = 3e-5
MAX_PASSES = 120

MAX_DEPTH = 6.0
"""Vertical optical depth up to which the solution is good; where nothing is absorbed, the
small losses of each pass add up to 8 % of the light at the ground at depth 10, and to more
than half of it at depth 30."""

LAST_JUDGED = math.radians(110.0)
"""Solar zenith angle up to which the solution must converge; beyond it is night. [rad]"""

ARC = math.radians(2.0)
FIRST_ARC = math.radians(1.5)

LANES = 16
"""The solver pads wavelengths to a multiple: loops of known length become plain vector code."""


def solve_field(cut: Truncation, columns: Array) -> DiffuseField:
    """Solve for the light that was scattered at least once.

    Parameters
    ----------
    cut : Truncation
        The atmosphere without forward peaks beyond `ORDER`.
    columns : ndarray
        Table of `build_columns`.

    Returns
    -------
    DiffuseField
        Moments of all orders of scattering and reflection.

    Raises
    ------
    InputError
        If the iteration does not converge, in air that is optically too thick.

    Notes
    -----
    L = L1 + K L, with K one transport and one scattering in the truncated medium,
    is iterated from L = L1. Anderson's method mixes the last passes, without
    which optical depth 10 takes 70 passes and 30 does not come to an end.
    """
    depth = _vertical_depth(cut)
    if depth > MAX_DEPTH:
        raise InputError(
            f"multiple scattering: optical depth of the air must be at most {MAX_DEPTH:g} at every "
            f"wavelength for --method full, got {depth:.3g}; use probe --method reference, or "
            "--method hillaire"
        )
    wavelengths = cut.moments.shape[2]
    cut = _pad_wavelengths(cut)
    grid = build_grid(cut)
    first = _first_order(cut, columns, grid)
    field = first
    mixing = Anderson(first.ground.size)
    start = _state(first)
    state = start
    judged = np.repeat(grid.sun_angle < LAST_JUDGED, first.ground.shape[1])
    sunlit = np.repeat(grid.sun_angle < 0.5 * math.pi, first.ground.shape[1])
    tolerance, previous = TOLERANCE, np.zeros(0)
    for turn in range(MAX_PASSES):
        image = start + _state(_scatter(cut, field, grid))
        step = np.linalg.norm(image - state, axis=1)
        change = (step / np.maximum(np.linalg.norm(image, axis=1), 1e-30))[judged].max()
        if turn == 1:
            # The first step is not mixed yet: the ratio is what one scattering leaves.
            left = float((step / np.maximum(previous, 1e-30))[sunlit].max())
            tolerance = max(TOLERANCE * max(1.0 - left, 0.0) ** 2, LEAST_TOLERANCE)
        if turn > 0 and change < tolerance:
            return _keep_wavelengths(_field(first, image), wavelengths)
        previous = step
        state = mixing.step(state, image)
        field = _field(first, state)
    raise InputError(
        "multiple scattering: must converge within "
        f"{MAX_PASSES} passes to {tolerance:.2g}, got {change:.2g}; use probe --method "
        "reference, or --method hillaire"
    )


def _vertical_depth(cut: Truncation) -> float:
    """Largest vertical optical depth over wavelength, forward peaks left out."""
    medium = cut.medium
    altitude = altitude_nodes(medium.r_bottom, medium.r_top)
    columns = np.asarray(np.trapezoid(medium.density, altitude, axis=0))
    return float((columns @ medium.extinction).max())


def _pad_wavelengths(cut: Truncation) -> Truncation:
    """Repeat the last wavelength until their number is a multiple of `LANES`."""
    last = cut.moments.shape[2] - 1
    index = np.minimum(np.arange(-(-(last + 1) // LANES) * LANES), last)
    medium = cut.medium
    return cut._replace(
        medium=medium._replace(
            scattering=np.ascontiguousarray(medium.scattering[:, index]),
            extinction=np.ascontiguousarray(medium.extinction[:, index]),
            phase=np.ascontiguousarray(medium.phase[:, :, index]),
            ground_albedo=medium.ground_albedo[index],
        ),
        moments=np.ascontiguousarray(cut.moments[:, :, index]),
        fraction=np.ascontiguousarray(cut.fraction[:, index]),
        scattering=np.ascontiguousarray(cut.scattering[:, index]),
        mixture=cut.mixture[index],
        phase=np.ascontiguousarray(cut.phase[:, :, index]),
    )


def _keep_wavelengths(field: DiffuseField, count: int) -> DiffuseField:
    """Drop what `_pad_wavelengths` added."""
    return field._replace(
        source=np.ascontiguousarray(field.source[:, :, :count]),
        radiance=np.ascontiguousarray(field.radiance[..., :count]),
        ground=np.ascontiguousarray(field.ground[:, :count]),
    )


def _first_order(cut: Truncation, columns: Array, grid: Grid) -> DiffuseField:
    """Moments of the light scattered or reflected exactly once."""
    base = cut._replace(peaked=cut.peaked[:0], phase=cut.medium.phase)
    constituents = base.phase.shape[0]
    dark = empty_field(cut, grid.altitude[:1], grid.sun_angle, 0)
    shells = altitude_shells(cut.medium, FIRST_SHELLS)
    field = empty_field(cut, grid.altitude, grid.sun_angle, ORDER)
    degree = np.arange(ORDER + 1)
    series = cut.moments * ((2 * degree + 1) / (4.0 * math.pi))[:, None]
    for i in range(grid.altitude.size):
        mu, sun, azimuth = np.meshgrid(grid.mu[i], grid.sun_angle, grid.azimuth, indexing="ij")
        mu_s = np.cos(sun)
        nu = mu * mu_s + np.sqrt(1.0 - mu**2) * np.sin(sun) * np.cos(azimuth)
        r = np.full(mu.size, _radius(cut, grid.altitude[i]))
        light = trace_rays(
            base,
            shells,
            columns,
            dark,
            r,
            mu.ravel(),
            mu_s.ravel(),
            nu.ravel(),
            max_arc=FIRST_ARC,
        )
        polynomials = legendre_polynomials(nu.ravel(), ORDER)
        radiance = light.diffuse
        for c in range(constituents):
            radiance += light.single[:, c] * (polynomials.T @ series[c])
        project(grid, i, radiance.reshape(*mu.shape, -1), field)
    return field


def _radius(cut: Truncation, altitude: float) -> float:
    """Radius of a node; one on the ground is lifted, for its rays to see the sky."""
    return cut.medium.r_bottom + max(altitude, 1e-8)


def _scatter(cut: Truncation, field: DiffuseField, grid: Grid) -> DiffuseField:
    """Scatter a field once more and transport it; the ground reflects its irradiance."""
    shells = altitude_shells(cut.medium, SHELLS)
    polar, sun, azimuth = grid.mu.shape[1], grid.sun_angle.size, grid.azimuth.size
    suns = np.stack([np.cos(grid.sun_angle), np.sin(grid.sun_angle)], axis=1)
    around = np.cos(grid.azimuth)
    out = np.zeros((grid.altitude.size, polar, sun, azimuth, field.ground.shape[1]), np.float32)

    def work(first: int, last: int) -> None:
        samples = allocate_samples(cut.medium)
        _scatter_rows(cut.medium, shells, field, grid, suns, around, samples, first, last, out)

    run_rows(grid.altitude.size * polar, work, chunk=polar)
    scattered = field._replace(
        radiance=np.empty_like(field.radiance), ground=np.empty_like(field.ground)
    )
    for i in range(grid.altitude.size):
        project(grid, i, out[i], scattered)
    return scattered


@kernel
def _scatter_rows(medium, shells, field, grid, suns, around, samples, first, last, out):
    """Radiance of one more scattering, for rays numbered altitude * polar + direction."""
    polar, wavelengths = out.shape[1], out.shape[4]
    order = field.harmonics.order
    fourier = np.empty((suns.shape[0], (order + 1) * wavelengths), np.float32)
    scattering = np.empty((order + 1, wavelengths), np.float32)
    harmonic = np.empty(field.harmonics.degree.size)
    weights = np.empty(4)
    terms = np.empty((order + 1) * wavelengths, np.float32)
    sky = np.empty(wavelengths)
    whole = np.empty(wavelengths)
    for ray in range(first, last):
        i, a = ray // polar, ray % polar
        r = medium.r_bottom + max(grid.altitude[i], 1e-8)
        mu = grid.mu[i, a]
        # A sun in the zenith casts no shadow: the diffuse field knows the shadow already.
        count, length, hits_ground = trace(medium, shells, ARC, r, mu, 1.0, mu, samples)
        for k in range(wavelengths):
            whole[k] = 0.0
        for n in range(count):
            fill_scattering(field, samples, n, n + 1, np.int64(1), scattering)
            for k in range(wavelengths):
                whole[k] += scattering[0, k]
        for n in range(count):
            radius, t = samples.radius[n], samples.distance[n]
            fill_scattering(field, samples, n, n + 1, order + 1, scattering)
            degrees = count_degrees(scattering, whole)
            if degrees == 0:
                continue
            mu_here = min(max((r * mu + t) / radius, -1.0), 1.0)
            fill_harmonics(field.harmonics, mu_here, harmonic)
            low, u = altitude_weight(field.altitude, radius - medium.r_bottom)
            _collapse_degrees(field, low, u, harmonic, scattering, degrees, fourier)
            sine = math.sqrt(1.0 - mu_here * mu_here)
            for j in range(suns.shape[0]):
                along = mu * suns[j, 0]
                across = math.sqrt(1.0 - mu * mu) * suns[j, 1]
                for b in range(around.size):
                    nu = along + across * around[b]
                    mu_s_here = min(max((r * suns[j, 0] + t * nu) / radius, -1.0), 1.0)
                    sines = sine * math.sqrt(1.0 - mu_s_here * mu_s_here)
                    cosine = 1.0 if sines < 1e-12 else (nu - mu_here * mu_s_here) / sines
                    cosine = min(max(cosine, -1.0), 1.0)
                    node = sun_weights(field.sun_angle, field.sun_bin, mu_s_here, weights)
                    _add_azimuth(
                        fourier,
                        node,
                        weights,
                        cosine,
                        degrees * wavelengths,
                        terms,
                        out[i, a, j, b],
                    )
        if hits_ground:
            for j in range(suns.shape[0]):
                for b in range(around.size):
                    nu = mu * suns[j, 0] + math.sqrt(1.0 - mu * mu) * suns[j, 1] * around[b]
                    mu_s_ground = (r * suns[j, 0] + length * nu) / medium.r_bottom
                    fill_ground_irradiance(field, min(max(mu_s_ground, -1.0), 1.0), weights, sky)
                    for k in range(wavelengths):
                        reflected = medium.ground_albedo[k] / math.pi * sky[k]
                        out[i, a, j, b, k] += samples.transmittance[k] * reflected


@kernel
def _collapse_degrees(field, low, u, harmonic, scattering, degrees, out):
    """Sum over l of the scattered moments at one altitude, shape (sun, m * wavelength)."""
    order = field.harmonics.order
    wavelengths = scattering.shape[1]
    upper = np.float32(u)
    for j in range(out.shape[0]):
        p = 0
        for m in range(degrees):
            for block in range(0, wavelengths, LANES):
                for k in range(block, block + LANES):
                    out[j, m * wavelengths + k] = 0.0
            for degree in range(m, degrees):
                factor = np.float32(harmonic[p])
                for block in range(0, wavelengths, LANES):
                    for k in range(block, block + LANES):
                        below = field.radiance[low, j, p, k]
                        above = field.radiance[low + 1, j, p, k]
                        out[j, m * wavelengths + k] += (
                            factor * scattering[degree, k] * (below + upper * (above - below))
                        )
                p += 1
            p += order + 1 - degrees


@kernel
def _add_azimuth(fourier, node, weights, cosine, size, terms, out):
    """Add a Fourier series in azimuth, interpolated between four sun angles."""
    a, b = np.float32(weights[0]), np.float32(weights[1])
    c, d = np.float32(weights[2]), np.float32(weights[3])
    for p in range(size):
        terms[p] = (
            a * fourier[node, p]
            + b * fourier[node + 1, p]
            + c * fourier[node + 2, p]
            + d * fourier[node + 3, p]
        )
    for block in range(0, out.size, LANES):
        before, now = np.float32(cosine), np.float32(1.0)
        twice = np.float32(2.0 * cosine)
        for first in range(block, size, out.size):
            for k in range(LANES):
                out[block + k] += now * terms[first + k]
            before, now = now, twice * now - before


def _state(field: DiffuseField) -> Array:
    """Field as one vector for each sun angle and wavelength, for the iteration."""
    columns = field.radiance.transpose(1, 3, 0, 2).reshape(field.ground.size, -1)
    return np.concatenate([columns, field.ground.reshape(-1, 1)], axis=1, dtype=np.float32)


def _field(like: DiffuseField, state: Array) -> DiffuseField:
    """Inverse of `_state`."""
    altitudes, suns, moments, wavelengths = like.radiance.shape
    columns = state[:, :-1].reshape(suns, wavelengths, altitudes, moments)
    return like._replace(
        radiance=np.ascontiguousarray(columns.transpose(2, 0, 3, 1), dtype=np.float32),
        ground=state[:, -1].reshape(suns, wavelengths).astype(float),
    )
