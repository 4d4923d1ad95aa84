"""Maps of any program in other layouts, sizes, spaces, scales and formats."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from skybake.baking.converted_tags import converted_attributes
from skybake.baking.held_pictures import write_whole
from skybake.baking.losses import HalfLoss
from skybake.baking.mips import check_mips
from skybake.baking.paths import projection_paths
from skybake.baking.pixel_type import fitting_pixel
from skybake.colour.space import ColourSpace, find_colour_space, luminance_weights, rgb_from_xyz
from skybake.environment.environment import Environment
from skybake.environment.load import load_environment
from skybake.environment.resample import resample
from skybake.errors import InputError
from skybake.formats.compression import parse_compression
from skybake.formats.cube_file import check_cube_encoding, is_cube_file
from skybake.formats.spec import MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.formats.writer import check_map_path, open_maps
from skybake.image.settings import PIXELS
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.projection.chart import Projection

BAND_ROWS = 128

UNTAGGED = "lin_rec709"
"""Space of pixels without a tag, as the OpenEXR standard has it."""


@dataclass(frozen=True, kw_only=True)
class Converted:
    """What was written.

    Attributes
    ----------
    files : tuple of Path
        One file or six.
    projection : Projection
        Where its pixels look.
    rotation : float
        Compass bearing that its -Z looks to. [rad]
    colorspace : str
        Name of the space of the pixels.
    white_luminance : float or None
        Luminance that RGB (1, 1, 1) stands for, if it is known. [cd m⁻²]
    pixel : str
        Type of the stored values.
    clamped : int
        Negative values that became 0 in a format without a sign.
    warnings : tuple of str
        What to know of the map that was read, or what the files lose of it, a line each.
    """

    files: tuple[Path, ...]
    projection: Projection
    rotation: float
    colorspace: str
    white_luminance: float | None
    pixel: str
    clamped: int
    warnings: tuple[str, ...]


def convert(
    source: Environment | Path | str,
    output: Path | str,
    projection: Projection | None = None,
    *,
    rotation: float | None = None,
    colorspace: str | None = None,
    white_luminance: float | None = None,
    pixel: str = "auto",
    compression: str = "zip",
    clamp_negative: bool = False,
    omit_exposure: bool = False,
    mips: bool = False,
    workers: Workers = ALL_CPUS,
) -> Converted:
    """Write a map anew; what is not given stays as it is.

    Parameters
    ----------
    source : Environment, Path or str
        A map that is read, see `skybake.environment.load.load_environment`, or its file.
    output : Path or str
        ``.exr`` or ``.hdr``, of a cubemap also ``.ktx2`` or ``.dds``, which hold all faces; six
        files replace ``{face}`` in it, or add ``_px`` and so on.
    projection : Projection, optional
        Where the new pixels look.
    rotation : float, optional
        Compass bearing that the new map's -Z looks to. Pictures that look to a bearing of their
        own have none. [rad]
    colorspace : str, optional
        A name of `skybake.colour.space.COLOUR_SPACES`. Pixels without a tag are in Rec. 709.
    white_luminance : float, optional
        Luminance that RGB (1, 1, 1) stands for in the new map. [cd m⁻²]
    pixel, compression, clamp_negative, omit_exposure, mips : optional
        As of `skybake.image.settings.Encoding`.
    workers : Workers, optional
        Threads that do the work.

    Raises
    ------
    SkybakeError
        If the map cannot be read, a value cannot be used or the target cannot be written; no
        file is left then.
    """
    output = Path(output)
    check_map_path(output)
    _ = parse_compression(compression)
    if pixel not in PIXELS:
        raise InputError(f"pixel: must be one of {', '.join(PIXELS)}, got {pixel!r}")
    if is_cube_file(output):
        check_cube_encoding(output, pixel, compression)
    elif pixel in ("rgb9e5", "r11g11b10"):
        raise InputError(f"{output}: pixel {pixel} must be in .ktx2")
    wanted_space = None if colorspace is None else find_colour_space(colorspace)
    before = source if isinstance(source, Environment) else load_environment(source)
    paths = projection_paths(output, projection or before.projection)
    for path in paths:
        check_map_path(path)
    if mips:
        check_mips(output, projection or before.projection)
    after = _laid_out(before, projection, rotation, workers)
    space = wanted_space or before.space or find_colour_space(UNTAGGED)
    after = _encoded(after, space, white_luminance, clamp_negative=clamp_negative)
    stored = fitting_pixel(pixel, *_range(after, space))
    is_radiance = output.suffix.lower() == ".hdr"
    encoding = {
        "colorspace": space.name,
        "white_luminance_cd_m2": after.white_luminance,
        "pixel": pixel,
        "compression": compression,
        **({"mips": True} if mips else {}),
    }
    attributes = converted_attributes(before, after, encoding)
    specs = [
        MapSpec(
            canvas.width,
            canvas.height,
            space,
            after.white_luminance,
            pixel=stored,
            compression=compression,
            envmap=canvas.envmap,
            states_exposure=not omit_exposure,
            attributes=attributes,
        )
        for canvas in after.projection.canvases()
    ]
    lossy = "half" if is_radiance else pixel
    loss = None if lossy in {"auto", "float"} else HalfLoss(lossy)
    with WholeFiles() as files:
        if loss is not None:
            for picture in after.pixels:
                loss.add(picture)
        lost = None if loss is None else loss.warning(paths[0])
        clamped = _write(after, paths, specs, files, workers, mips=mips)
    return Converted(
        files=paths,
        projection=after.projection,
        rotation=after.rotation,
        colorspace=space.name,
        white_luminance=after.white_luminance,
        pixel="rgbe" if is_radiance else stored,
        clamped=clamped,
        warnings=after.warnings if lost is None else (*after.warnings, lost),
    )


def _laid_out(
    before: Environment,
    projection: Projection | None,
    rotation: float | None,
    workers: Workers,
) -> Environment:
    wanted = before.projection if projection is None else projection
    has_look = hasattr(wanted, "azimuth")
    if has_look and rotation is not None:
        raise InputError(
            f"rotation: must not be given for the projection {wanted.name}, which looks to a "
            "bearing of its own"
        )
    if rotation is None:
        rotation = 0.0 if has_look and projection is not None else before.rotation
    if wanted == before.projection and rotation == before.rotation:
        return before
    return resample(before, wanted, rotation, workers)


def _encoded(
    environment: Environment,
    space: ColourSpace,
    white_luminance: float | None,
    *,
    clamp_negative: bool,
) -> Environment:
    """Return a map in a space and a scale."""
    white = environment.white_luminance
    gain = 1.0
    if white_luminance is not None:
        if white is None:
            raise InputError(
                "white luminance: must be known of the map that is read, to be changed, got none"
            )
        gain, white = white / white_luminance, white_luminance
    own = environment.space or find_colour_space(UNTAGGED)
    pixels = environment.pixels
    if gain != 1.0 or own != space:
        matrix = gain * rgb_from_xyz(space) @ np.linalg.inv(rgb_from_xyz(own))
        factors = np.asarray(matrix.T if own != space else gain * np.eye(3), np.float32)
        pixels = tuple(picture @ factors for picture in pixels)
    if clamp_negative:
        pixels = tuple(np.maximum(picture, np.float32(0.0)) for picture in pixels)
    return replace(environment, pixels=pixels, space=space, white_luminance=white)


def _range(environment: Environment, space: ColourSpace) -> tuple[float, float]:
    """Return the largest magnitude, and the least luminance where there is any."""
    weights = luminance_weights(space).astype(np.float32)
    largest, least = 0.0, np.inf
    for picture in environment.pixels:
        largest = max(largest, float(np.abs(picture).max()))
        luminance = picture @ weights
        least = min(least, float(luminance.min(initial=np.inf, where=luminance > 0.0)))
    return largest, least


def _write(
    environment: Environment,
    paths: tuple[Path, ...],
    specs: list[MapSpec],
    files: WholeFiles,
    workers: Workers,
    *,
    mips: bool,
) -> int:
    """Write the files, and return how many negative values became 0."""
    pictures, projection = environment.pixels, environment.projection
    if mips or is_cube_file(paths[0]):
        return write_whole(pictures, projection, paths, specs, files, workers, mips=mips)
    with open_maps(dict(zip(paths, specs, strict=True)), files) as writers:
        for picture, writer in zip(pictures, writers.values(), strict=True):
            for first in range(0, len(picture), BAND_ROWS):
                rows = picture[first : first + BAND_ROWS]
                writer.write_ready(first, first + len(rows), writer.ready(rows, workers))
    return sum(writer.clamped for writer in writers.values())
