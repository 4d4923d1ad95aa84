"""Finds the share that an eclipse leaves of diffuse light, by the balance of what arrives."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from skybake.eclipse.diffuse import (
    AZIMUTHS,
    RINGS,
    SLOPES,
    DiffuseShare,
    new_corner,
    sum_diffuse,
    sum_sunlight,
)
from skybake.eclipse.emitters import Emitters, look_around
from skybake.eclipse.shadow import Shadow, axis_on_ground, shares_at
from skybake.jit.arguments import flatten
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.scattering.tables import Atmosphere

Array = npt.NDArray[np.float64]

ALTITUDES = np.array([0.0, 0.02, 0.06, 0.12, 0.22, 0.38, 0.6, 1.0])
"""Altitudes at which the share is tabulated, over that of the top."""

MOST_PASSES = 4
TOLERANCE = 0.01
"""Relative change of a share by a pass at which the balance is found."""

SLOWEST = 0.8
"""Largest ratio of changes by successive passes from which the rest is extrapolated."""

DARK = 1e-12
"""Light per irradiance below which its share is that of sunlight."""


def no_table(planet: float, bottom: float, wavelengths: int) -> DiffuseShare:
    """Return a table by which diffuse light has the share of sunlight at each place."""
    return DiffuseShare(
        planet=planet,
        bottom=bottom,
        axes=np.eye(3),
        altitude=np.array([0.0, 1.0]),
        share=np.ones((2, 0, AZIMUTHS, SLOPES.size, wavelengths)),
        ground=np.ones((0, AZIMUTHS, wavelengths)),
    )


def balance_diffuse(
    atmosphere: Atmosphere,
    shadow: Shadow,
    radius: float,
    *,
    workers: Workers = ALL_CPUS,
) -> DiffuseShare:
    """Find the share of diffuse light around the observer, or around the shadow's axis.

    What a place scatters on is what arrives from all the air and ground around it. Its share in an
    eclipse is the sum over these of what each sends of sunlight, times the share that is uncovered
    there, and of diffuse light, times the share that this table itself has there, over the same
    sums without the eclipse. It depends on how steeply the observer looks at the place, as in an
    eclipse light arrives from other elevations than by day, but not on the azimuth, and where
    light comes from is as at the table's centre.

    Parameters
    ----------
    atmosphere : Atmosphere
        What scatters.
    shadow : Shadow
        Of the moon, for the padded wavelengths of `ScaledMedium`.
    radius : float
        Of the observer. [km]
    workers : Workers, optional
        Threads that do the work.
    """
    medium = atmosphere.scaled.medium
    bottom, top = medium.r_bottom, medium.r_top
    table = no_table(radius, bottom, shadow.powers.shape[1])
    if atmosphere.field.altitude.size < 2:
        return table
    centre = (
        np.array([0.0, 0.0, radius]) if radius <= top else axis_on_ground(shadow, radius, bottom)
    )
    if centre is None:
        return table
    up = centre / np.linalg.norm(centre)
    sun = shadow.sun / np.linalg.norm(shadow.sun)
    altitude = ALTITUDES * (top - bottom)
    axes = _axes(up, sun)
    turns = _turns(axes, sun, radius, bottom)
    sums = _Sums(atmosphere, shadow, turns, altitude, float(up @ sun), workers)
    table = table._replace(axes=axes, altitude=altitude)
    shares: Array = np.ones(())
    step: Array = np.zeros(())
    for _ in range(MOST_PASSES):
        found = sums.shares(table).reshape(
            -1, len(RINGS), AZIMUTHS, SLOPES.size, shadow.powers.shape[1]
        )
        before, step, shares = step, found - shares, found
        if np.all(np.abs(step) <= TOLERANCE * shares):
            break
        table = table._replace(share=shares[:-1].copy(), ground=shares[-1, ..., 0, :].copy())
    # Light that comes by way of many scatterings is the sum of a geometric series, nearly.
    ratio = step / np.where(before == 0.0, 1.0, before)
    ratio = np.where((before > 0.0) & (ratio > 0.0), np.minimum(ratio, SLOWEST), 0.0)
    shares = np.minimum(shares + step * ratio / (1.0 - ratio), 1.0)
    return table._replace(share=shares[:-1].copy(), ground=shares[-1, ..., 0, :].copy())


def _axes(up: Array, sun: Array) -> Array:
    """Rows toward the sun's bearing, to the right of it, and up."""
    ahead = sun - (sun @ up) * up
    length = float(np.linalg.norm(ahead))
    if length < 1e-9:
        ahead, length = np.cross([0.0, 1.0, 0.0], up), 1.0
        length = float(np.linalg.norm(ahead))
    ahead = ahead / length
    return np.stack([ahead, np.cross(up, ahead), up])


