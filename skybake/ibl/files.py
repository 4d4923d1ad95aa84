"""Lighting maps in files, all of which appear together."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from skybake.baking.pixel_type import PixelType, fitting_pixel
from skybake.errors import InputError
from skybake.formats.cube_file import write_cube
from skybake.formats.spec import Attribute, MapSpec
from skybake.formats.targets import check_target
from skybake.formats.texels import TEXEL_FORMATS
from skybake.formats.whole_files import WholeFiles
from skybake.formats.writer import open_maps
from skybake.ibl.cube import Cube, in_space
from skybake.ibl.harmonics import filament_text, harmonics_summary
from skybake.ibl.lighting import Lighting
from skybake.ibl.settings import FORMATS, LightingMaps
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.projection.cubemap import SPACES, parse_face_names

_PIXELS = {
    "ktx2": ("auto", *TEXEL_FORMATS),
    "dds": ("auto", "half", "float"),
    "exr": ("auto", "half", "float"),
}
_SH_JSON, _SH_TEXT, _DFG = "sh.json", "sh.txt", "dfg.exr"


@dataclass(frozen=True, kw_only=True)
class FileForm:
    """How lighting maps are stored.

    Attributes
    ----------
    format : str
        One of `skybake.ibl.settings.FORMATS`.
    pixel : {"auto", "half", "float", "rgb9e5", "r11g11b10"}
        Stored type of the cubes; auto takes half where it holds every value.
    space, face_names : str
        As of `skybake.projection.cubemap.Cubemap`; names are of six .exr.
    """

    format: str = "ktx2"
    pixel: str = "auto"
    space: str = "world"
    face_names: str = "px"

    def __post_init__(self) -> None:
        """Refuse what cannot be stored."""
        if self.format not in FORMATS:
            raise InputError(f"format: must be one of {', '.join(FORMATS)}, got {self.format!r}")
        if self.pixel not in _PIXELS[self.format]:
            raise InputError(
                f"pixel: must be one of {', '.join(_PIXELS[self.format])} for the format "
                f"{self.format}, got {self.pixel!r}"
            )
        if self.space not in SPACES:
            raise InputError(f"cube space: must be one of {', '.join(SPACES)}, got {self.space!r}")
        parse_face_names(self.face_names)


def lighting_paths(output: Path, maps: LightingMaps, form: FileForm) -> dict[str, tuple[Path, ...]]:
    """Return the files of each part.

    Parameters
    ----------
    output : Path
        What their names begin with, or a folder that exists.
    maps : LightingMaps
        Which maps.
    form : FileForm
        How they are stored. Cubes are a ``.ktx2`` or ``.dds`` each, or ``.exr`` by cmgen's names:
        ``m0_px.exr`` of the first level of the specular cube, and ``i_px.exr`` of irradiance.

    Raises
    ------
    OutputError
        If one cannot be written.
    """
    names = {
        "specular": (f"specular.{form.format}",),
        "diffuse": (f"diffuse.{form.format}",),
        "sh": (_SH_JSON, _SH_TEXT),
        "dfg": (_DFG,),
    }
    if form.format == "exr":
        faces = parse_face_names(form.face_names)
        names["specular"] = tuple(
            f"m{mip}_{face}.exr" for mip in range(maps.mips) for face in faces
        )
        names["diffuse"] = tuple(f"i_{face}.exr" for face in faces)
    paths = {part: tuple(_named(output, name) for name in names[part]) for part in maps.parts}
    for path in (path for each in paths.values() for path in each):
        check_target(path)
    return paths


def _named(output: Path, name: str) -> Path:
    return output / name if output.is_dir() else output.with_name(f"{output.name}_{name}")


def write_lighting(
    lighting: Lighting,
    output: Path,
    maps: LightingMaps,
    form: FileForm,
    spec: MapSpec,
    workers: Workers = ALL_CPUS,
) -> tuple[tuple[Path, ...], int]:
    """Write lighting maps.

    Parameters
    ----------
    lighting : Lighting
        The maps.
    output, maps, form
        As of `lighting_paths`.
    spec : MapSpec
        What the files state besides their pixels; its size and type are not used.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    tuple of Path
        The files.
    int
        Negative values that became 0 in a type that has no sign.

    Raises
    ------
    OutputError
        If a file cannot be written, or a value does not fit its type; no file is left then.
    """
    paths = lighting_paths(output, maps, form)
    clamped = 0
    with WholeFiles() as files:
        if lighting.specular is not None:
            shares = tuple(maps.roughness(mip) for mip in range(maps.mips))
            stated = _stating(spec, "specular", {"skybake:roughness": shares})
            clamped += _write_cube(
                paths["specular"], lighting.specular, form, stated, files, workers
            )
        if lighting.diffuse is not None:
            stated = _stating(spec, "irradiance / pi", {})
            clamped += _write_cube(
                paths["diffuse"], [lighting.diffuse], form, stated, files, workers
            )
        if lighting.harmonics is not None:
            summary, text = paths["sh"]
            known = {"white_luminance_cd_m2": spec.white_luminance}
            content = {**harmonics_summary(lighting.harmonics), **known}
            files.add(summary).write_text(json.dumps(content, indent=1) + "\n")
            files.add(text).write_text(filament_text(lighting.harmonics))
        if lighting.dfg is not None:
            _write_dfg(paths["dfg"][0], lighting.dfg, maps, spec, files)
    return tuple(path for each in paths.values() for path in each), clamped


def _stating(spec: MapSpec, content: str, more: Mapping[str, Attribute]) -> MapSpec:
    return replace(spec, attributes={**spec.attributes, "skybake:lightingMap": content, **more})


def _write_cube(
    paths: tuple[Path, ...],
    levels: list[Cube],
    form: FileForm,
    spec: MapSpec,
    files: WholeFiles,
    workers: Workers,
) -> int:
    levels = [in_space(level, form.space) for level in levels]
    spec = replace(spec, pixel=_pixel(form, levels))
    if form.format != "exr":
        return write_cube(paths[0], levels, spec, files, workers)
    faces = [face for level in levels for face in level]
    with ExitStack() as stack:
        specs = {
            path: replace(spec, width=len(face), height=len(face))
            for path, face in zip(paths, faces, strict=True)
        }
        writers = stack.enter_context(open_maps(specs, files))
        for path, face in zip(paths, faces, strict=True):
            writers[path].write_rows(0, len(face), face)
    return 0


def _pixel(form: FileForm, levels: list[Cube]) -> PixelType:
    largest = max(float(np.abs(level).max()) for level in levels)
    peaks = [np.abs(level).max(axis=-1) for level in levels]
    lit = [values[values > 0.0] for values in peaks]
    smallest = min((float(values.min()) for values in lit if values.size), default=1.0)
    return fitting_pixel(form.pixel, largest, smallest)


def _write_dfg(
    path: Path, table: np.ndarray, maps: LightingMaps, spec: MapSpec, files: WholeFiles
) -> None:
    channels = ("bias", "scale + bias") if maps.dfg_multiscatter else ("scale", "bias")
    first = "1 in the first row" if maps.dfg_upward else "0 in the first row"
    attributes: dict[str, Attribute] = {
        "skybake:lightingMap": "split sum",
        "skybake:red": channels[0],
        "skybake:green": channels[1],
        "skybake:rows": f"perceptual roughness, {first}",
        "skybake:columns": "cosine of the view's angle from the normal",
    }
    edge = len(table)
    stored = MapSpec(edge, edge, spec.colour_space, 1.0, channels=("R", "G"), attributes=attributes)
    with open_maps({path: stored}, files) as writers:
        writers[path].write_rows(0, edge, np.ascontiguousarray(table))
