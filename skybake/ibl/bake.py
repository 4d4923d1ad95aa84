"""Bakes a set of lighting maps of a sky."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from skybake.baking.losses import scene_warnings
from skybake.formats.spec import Attribute, MapSpec
from skybake.ibl.files import FileForm, lighting_paths, write_lighting
from skybake.ibl.lighting import light
from skybake.ibl.settings import LightingMaps
from skybake.ibl.surroundings import Surroundings, surroundings_of_scene
from skybake.image.light import (
    attributes_from_light,
    eclipse_attributes,
    light_of_scene,
    night_attributes,
)
from skybake.image.recipe import recipe_attributes
from skybake.image.scene import Scene
from skybake.jit.workers import Workers

Begin = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class BakedLighting:
    """What was baked.

    Attributes
    ----------
    files : tuple of Path
        All of them.
    white_luminance : float or None
        Luminance that a value of 1 stands for, if that is known. [cd m⁻²]
    points : int
        Points of light that were convolved exactly: parts of the sun's disc, or texels of spots.
    clamped : int
        Negative values that became 0 in a type that has no sign.
    warnings : tuple of str
        What may not be as it was meant, a line each.
    """

    files: tuple[Path, ...]
    white_luminance: float | None
    points: int
    clamped: int
    warnings: tuple[str, ...] = ()


def ignore(_: str) -> None:
    """Take no notice of a stage that begins."""


def bake_lighting(
    scene: Scene,
    output: Path,
    maps: LightingMaps | None = None,
    form: FileForm | None = None,
    *,
    attributes: Mapping[str, Attribute] | None = None,
    begin: Begin = ignore,
) -> BakedLighting:
    """Bake lighting maps of a sky.

    Parameters
    ----------
    scene : Scene
        The sky, of which `sun_disc` says whether its sun is in the maps.
    output : Path
        What the files' names begin with, or a folder, see `skybake.ibl.files.lighting_paths`.
    maps : LightingMaps, optional
        Which maps.
    form : FileForm, optional
        How they are stored.
    attributes : mapping of str to Attribute, optional
        What files shall state besides their light and their recipe.
    begin : callable, optional
        Called with the stage that begins.

    Raises
    ------
    SkybakeError
        If a setting or a target cannot be used; no file is left then.
    """
    maps, form = maps or LightingMaps(), form or FileForm()
    lighting_paths(output, maps, form)
    _ = scene.sun  # which can be refused, before what takes long
    if scene.planet.clouds:
        begin("clouds")
        scene.light_clouds()
    begin("sky")
    around = surroundings_of_scene(scene, maps.source_edge)
    encoding = scene.settings.encoding
    stated = {
        **attributes_from_light(light_of_scene(scene)),
        **eclipse_attributes(scene),
        **night_attributes(scene),
        **recipe_attributes(scene.planet, scene.settings),
        **(attributes or {}),
    }
    spec = MapSpec(
        *(1, 1, encoding.space, encoding.white_luminance),
        compression=encoding.compression,
        attributes=stated,
    )
    baked = write_baked(around, output, maps, form, spec, scene.workers, begin)
    return replace(baked, warnings=tuple(scene_warnings(scene, around.peak)))


def write_baked(
    around: Surroundings,
    output: Path,
    maps: LightingMaps,
    form: FileForm,
    spec: MapSpec,
    workers: Workers,
    begin: Begin,
) -> BakedLighting:
    """Make lighting maps of surroundings, and write them.

    Parameters
    ----------
    around : Surroundings
        The light.
    output, maps, form, spec
        As of `skybake.ibl.files.write_lighting`.
    workers : Workers
        Threads that do the work.
    begin : callable
        Called with the stage that begins.
    """
    lighting = light(around, maps, workers, begin)
    begin("files")
    files, clamped = write_lighting(lighting, output, maps, form, spec, workers)
    return BakedLighting(
        files=files,
        white_luminance=spec.white_luminance,
        points=len(around.points),
        clamped=clamped,
    )
