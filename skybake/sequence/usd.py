"""A sequence as lights of USD: a dome with the maps as texture, and the sun as a distant light.

Both share one unit, the maps' white: the dome's texel of 1 and the sun's intensity
of 1 stand for `FrameRecord.white_luminance_cd_m2`, in cd/m2 and in lux. USD orients
lat-long textures as OpenEXR does (UsdLuxDomeLight's documentation), and so do our maps,
so that the dome needs no rotation.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from skybake.colour.space import find_colour_space
from skybake.errors import InputError
from skybake.formats.targets import check_target
from skybake.formats.whole_files import replace_when_whole
from skybake.projection import PROJECTIONS
from skybake.sequence.manifest import FrameRecord, SequenceHeader, ascending
from skybake.sequence.text import is_plain_line

_SUN_IS_IN_MAPS = (
    "Not active, because the maps on the dome hold the sun's disc already. To have it sampled as "
    "a light instead, bake the maps without the disc."
)


def check_usd(path: Path, projection: str, files: Iterable[str] = ()) -> None:
    """Raise the errors of a USD file that can be found before anything is computed.

    Parameters
    ----------
    path : Path
        ``.usda``.
    projection : str
        Of the maps, a key of `skybake.projection.PROJECTIONS`.
    files : iterable of str, optional
        The maps, as seen from the USD file's folder.

    Raises
    ------
    InputError
        If the suffix is not ``.usda``, if the maps are not equirect, which is the only
        kind that every dome light supports, or if the name of one has a character
        that USD cannot hold.
    OutputError
        If a file cannot be written under that name.
    """
    if path.suffix.lower() != ".usda":
        raise InputError(f"{path}: suffix of a USD file must be .usda, got {path.suffix!r}")
    if not PROJECTIONS[projection].lights_a_dome:
        raise InputError(
            f"{path}: a dome light of USD needs maps of the projection equirect, got {projection}"
        )
    for file in files:
        _asset(path, file)
    check_target(path)


def write_usd(path: Path, header: SequenceHeader, records: Iterable[FrameRecord]) -> None:
    """Write a sequence as USD's lights with time samples.

    Parameters
    ----------
    path : Path
        ``.usda``, in the folder that the records' files are seen from.
    header : SequenceHeader
        What all frames have in common.
    records : iterable of FrameRecord
        At least one, in any order.

    Raises
    ------
    InputError
        As `check_usd`.
    OutputError
        If the file cannot be written.
    """
    rows = ascending(records)
    check_usd(path, header.projection, (row.files[0] for row in rows))
    lines = [*_layer(header, rows), *_dome(path, header, rows), "", *_sun(header, rows), "}"]
    with replace_when_whole(path) as temporary:
        temporary.write_text("\n".join(lines) + "\n", "utf-8")


def _layer(header: SequenceHeader, rows: Sequence[FrameRecord]) -> Iterator[str]:
    about = (
        f"Sky of {header.preset} by skybake {header.skybake}. The sun's intensity is its "
        "illuminance over skybake:whiteLuminance, which is the luminance of a texel of 1."
    )
    yield "#usda 1.0"
    yield "("
    yield '    defaultPrim = "World"'
    yield f"    doc = {_quoted(about)}"
    yield f"    endTimeCode = {rows[-1].frame}"
    yield f"    framesPerSecond = {header.fps:.9g}"
    yield "    metersPerUnit = 1"
    yield f"    startTimeCode = {rows[0].frame}"
    yield f"    timeCodesPerSecond = {header.fps:.9g}"
    yield '    upAxis = "Y"'
    yield ")"
    yield ""
    yield 'def Xform "World"'
    yield "{"
    yield from _samples(
        "    custom float skybake:whiteLuminance",
        rows,
        lambda row: f"{row.white_luminance_cd_m2:.9g}",
    )
    yield ""


def _dome(path: Path, header: SequenceHeader, rows: Sequence[FrameRecord]) -> Iterator[str]:
    space = find_colour_space(header.colorspace).interop_id
    yield '    def DomeLight "Sky"'
    yield "    {"
    yield "        float inputs:intensity = 1"
    yield "        asset inputs:texture:file ("
    yield f"            colorSpace = {_quoted(space)}"
    yield "        )"
    yield from _samples(
        "        asset inputs:texture:file", rows, lambda row: _asset(path, row.files[0])
    )
    yield '        token inputs:texture:format = "latlong"'
    yield "    }"


def _sun(header: SequenceHeader, rows: Sequence[FrameRecord]) -> Iterator[str]:
    yield '    def DistantLight "Sun"'
    if header.sun_disc not in {"exclude", "separate"}:
        yield "    ("
        yield "        active = false"
        yield f"        doc = {_quoted(_SUN_IS_IN_MAPS)}"
        yield "    )"
    yield "    {"
    yield from _angle(rows)
    yield "        color3f inputs:color ("
    yield '            colorSpace = "lin_rec709_scene"'
    yield "        )"
    yield from _samples(
        "        color3f inputs:color", rows, lambda row: _triple(*_colour_of_light(row))
    )
    yield from _samples(
        "        float inputs:intensity",
        rows,
        lambda row: f"{row.sun_illuminance_lux / row.white_luminance_cd_m2:.9g}",
    )
    yield "        bool inputs:normalize = 1"
    bearing = dict(zip((row.frame for row in rows), _steady_bearings(header, rows), strict=True))
    # The light comes from +Z of its own axes: tilted up, then turned to the bearing.
    yield from _samples(
        "        float3 xformOp:rotateXYZ",
        rows,
        lambda row: _triple(-row.sun_elevation_deg, 180.0 - bearing[row.frame], 0.0),
    )
    yield '        uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]'
    yield "    }"


def _angle(rows: Sequence[FrameRecord]) -> Iterator[str]:
    """Size of the sun's disc, which changes where its distance follows the date."""
    angles = [f"{row.sun_angular_diameter_deg:.9g}" for row in rows]
    if len(set(angles)) == 1:
        yield f"        float inputs:angle = {angles[0]}"
    else:
        yield from _samples(
            "        float inputs:angle", rows, lambda row: f"{row.sun_angular_diameter_deg:.9g}"
        )


