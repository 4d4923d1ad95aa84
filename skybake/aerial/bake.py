"""From the files of a renderer to one with the air in it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from skybake.aerial.air import Air, Depths, air_before
from skybake.aerial.channels import Beauty, Channel, find_beauty, find_depth
from skybake.aerial.compose import Behind, through_air
from skybake.aerial.depth import checked_depths
from skybake.aerial.froxels import air_by_froxels
from skybake.aerial.sight import lens_of
from skybake.errors import InputError
from skybake.formats.exr_layers import ExrPart, read_exr, write_exr
from skybake.formats.targets import check_target
from skybake.formats.whole_files import WholeFiles
from skybake.image.recipe import recipe_hash
from skybake.image.scene import Scene
from skybake.projection.camera import Camera

METHODS = ("march", "froxel")
DEPTH_KINDS = ("planar", "ray")
SKIES = ("none", "fill")


@dataclass(frozen=True, kw_only=True)
class Reading:
    """How the files of a renderer are read.

    Attributes
    ----------
    layer : str or None
        Of the light, see `find_beauty`.
    depth_channel : str or None
        See `find_depth`.
    depth_kind : {"planar", "ray"}
        Whether depths are along the camera's axis or along rays.
    depth_unit : float
        Length of 1 in the depths. [km]
    depth_background : {"inf", "0"} or None
        What depths that are none become, see `checked_depths`.
    """

    layer: str | None = None
    depth_channel: str | None = None
    depth_kind: str = "planar"
    depth_unit: float = 1e-3
    depth_background: str | None = None


@dataclass(frozen=True, kw_only=True)
class Source:
    """What a renderer has written.

    Attributes
    ----------
    path : Path
        File of the light.
    parts : list of ExrPart
        All that it holds.
    beauty : Beauty
        Where the light is.
    depths : Depths
        How far what it shows is.
    """

    path: Path
    parts: list[ExrPart]
    beauty: Beauty
    depths: Depths

    @property
    def part(self) -> ExrPart:
        """The part that holds the light."""
        return self.parts[self.beauty.part]


def read_source(path: Path, depth: Path | None, reading: Reading) -> Source:
    """Read the files of a renderer.

    Parameters
    ----------
    path : Path
        Of the light.
    depth : Path or None
        Of the depth, if it is another.
    reading : Reading
        How.

    Raises
    ------
    InputError
        If a file cannot be read, has no such channels, sizes differ, or a depth is no distance.
    """
    parts = read_exr(path)
    beauty = find_beauty(path, parts, reading.layer)
    where = path if depth is None else depth
    others = parts if depth is None else read_exr(depth)
    channel = find_depth(where, others, reading.depth_channel)
    wide, high = parts[beauty.part].size
    width, height = others[channel.part].size
    if (width, height) != (wide, high):
        raise InputError(
            f"{where}: depth must be as large as {path}, {wide}x{high}, got {width}x{height}"
        )
    return Source(
        path=path, parts=parts, beauty=beauty, depths=_depths(where, others, channel, reading)
    )


def _depths(path: Path, parts: list[ExrPart], channel: Channel, reading: Reading) -> Depths:
    values = parts[channel.part].plane(channel.name)
    unit = reading.depth_unit
    given = path, channel.name, values, unit, reading.depth_background
    return Depths(checked_depths(*given), unit, reading.depth_kind == "planar")


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
            # Where nothing shines, none of it passes.
            shines = light[is_far].any()
            sky = Air(seen.sky, seen.passing() if shines else np.ones_like(light))
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
