"""From the files of a renderer to one with the air in it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from skybake.aerial.air import Air, air_before
from skybake.aerial.compose import Behind, through_air
from skybake.aerial.froxels import air_by_froxels
from skybake.aerial.sight import lens_of
from skybake.aerial.source import Source
from skybake.aerial.to_space import dim_beyond
from skybake.errors import InputError
from skybake.formats.exr_layers import write_exr
from skybake.formats.targets import check_target
from skybake.formats.whole_files import WholeFiles
from skybake.image.recipe import recipe_hash
from skybake.image.scene import Scene
from skybake.projection.camera import Camera

METHODS = ("march", "froxel")
SKIES = ("none", "fill")


def bake_aerial(
    scene: Scene,
    source: Source,
    camera: Camera,
    output: Path,
    *,
    method: str = "march",
    fills_sky: bool = False,
) -> int:
    """Put the air into a picture and write it with all else that its file holds.

    Parameters
    ----------
    scene : Scene
        The air, the sun, and the scale and the space of the picture's values. The observer is
        where the camera is.
    source : Source
        The picture.
    camera : Camera
        What took it.
    output : Path
        ``.exr``.
    method : {"march", "froxel"}, optional
        Look each pixel up among directions and distances, or among froxels of the frustum.
    fills_sky : bool, optional
        Put the sky behind what covers less than a whole pixel.

    Returns
    -------
    int
        Values that were too large for half floats.

    Raises
    ------
    InputError
        If the light is not finite.
    OutputError
        If the file cannot be written.
    """
    check_target(output)
    part, beauty = source.part, source.beauty
    light = np.stack([part.plane(name) for name in beauty.colours], axis=-1)
    _check_finite(source, light)
    alpha = None if beauty.alpha is None else part.plane(beauty.alpha)
    column, row, full_width, full_height = part.window
    lens = lens_of(camera, (full_width, full_height), (column, row))
    air: Air = (air_by_froxels if method == "froxel" else air_before)(scene, lens, source.depths)
    if scene.cloudscape is not None:
        from skybake.aerial.clouded import with_clouds

        air = with_clouds(scene, scene.cloudscape, lens, source.depths, air)
    is_far = np.isinf(source.depths.values)
    is_thin = np.zeros_like(is_far) if alpha is None or not fills_sky else alpha < 1.0
    rows = np.flatnonzero((is_far | is_thin).any(axis=1))
    sky = behind = None
    if rows.size:
        between = int(rows[0]), int(rows[-1]) + 1
        seen = Behind(scene, camera, part.size, part.window, between)
        if is_far.any():
            sky = seen.sky
            # Where nothing shines, none of it passes.
            if light[is_far].any():
                dim_beyond(scene, lens, source.depths, air)
                if scene.cloudscape is not None:
                    air.passing[is_far] *= 1.0 - seen.hidden()[is_far, None]
        if is_thin.any():
            behind = seen.whole_sky()
    out = through_air(light, alpha, air, source.depths, sky, behind, scene.workers)
    pixels = part.pixels.copy()
    changed = [part.channels.index(name) for name in beauty.colours]
    with np.errstate(over="ignore"):
        pixels = pixels if pixels.dtype != np.float16 else pixels.astype(np.float32)
        pixels[..., changed] = out
        if fills_sky and beauty.alpha is not None:
            pixels[..., part.channels.index(beauty.alpha)] = 1.0
    parts = list(source.parts)
    parts[beauty.part] = part._replace(pixels=pixels)
    with WholeFiles() as files:
        return write_exr(output, files.add(output), parts, _attributes(scene, method, fills_sky))


def _attributes(scene: Scene, method: str, fills_sky: bool) -> dict[str, Any]:
    told = {
        "preset": scene.planet.name,
        "recipe": recipe_hash(scene.planet, scene.settings),
        "method": method,
        "sky": "fill" if fills_sky else "none",
    }
    return {"skybake:aerial": json.dumps(told)}


def _check_finite(source: Source, light: np.ndarray) -> None:
    is_finite = np.isfinite(light)
    if not is_finite.all():
        row, column, channel = np.argwhere(~is_finite)[0].tolist()
        raise InputError(
            f"{source.path}: {source.beauty.colours[channel]}: must be finite, got "
            f"{light[row, column, channel]} at column {column}, row {row}"
        )