def _samples(
    declaration: str, rows: Sequence[FrameRecord], value: Callable[[FrameRecord], str]
) -> Iterator[str]:
    indent = " " * (len(declaration) - len(declaration.lstrip()))
    yield f"{declaration}.timeSamples = {{"
    for row in rows:
        yield f"{indent}    {row.frame}: {value(row)},"
    yield f"{indent}}}"


def _colour_of_light(row: FrameRecord) -> tuple[float, float, float]:
    return row.sun_colour if row.sun_illuminance_lux > 0.0 else (1.0, 1.0, 1.0)


def _steady_bearings(header: SequenceHeader, rows: Sequence[FrameRecord]) -> Iterator[float]:
    """Bearings of the sun on the maps, without a jump at north that would be interpolated. [deg]"""
    rotation = header.recipe.get("map", {}).get("rotate_deg", 0.0)
    bearing = rows[0].sun_azimuth_deg
    for row in rows:
        bearing += math.remainder(row.sun_azimuth_deg - bearing, 360.0)
        yield bearing - rotation


def _triple(x: float, y: float, z: float) -> str:
    return f"({x:.9g}, {y:.9g}, {z:.9g})"


def _asset(path: Path, file: str) -> str:
    """Write a path so that USD searches for it beside the layer only."""
    if not is_plain_line(file) or "@@@" in file:
        raise InputError(f"{path}: USD must be able to hold a file's name, got {file!r}")
    anchored = file if Path(file).is_absolute() else f"./{file}"
    fence = "@@@" if "@" in file else "@"
    return f"{fence}{anchored}{fence}"


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
