"""Checks of maps in files, of this program and of others."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from skybake.errors import InputError
from skybake.formats.raw_parts import RawPart, read_parts
from skybake.formats.spec import POLARIZER
from skybake.inspect.check_edges import edge_findings
from skybake.inspect.check_light import light_findings
from skybake.inspect.check_tags import part_space, tag_findings
from skybake.inspect.check_values import value_findings
from skybake.inspect.finding import Finding
from skybake.inspect.seen import Seen, seen_in
from skybake.projection.cubemap import FaceChart
from skybake.projection.of_file import file_recipe

_SUFFIXES = (".exr", ".hdr")
_FACES = 6


@dataclass(frozen=True)
class Checked:
    """A file, or the six of a cubemap, that was checked.

    Attributes
    ----------
    files : tuple of Path
        One, or the six faces.
    findings : tuple of Finding
        What was found, faults or not.
    """

    files: tuple[Path, ...]
    findings: tuple[Finding, ...]

    @property
    def is_wrong(self) -> bool:
        """Whether one of the findings is a fault."""
        return any(one.is_wrong for one in self.findings)


@dataclass(frozen=True)
class _Face:
    path: Path
    part: RawPart
    seen: Seen


def check_files(paths: Iterable[Path]) -> list[Checked]:
    """Check maps.

    Parameters
    ----------
    paths : iterable of Path
        OpenEXR files or Radiance pictures. Six faces of a cubemap of this program are checked
        together as well.

    Returns
    -------
    list of Checked
        One for each file, in the same order, then one for each cubemap. What cannot be read is a
        fault of its file.
    """
    found: list[Checked] = []
    faces: dict[tuple[Path, str], list[_Face]] = {}
    for path in paths:
        try:
            parts = _parts(path)
        except InputError as error:
            text = str(error).removeprefix(f"{path}: ")
            found.append(Checked((path,), (Finding("file", True, text),)))
            continue
        found.append(Checked((path,), tuple(_part_findings(path, parts))))
        face = _face(path, parts)
        if face is not None:
            key = (path.parent, str(face.part.attributes.get("skybake:recipeHash")))
            faces.setdefault(key, []).append(face)
    cubes = [_cube(each) for each in faces.values() if len(each) == _FACES]
    return found + [cube for cube in cubes if cube.findings]


def _parts(path: Path) -> list[RawPart]:
    if path.suffix.lower() not in _SUFFIXES:
        raise InputError(f"{path}: suffix must be .exr or .hdr, got {path.suffix!r}")
    return read_parts(path)


def _part_findings(path: Path, parts: Sequence[RawPart]) -> list[Finding]:
    names = {part.name for part in parts}
    found = []
    for part in parts:
        here = list(_findings(path, part, names))
        # Parts share their tags.
        if part is not parts[0]:
            here = [one for one in here if one not in found]
        prefix = f"{part.name}: " if len(parts) > 1 and part.name else ""
        found += [one._replace(text=prefix + one.text) for one in here]
    return found


def _findings(path: Path, part: RawPart, names: set[str]) -> Iterable[Finding]:
    has_colour = tuple(name.upper()[-1:] for name in part.channels[:3]) == ("R", "G", "B")
    if not has_colour:
        yield Finding("channels", False, f"not R, G and B first: {', '.join(part.channels)}")
    space = part_space(part) if has_colour else None
    is_light = has_colour and part.name not in {"transmittance", "clouds"}
    yield from value_findings(part, space if is_light else None)
    if not is_light:
        return
    yield from tag_findings(part)
    rgb = np.nan_to_num(part.pixels[..., :3], nan=0.0, posinf=0.0, neginf=0.0)
    seen = seen_in(rgb, part.attributes, path.stem)
    if part.name != "sun":
        yield from edge_findings(seen)
    # The clear sky behind clouds is not the light that is stated.
    # What a filter passes is not the light that is stated either.
    is_filtered = POLARIZER in part.attributes
    if space is not None and not is_filtered and not (part.name == "sky" and "clouds" in names):
        yield from light_findings(seen, part.attributes, space, part.name)


def _face(path: Path, parts: Sequence[RawPart]) -> _Face | None:
    part = parts[0]
    shown = file_recipe(part.attributes).get("map")
    if not isinstance(shown, dict) or shown.get("cube_layout") != "faces":
        return None
    seen = seen_in(part.pixels[..., :3], part.attributes, path.stem)
    if len(seen) != 1 or not isinstance(seen[0].chart, FaceChart):
        return None
    return _Face(path, part, seen[0])


def _cube(faces: Sequence[_Face]) -> Checked:
    seen = [
        Seen(face.seen.chart, np.nan_to_num(face.seen.rgb, nan=0.0, posinf=0.0, neginf=0.0))
        for face in faces
    ]
    part = faces[0].part
    space = part_space(part)
    found = list(edge_findings(seen))
    if space is not None:
        found += light_findings(seen, part.attributes, space, part.name)
    return Checked(tuple(face.path for face in faces), tuple(found))
