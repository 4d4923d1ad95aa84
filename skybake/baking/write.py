"""Bakes a map into files: band after band, each computed while the last is written."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from skybake.baking.checks import check_targets
from skybake.baking.losses import HalfLoss, scene_warnings
from skybake.baking.paths import default_path, map_paths
from skybake.baking.pictures import kept_picture, open_pictures, write_pictures
from skybake.baking.pixel_type import PixelType, fitting_pixel, value_range
from skybake.formats.spec import Attribute, MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.image.light import (
    Light,
    attributes_from_light,
    eclipse_attributes,
    light_of_scene,
    moon_attributes,
    night_attributes,
)
from skybake.image.parts import part_names
from skybake.image.picture_settings import PictureSettings
from skybake.image.raster import Raster
from skybake.image.recipe import recipe_attributes
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings
from skybake.preset import Planet, load_preset
from skybake.projection.chart import Canvas
from skybake.sidecar.map_light import MapLight, map_light

if TYPE_CHECKING:
    from skybake.baking.bands import Bands

FROM_BELOW = ("skybake:illuminanceFromBelow", "skybake:groundIlluminanceFromBelow")
"""Attributes of maps that do not show the ground. [lx]"""

Progress = Callable[[float], None]


@dataclass(frozen=True, kw_only=True)
class Baked(Light):
    """What was baked, besides its `Light`.

    Attributes
    ----------
    files : tuple of Path
        The map, one file or six.
    white_luminance : float
        Luminance that a pixel value of 1 stands for. [cd m⁻²]
    pixel : str
        Type of the stored values.
    preview : Path or None
        The display-referred picture.
    preview_ev : float or None
        Exposure value of the picture.
    preview_white : tuple of float or None
        CIE xy of the light that is white in it; None for D65.
    clamped : int
        Negative values that became 0 in a format without a sign.
    from_below : tuple of 2 float, or None
        Illuminance of a plane that looks down by what the map shows below the horizon instead of
        the ground, and by the ground; None of a map that shows it. [lx]
    warnings : tuple of str
        What the files lose of the light, or why it may not be what was meant, a line each.
    map_light : MapLight or None
        All about the light that a renderer needs, if it was asked for.
    light_files : tuple of Path
        The files that tell it.
    eclipse : mapping of str to Attribute
        What files state of an eclipse; empty without one.
    moonlight : mapping of str to Attribute
        What files state of the Moon as a light; empty without it.
    night : mapping of str to Attribute
        What files state of the lights of the night; empty by day.
    """

    files: tuple[Path, ...]
    white_luminance: float
    pixel: str
    preview: Path | None
    preview_ev: float | None
    preview_white: tuple[float, float] | None
    clamped: int
    from_below: tuple[float, float] | None = None
    warnings: tuple[str, ...] = ()
    map_light: MapLight | None = None
    light_files: tuple[Path, ...] = ()
    eclipse: Mapping[str, Attribute] = field(default_factory=dict)
    moonlight: Mapping[str, Attribute] = field(default_factory=dict)
    night: Mapping[str, Attribute] = field(default_factory=dict)


def bake(
    preset: Planet | str | Path = "earth",
    output: Path | str | None = None,
    settings: MapSettings | None = None,
    *,
    preview: Path | str | None = None,
    picture: PictureSettings | None = None,
    attributes: Mapping[str, Attribute] | None = None,
    lights: Sequence[Path | str] | None = None,
    progress: Progress | None = None,
    stage: Callable[[str], None] | None = None,
    notice: Callable[[str], None] | None = None,
) -> Baked:
    """Bake one sky map.

    Parameters
    ----------
    preset : Planet, str or Path
        A loaded planet, a preset's name, or the path of a preset's file.
    output : Path or str, optional
        ``.exr`` or ``.hdr``, of a cubemap also ``.ktx2`` or ``.dds``, which hold all faces;
        default a name that describes it, in the current folder. Six files replace ``{face}`` in
        it, or add ``_px`` and so on.
    settings : MapSettings, optional
        Sun, observer, map, colour and pixels.
    preview : Path or str, optional
        Also write a display-referred PNG here.
    picture : PictureSettings, optional
        How it shows the map.
    attributes : mapping of str to Attribute, optional
        What the files shall state besides their light and their recipe, such as
        ``{"skybake:time": "2026-06-21T04:00:00Z"}``.
    lights : sequence of Path or str, optional
        Also write sky and sun as lights of other programs: ``.json``, ``.usda``, or ``.py`` for
        Blender. The sun shines there only if the map leaves its disc out. Without a name in it
        only `Baked.map_light` is set.
    progress : callable, optional
        Called with the share of the pixels that is done, from 0 to 1.
    stage : callable, optional
        Called with the stage that begins: "clouds" of a world that has them, "pixels".
    notice : callable, optional
        Called with a human-readable line when something takes long that later runs need not repeat.

    Returns
    -------
    Baked
        The files and what light they hold.

    Raises
    ------
    SkybakeError
        If the preset, a setting or the target cannot be used; no file is left then.
    """
    settings = settings or MapSettings()
    planet = preset if isinstance(preset, Planet) else load_preset(preset)
    output = Path(output) if output else default_path(planet, settings)
    preview = None if preview is None else Path(preview)
    light_files = None if lights is None else list(dict.fromkeys(map(Path, lights)))
    check_targets(output, settings, preview, light_files or ())
    scene = Scene(planet, settings)
    if notice is not None and not scene.sky.is_solved:
        notice("solving for the light in this atmosphere, once")
    return bake_scene(
        scene,
        output,
        preview=preview,
        picture=picture,
        attributes=attributes,
        light_files=light_files,
        progress=progress,
        stage=stage,
    )


def bake_scene(
    scene: Scene,
    output: Path,
    *,
    preview: Path | None = None,
    picture: PictureSettings | None = None,
    attributes: Mapping[str, Attribute] | None = None,
    light_files: Sequence[Path] | None = None,
    progress: Progress | None = None,
    stage: Callable[[str], None] | None = None,
    files: WholeFiles | None = None,
    pixel: PixelType | None = None,
) -> Baked:
    """Bake the map of a scene.

    Parameters and errors are those of `bake`, besides other files of the same set, and what
    `auto` shall stand for, see `pixel_type`.
    """
    planet, settings = scene.planet, scene.settings
    paths = map_paths(output, settings)
    begin = stage or _ignore
    bands = _bands(scene, None if preview is None else picture)
    _ = scene.sun  # which can be refused, before what takes long
    if planet.clouds:
        begin("clouds")
        scene.light_clouds()
    begin("pixels")
    light = light_of_scene(scene)
    eclipse, moonlight = eclipse_attributes(scene), moon_attributes(scene)
    from_below, night = _from_below(scene), night_attributes(scene)
    described = None if light_files is None else map_light(scene, light)
    attributes = {
        **attributes_from_light(light),
        **({} if from_below is None else dict(zip(FROM_BELOW, from_below, strict=True))),
        **night,
        **moonlight,
        **eclipse,
        **recipe_attributes(planet, settings),
        **(attributes or {}),
    }
    encoding = settings.encoding
    canvases = settings.view.projection.canvases()
    shows, rasters = _rasters(scene, bands, canvases)
    peak = max(raster.peak for raster in rasters)
    largest, smallest = bands.value_range(peak) if bands else value_range(scene, peak)
    warnings = scene_warnings(scene, peak) + (bands.warnings() if bands else [])
    stored = fitting_pixel(encoding.pixel, largest, smallest) if pixel is None else pixel
    spec = partial(_spec, settings=settings, stored=stored, attributes=attributes, bands=bands)
    with ExitStack() as stack:
        if files is None:
            files = stack.enter_context(WholeFiles())
        shown = None
        if preview is not None:
            from skybake.baking.picture import open_picture

            look = picture or PictureSettings()
            shown = open_picture(scene, preview, look, files, stack)
        is_radiance = paths[0].suffix.lower() == ".hdr"
        with open_pictures(shows, rasters, paths, spec, files) as pictures:
            loss, kept = None, None
            if shown is not None and shown.projection == settings.view.projection:
                is_whole = part_names(shows)[0] == "beauty" and settings.sensor.response is None
                if is_whole and len(pictures) == 1:
                    pictures[0], kept = kept_picture(pictures[0], canvases[0].width)
            if is_radiance or (encoding.pixel == stored and stored != "float"):
                loss = HalfLoss("half" if is_radiance else stored)
            write_pictures(pictures, scene.workers, progress, loss)
            if loss is not None:
                lost = loss.warning(paths[0])
                warnings += [] if lost is None else [lost]
            if shown is not None:
                shown.draw(kept)
        if light_files and described is not None:
            _write_lights(light_files, described, paths, files, attributes)
    return Baked(
        **vars(light),
        files=paths,
        white_luminance=encoding.white_luminance,
        pixel="rgbe" if is_radiance else stored,
        preview=preview,
        preview_ev=None if shown is None else shown.ev,
        preview_white=None if shown is None else shown.white,
        clamped=sum(each.writer.clamped for each in pictures),
        from_below=from_below,
        warnings=tuple(warnings),
        map_light=described,
        light_files=tuple(light_files or ()),
        eclipse=eclipse,
        moonlight=moonlight,
        night=night,
    )


def _write_lights(
    light_files: Sequence[Path],
    described: MapLight,
    paths: Sequence[Path],
    files: WholeFiles,
    attributes: Mapping[str, Attribute],
) -> None:
    from skybake.sidecar.light_file import write_light_files

    time = attributes.get("skybake:time")
    write_light_files(light_files, described, paths, files, time=time)


def _bands(scene: Scene, picture: PictureSettings | None) -> Bands | None:
    """Return what the map holds besides what an eye sees, or instead; None if nothing.

    Raises
    ------
    InputError
        If the map, or its picture, needs what the world has not.
    """
    if picture is not None and picture.show != "light":
        from skybake.image.polarised import check_polarisation

        check_polarisation(scene.settings, "show")
    if scene.settings.sensor.is_eye:
        return None
    from skybake.baking.bands import bands_of

    return bands_of(scene)


def _rasters(
    scene: Scene, bands: Bands | None, canvases: Sequence[Canvas]
) -> tuple[Scene, list[Raster]]:
    """Return the scene in the map's R, G and B, and its pictures."""
    if bands is not None:
        return bands.scene, bands.rasters(canvases)
    return scene, [Raster(scene, canvas) for canvas in canvases]


def _spec(
    raster: Raster,
    *,
    settings: MapSettings,
    stored: PixelType,
    attributes: Mapping[str, Attribute],
    bands: Bands | None,
) -> MapSpec:
    encoding = settings.encoding
    spec = MapSpec(
        raster.canvas.width,
        raster.canvas.height,
        encoding.space,
        encoding.white_luminance,
        pixel=stored,
        compression=encoding.compression,
        envmap=raster.canvas.envmap,
        states_exposure=not encoding.omit_exposure,
        attributes=attributes,
    )
    return spec if bands is None else bands.spec(spec)


def _from_below(scene: Scene) -> tuple[float, float] | None:
    if scene.settings.view.below_horizon == "ground":
        return None
    from skybake.image.below_horizon import light_from_below

    return light_from_below(scene)


def _ignore(_: str) -> None:
    pass
