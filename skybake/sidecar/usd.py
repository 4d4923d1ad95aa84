"""Maps as lights of USD: a dome with a map as texture, and sun and Moon as distant lights.

All share one unit, the maps' white: the dome's texel of 1 and the sun's intensity
of 1 stand for `DomeAndSun.white_luminance_cd_m2`, in cd/m2 and in lux. USD orients
lat-long textures as OpenEXR does (UsdLuxDomeLight's documentation), and so do our maps,
so that the dome needs no rotation.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from skybake.colour.space import find_colour_space
from skybake.errors import InputError
from skybake.formats.targets import check_target
from skybake.formats.text import is_plain_line
from skybake.projection.chart import Projection
from skybake.sidecar.dome_and_sun import Common, DistantLight, DomeAndSun, check_dome
from skybake.version import __version__

_IS_IN_MAPS = (
    "Not active, because the maps on the dome hold the {}'s disc already. To have it sampled as "
    "a light instead, bake the maps without the disc."
)


def check_usd(path: Path, projection: Projection, files: Iterable[str] = ()) -> None:
    """Raise the errors of a USD file that can be found before anything is computed.

    Parameters
    ----------
    path : Path
        ``.usda``.
    projection : Projection
        Of the maps.
    files : iterable of str, optional
        The maps, as seen from the USD file's folder.

    Raises
    ------
    InputError
        If the suffix is not ``.usda``, if `check_dome` refuses the maps, or if the name of
        one has a character that USD cannot hold.
    OutputError
        If a file cannot be written under that name.
    """
    if path.suffix.lower() != ".usda":
        raise InputError(f"{path}: suffix of a USD file must be .usda, got {path.suffix!r}")
    check_dome(path, "a dome light of USD", projection)
    for file in files:
        _asset(path, file)
    check_target(path)


def usd_layer(path: Path, common: Common, rows: Sequence[DomeAndSun]) -> str:
    """Return a layer of USD with the lights of maps.

    Parameters
    ----------
    path : Path
        ``.usda`` that it is for, in the folder that the maps are seen from.
    common : Common
        What all maps have in common.
    rows : sequence of DomeAndSun
        Ascending frames; the only one may have none.

    Raises
    ------
    InputError
        If USD cannot hold the name of a map.
    """
    lines = [*_layer(common, rows), *_dome(path, common, rows)]
    lines += ["", *_distant(common, rows, "Sun", lambda row: row.sun)]
    if any(row.moon is not None for row in rows):
        lines += ["", *_distant(common, rows, "Moon", _moon_of)]
    lines.append("}")
    return "\n".join(lines) + "\n"


def _layer(common: Common, rows: Sequence[DomeAndSun]) -> Iterator[str]:
    about = (
        f"Sky of {common.preset} by skybake {__version__}. The sun's intensity is its "
        "illuminance over skybake:whiteLuminance, which is the luminance of a texel of 1."
    )
    yield "#usda 1.0"
    yield "("
    yield '    defaultPrim = "World"'
    yield f"    doc = {_quoted(about)}"
    yield from _clock(common, rows)
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


def _clock(common: Common, rows: Sequence[DomeAndSun]) -> Iterator[str]:
    if rows[0].frame is None:
        yield "    metersPerUnit = 1"
        return
    yield f"    endTimeCode = {rows[-1].frame}"
    yield f"    framesPerSecond = {common.fps:.9g}"
    yield "    metersPerUnit = 1"
    yield f"    startTimeCode = {rows[0].frame}"
    yield f"    timeCodesPerSecond = {common.fps:.9g}"


def _dome(path: Path, common: Common, rows: Sequence[DomeAndSun]) -> Iterator[str]:
    space = find_colour_space(common.colorspace).interop_id
    yield '    def DomeLight "Sky"'
    yield "    {"
    yield "        float inputs:intensity = 1"
    yield from _samples(
        "        asset inputs:texture:file",
        rows,
        lambda row: _asset(path, row.file),
        colour_space=space,
    )
    yield '        token inputs:texture:format = "latlong"'
    yield "    }"


def _distant(
    common: Common,
    rows: Sequence[DomeAndSun],
    name: str,
    light: Callable[[DomeAndSun], DistantLight],
) -> Iterator[str]:
    """Define a disc's light, which is off where the maps hold the disc."""
    yield f'    def DistantLight "{name}"'
    if common.sun_is_in_maps:
        yield "    ("
        yield "        active = false"
        yield f"        doc = {_quoted(_IS_IN_MAPS.format(name.lower()))}"
        yield "    )"
    yield "    {"
    yield from _angle(rows, light)
    yield from _samples(
        "        color3f inputs:color",
        rows,
        lambda row: _triple(*_colour_of(light(row))),
        colour_space="lin_rec709_scene",
    )
    yield from _samples(
        "        float inputs:intensity",
        rows,
        lambda row: f"{light(row).illuminance_lux / row.white_luminance_cd_m2:.9g}",
    )
    yield "        bool inputs:normalize = 1"
    steady = _steady_bearings(common, [light(row) for row in rows])
    bearing = dict(zip((row.frame for row in rows), steady, strict=True))
    # The light comes from +Z of its own axes: tilted up, then turned to the bearing.
    yield from _samples(
        "        float3 xformOp:rotateXYZ",
        rows,
        lambda row: _triple(-light(row).elevation_deg, 180.0 - bearing[row.frame], 0.0),
    )
    yield '        uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]'
    yield "    }"


def _angle(
    rows: Sequence[DomeAndSun], light: Callable[[DomeAndSun], DistantLight]
) -> Iterator[str]:
    """Size of a disc, which changes where its distance follows the date."""
    angles = [f"{light(row).angular_diameter_deg:.9g}" for row in rows]
    if len(set(angles)) == 1:
        yield f"        float inputs:angle = {angles[0]}"
    else:
        yield from _samples(
            "        float inputs:angle", rows, lambda row: f"{light(row).angular_diameter_deg:.9g}"
        )


def _moon_of(row: DomeAndSun) -> DistantLight:
    """Return the Moon of a map, or one without light where another map of the rows has it."""
    return row.moon or replace(row.sun, illuminance_lux=0.0)


def _samples(
    declaration: str,
    rows: Sequence[DomeAndSun],
    value: Callable[[DomeAndSun], str],
    colour_space: str | None = None,
) -> Iterator[str]:
    """Declare an attribute by time, or with the one value of a map that does not change."""
    indent = " " * (len(declaration) - len(declaration.lstrip()))
    space = f"{indent}    colorSpace = {_quoted(colour_space)}" if colour_space else ""
    if rows[0].frame is None:
        yield f"{declaration} = {value(rows[0])}" + (" (" if space else "")
    elif space:
        yield f"{declaration} ("
    if space:
        yield space
        yield f"{indent})"
    if rows[0].frame is not None:
        yield f"{declaration}.timeSamples = {{"
        for row in rows:
            yield f"{indent}    {row.frame}: {value(row)},"
        yield f"{indent}}}"


def _colour_of(light: DistantLight) -> tuple[float, float, float]:
    return light.colour if light.illuminance_lux > 0.0 else (1.0, 1.0, 1.0)


def _steady_bearings(common: Common, lights: Sequence[DistantLight]) -> Iterator[float]:
    """Bearings on the maps, without a jump at north that would be interpolated. [deg]"""
    bearing = lights[0].azimuth_deg
    for light in lights:
        bearing += math.remainder(light.azimuth_deg - bearing, 360.0)
        yield bearing - common.rotation_deg


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
