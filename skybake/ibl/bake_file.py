"""Bakes a set of lighting maps of a map in a file, ours or another."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from skybake.colour.space import COLOUR_SPACES
from skybake.environment.load import load_environment
from skybake.formats.spec import MapSpec
from skybake.ibl.bake import BakedLighting, Begin, ignore, write_baked
from skybake.ibl.files import FileForm, lighting_paths
from skybake.ibl.map_file import stated_disc, surroundings_of_environment
from skybake.ibl.settings import LightingMaps
from skybake.jit.workers import ALL_CPUS, Workers


def bake_lighting_of_file(
    source: Path,
    output: Path,
    maps: LightingMaps | None = None,
    form: FileForm | None = None,
    *,
    keeps_sun: bool = True,
    rotation: float = 0.0,
    workers: Workers = ALL_CPUS,
    begin: Begin = ignore,
) -> BakedLighting:
    """Bake lighting maps of a map in a file, of whatever layout.

    Parameters
    ----------
    source : Path
        See `skybake.environment.load.load_environment`.
    output, maps, form, begin
        As of `bake_lighting`.
    keeps_sun : bool, optional
        Keep what the map holds of a sun. Without it is taken away, where the map states it.
    rotation : float, optional
        Compass bearing that -Z looks to. [rad]
    workers : Workers, optional
        Threads that do the work.

    Raises
    ------
    SkybakeError
        If the map, a setting or a target cannot be used; no file is left then.
    """
    maps, form = maps or LightingMaps(), form or FileForm()
    lighting_paths(output, maps, form)
    begin("map")
    environment = load_environment(source)
    disc = None if keeps_sun else stated_disc(source, environment)
    around = surroundings_of_environment(environment, maps, rotation, disc, workers)
    space = environment.space or next(iter(COLOUR_SPACES.values()))
    spec = MapSpec(
        *(1, 1, space, environment.white_luminance), attributes={"skybake:source": source.name}
    )
    baked = write_baked(around, output, maps, form, spec, workers, begin)
    return replace(baked, warnings=environment.warnings)
