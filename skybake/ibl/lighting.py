"""All lighting maps of surroundings, in memory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from skybake.ibl.cube import Array, Cube, coarser
from skybake.ibl.dfg import dfg_table
from skybake.ibl.diffuse import diffuse_cube
from skybake.ibl.harmonics import harmonics_of
from skybake.ibl.settings import LightingMaps
from skybake.ibl.specular import SpecularFilter
from skybake.ibl.surroundings import Surroundings
from skybake.jit.workers import ALL_CPUS, Workers


@dataclass(frozen=True, kw_only=True, eq=False)
class Lighting:
    """Lighting maps; None of what was not asked for.

    Attributes
    ----------
    specular : list of ndarray of float32, shape (6, edge, edge, 3), or None
        What mirrors show, by the levels of `LightingMaps.levels`.
    diffuse : ndarray of float32, shape (6, edge, edge, 3), or None
        What white diffuse surfaces show: irradiance over pi.
    harmonics : ndarray of float64, shape (9, 3), or None
        Of the light, see `skybake.ibl.harmonics.harmonics_of`.
    dfg : ndarray of float32, shape (edge, edge, 2), or None
        See `skybake.ibl.dfg.dfg_table`.
    """

    specular: list[Cube] | None
    diffuse: Cube | None
    harmonics: Array | None
    dfg: npt.NDArray[np.float32] | None


def light(
    around: Surroundings,
    maps: LightingMaps,
    workers: Workers = ALL_CPUS,
    begin: Callable[[str], None] = lambda _: None,
) -> Lighting:
    """Make lighting maps.

    Parameters
    ----------
    around : Surroundings
        The light.
    maps : LightingMaps
        Which maps.
    workers : Workers, optional
        Threads that do the work; the maps have the same bits for any number.
    begin : callable, optional
        Called with the part that begins, one of `skybake.ibl.settings.PARTS`.

    Raises
    ------
    CancelledError
        If the workers were stopped.
    """
    specular = diffuse = harmonics = dfg = None
    if "specular" in maps.parts:
        begin("specular")
        specular = specular_levels(around, maps, workers)
    if "diffuse" in maps.parts:
        begin("diffuse")
        diffuse = diffuse_cube(around.smooth, around.points, maps.diffuse_size, workers)
    if "sh" in maps.parts:
        begin("sh")
        harmonics = harmonics_of(around.smooth, around.points)
    if "dfg" in maps.parts:
        begin("dfg")
        table = dfg_table(maps.dfg_size, multiscatter=maps.dfg_multiscatter, workers=workers)
        dfg = table[::-1] if maps.dfg_upward else table
    return Lighting(specular=specular, diffuse=diffuse, harmonics=harmonics, dfg=dfg)


def specular_levels(
    around: Surroundings, maps: LightingMaps, workers: Workers = ALL_CPUS
) -> list[Cube]:
    """Return the specular cube, the map itself and what rougher mirrors show."""
    (edge, _), *rough = maps.levels()
    filtered = SpecularFilter(around.smooth, around.points)
    return [
        coarser(around.cube, edge),
        *(filtered.cube(size, roughness, maps.samples, workers) for size, roughness in rough),
    ]
