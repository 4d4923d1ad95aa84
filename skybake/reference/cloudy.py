"""What the path tracer computes where there are clouds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.errors import InputError
from skybake.jit.workers import ALL_CPUS
from skybake.optics.medium import Medium
from skybake.reference.air import air_at
from skybake.reference.batches import estimate_means, samples_per_batch
from skybake.reference.cloudy_paths import CloudyScene, mean_cloudy_radiance
from skybake.reference.directions import Direction
from skybake.reference.guide import make_guide
from skybake.reference.majorants import air_peaks, bound_clouds
from skybake.reference.tracking import Clouds

Array = npt.NDArray[np.float64]


def radiance(
    medium: Medium,
    fields: Sequence[CloudField],
    phases: Sequence[Array],
    altitude: float,
    sun_elevation: float,
    sun_bearing: float,
    zenith: npt.ArrayLike,
    bearing: npt.ArrayLike,
    *,
    samples: int,
    seed: int = 0,
) -> tuple[Array, Array]:
    """Radiance of a cloudy sky by backward Monte Carlo, unbiased, with its standard error.

    What is solved is that of `skybake.reference.estimate.radiance`, with clouds that only
    scatter. The sun's direct view is excluded, through clouds too.

    Parameters
    ----------
    medium : Medium
        The air and the ground.
    fields : sequence of CloudField
        Layers of clouds, at least one.
    phases : sequence of ndarray, shape (SCATTERING_ANGLES, wavelength)
        Phase function of each layer. [sr⁻¹]
    altitude : float
        Of the observer, also above the atmosphere, >= 0. [km]
    sun_elevation, sun_bearing : float
        At the observer; bearings are clockwise from north. [rad]
    zenith, bearing : array_like, broadcast to shape (direction,)
        Zenith angle and bearing of the view. [rad]
    samples : int
        Paths for each direction and wavelength, rounded up to a multiple of
        `skybake.reference.batches.BATCHES`.
    seed : int, optional
        Same seed, same result, for any number of threads.

    Returns
    -------
    mean, stderr : ndarray of float64, shape (direction, wavelength)
        Per unit solar irradiance at the top of the atmosphere. [sr⁻¹]

    Raises
    ------
    InputError
        If an argument is out of range.

    Notes
    -----
    The first ray is drawn twice: where the air or the ground sends light back, guided as
    without clouds, and where clouds do. Later flights end in null collisions with bounds of the
    extinction (Woodcock et al. 1965); transmittances of clouds toward the sun are products over
    such collisions (Novák et al. 2014), those of the air exact. At a share of the vertices a
    second path sets out toward the sun, and both are weighted by the balance heuristic. Where
    the sun is behind thin cloud the error's distribution has a long tail.
    """
    sun, views = _directions(altitude, sun_elevation, sun_bearing, zenith, bearing)
    scenes = _scenes(medium, fields, phases)
    per_batch = samples_per_batch(samples)

    def mean(view: int, wavelength: int, batch: np.uint64) -> float:
        scene = scenes[wavelength]
        return mean_cloudy_radiance(scene, sun, altitude, views[view], per_batch, batch)

    return estimate_means(len(views), len(scenes), seed, mean)


def _scenes(
    medium: Medium, fields: Sequence[CloudField], phases: Sequence[Array]
) -> list[CloudyScene]:
    """One scene for each wavelength."""
    _check_clouds(medium, fields, phases)
    bounds = tuple(bound_clouds(field) for field in fields)
    top = max(each.base + (len(each.reach) - 1) * float(each.cell[0]) for each in bounds)
    clouds = Clouds(tuple(fields), bounds, top)
    nothing = np.zeros((len(fields), medium.scattering.shape[1]))
    with_clouds = medium._replace(
        density=np.pad(medium.density, ((0, 0), (0, len(fields)))),
        scattering=np.concatenate([medium.scattering, nothing]),
        extinction=np.concatenate([medium.extinction, nothing]),
        phase=np.concatenate([medium.phase, np.stack(phases)]),
    )
    wavelengths = medium.scattering.shape[1]
    scenes: list[CloudyScene] = [None] * wavelengths  # type: ignore[list-item]

    def build(begin: int, end: int) -> None:
        for i in range(begin, end):
            air = air_at(with_clouds, i)
            scenes[i] = CloudyScene(air, air_peaks(air), make_guide(air_at(medium, i)), clouds)

    ALL_CPUS.run_rows(wavelengths, build)
    return scenes


def _check_clouds(medium: Medium, fields: Sequence[CloudField], phases: Sequence[Array]) -> None:
    if not fields or len(fields) != len(phases):
        message = f"phases: must be one for each of the fields, got {len(phases)}"
        raise InputError(message)
    expected = medium.phase.shape[1:]
    for phase in phases:
        if phase.shape != expected:
            message = f"phases: must have the shape {expected}, got {phase.shape}"
            raise InputError(message)
    for field in fields:
        if field.top > medium.r_top - medium.r_bottom:
            message = f"fields: must be within the atmosphere, got a top at {field.top} km"
            raise InputError(message)


def _directions(
    altitude: float,
    sun_elevation: float,
    sun_bearing: float,
    zenith: npt.ArrayLike,
    bearing: npt.ArrayLike,
) -> tuple[Direction, list[Direction]]:
    """Sun and views as unit vectors, x east, y north and z up."""
    angle, azimuth = np.broadcast_arrays(
        np.atleast_1d(np.asarray(zenith, dtype=np.float64)), bearing
    )
    named: dict[str, float | Array] = {
        "altitude": altitude,
        "sun_elevation": sun_elevation,
        "sun_bearing": sun_bearing,
        "zenith": angle,
        "bearing": azimuth,
    }
    for name, values in named.items():
        if not np.all(np.isfinite(values)):
            message = f"{name}: must be finite, got {values}"
            raise InputError(message)
    if altitude < 0.0:
        message = f"altitude: must be >= 0 km, got {altitude}"
        raise InputError(message)
    flat = math.cos(sun_elevation)
    sun = (flat * math.sin(sun_bearing), flat * math.cos(sun_bearing), math.sin(sun_elevation))
    x, y, z = np.sin(angle) * np.sin(azimuth), np.sin(angle) * np.cos(azimuth), np.cos(angle)
    return sun, [(float(a), float(b), float(c)) for a, b, c in zip(x, y, z, strict=True)]