def _turns(axes: Array, sun: Array, radius: float, bottom: float) -> Array:
    """From the axes of each node of the table to those of `Shadow`, shape (place, 4, 3)."""
    around = 2.0 * math.pi * np.arange(AZIMUTHS) / AZIMUTHS
    turns = np.empty((len(RINGS), AZIMUTHS, 4, 3))
    for i, j in np.ndindex(turns.shape[:2]):
        arc = RINGS[i] / bottom
        flat = math.cos(around[j]) * axes[0] + math.sin(around[j]) * axes[1]
        up = math.cos(arc) * axes[2] + math.sin(arc) * flat
        turns[i, j, :3] = _axes(up, sun).T
        turns[i, j, 3] = 0.0, 0.0, -radius
    return turns.reshape(-1, 4, 3)


class _Sums:
    """Shares of what arrives at each altitude, and on the ground from above, at each place."""

    def __init__(
        self,
        atmosphere: Atmosphere,
        shadow: Shadow,
        turns: Array,
        altitude: Array,
        mu_s: float,
        workers: Workers,
    ) -> None:
        self._shadow, self._turns, self._workers = flatten(shadow), turns, workers
        # From the top itself nothing is above.
        seen_from = np.minimum(altitude, 0.99 * altitude[-1])
        self._receivers = [
            look_around(atmosphere, float(h), mu_s, horizontally=False) for h in seen_from
        ]
        self._receivers.append(look_around(atmosphere, 0.0, mu_s, horizontally=True))
        self._wavelengths = shadow.powers.shape[1]
        self._sunlight = self._run(self._sunlight_at)
        radii = atmosphere.medium.r_bottom + np.append(seen_from, 0.0)
        places = turns[:, :3, 2] * radii[:, None, None] + turns[:, 3]
        self._local = shares_at(shadow, places)

    def shares(self, table: DiffuseShare) -> Array:
        """Return the shares by a table, shape (receiver, place, slope, wavelength)."""
        flat, rings = flatten(table), flatten(RINGS)
        arrived = self._sunlight
        whole = np.stack([_bundled(one, one.sunlight) for one in self._receivers])
        if table.share.shape[1] > 0:

            def at(one: Emitters, turn: Array, out: Array) -> None:
                share = np.empty(self._wavelengths)
                sum_diffuse(
                    self._shadow, flat, rings, new_corner(), one.place, one.bundle, one.on_ground,
                    one.diffuse, turn, share, out,
                )  # fmt: skip

            arrived = arrived + self._run(at)
            whole = whole + np.stack([_bundled(one, one.diffuse) for one in self._receivers])
        shares = np.empty((*arrived.shape[:2], SLOPES.size, self._wavelengths))
        for k, one in enumerate(self._receivers):
            left, all_of_it = (
                np.einsum("sbw,...bw->...sw", one.scatter, light[k]) for light in (arrived, whole)
            )
            is_dark = np.broadcast_to(all_of_it < DARK, left.shape)
            share = left / np.maximum(all_of_it, DARK)
            shares[k] = np.where(is_dark, self._local[k, :, None], share)
        return np.clip(shares, 0.0, 1.0)

    def _run(self, at: Callable[[Emitters, Array, Array], None]) -> Array:
        places, bundles = len(self._turns), self._receivers[0].scatter.shape[1]
        out = np.empty((len(self._receivers), places, bundles, self._wavelengths))

        def work(first: int, last: int) -> None:
            for i in range(first, last):
                receiver, place = divmod(i, places)
                at(self._receivers[receiver], self._turns[place], out[receiver, place])

        self._workers.run_rows(len(self._receivers) * places, work, chunk=64)
        return out

    def _sunlight_at(self, one: Emitters, turn: Array, out: Array) -> None:
        share = np.empty(self._wavelengths)
        sum_sunlight(self._shadow, one.place, one.bundle, one.sunlight, turn, share, out)


def _bundled(emitters: Emitters, light: Array) -> Array:
    """Sum the light of each bundle, shape (bundle, wavelength)."""
    sums = np.zeros(emitters.scatter.shape[1:])
    np.add.at(sums, emitters.bundle, light)
    return sums
