"""A set of tables in files, all of which appear together."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from skybake.errors import OutputError
from skybake.formats.ktx2_texture import write_ktx2_texture
from skybake.formats.spec import Attribute, MapSpec
from skybake.formats.targets import check_target, faults_of
from skybake.formats.whole_files import WholeFiles
from skybake.formats.writer import open_maps
from skybake.luts.shading import LANGUAGES
from skybake.luts.table import Table

DESCRIPTION = "luts.json"
CODE = tuple(f"luts.{language}" for language in LANGUAGES)
TABLE_NAMES = (
    *("transmittance", "multiple_scattering", "sky_view"),
    *("aerial_perspective", "aerial_transmittance"),
)
SUFFIXES = (".exr", ".ktx2")


def file_names() -> dict[str, list[str]]:
    """Return the names of each table's files, and of ``code`` in each language."""
    names = {name: [name + suffix for suffix in SUFFIXES] for name in TABLE_NAMES}
    return {**names, "code": list(CODE)}


@contextmanager
def folder_of_tables(folder: Path) -> Iterator[None]:
    """Make a folder if there is none, and remove it again if nothing is written into it.

    Parameters
    ----------
    folder : Path
        Inside one that exists.

    Raises
    ------
    OutputError
        If it cannot be made, is no folder, or a file cannot be written there.
    """
    is_new = not folder.exists()
    if not is_new and not folder.is_dir():
        raise OutputError(f"{folder}: must be a folder, got a file")
    if is_new and not folder.parent.is_dir():
        raise OutputError(f"{folder}: folder must exist, got {folder.parent}")
    with faults_of(folder):
        folder.mkdir(exist_ok=True)
    try:
        for names in (*file_names().values(), [DESCRIPTION]):
            for name in names:
                check_target(folder / name)
        yield
    except BaseException:
        if is_new:
            with suppress(OSError):
                folder.rmdir()
        raise


def write_tables(
    folder: Path,
    tables: Mapping[str, Table],
    description: Mapping[str, Any],
    code: Mapping[str, str],
    spec: MapSpec,
) -> tuple[Path, ...]:
    """Write tables, what they are, and code that looks them up.

    Parameters
    ----------
    folder : Path
        Where to; it exists.
    tables : mapping of str to Table
        By name.
    description : mapping
        Content of ``luts.json``.
    code : mapping of str to str
        By language.
    spec : MapSpec
        What files state besides their texels; its size and channels are not used.

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    OutputError
        If a file cannot be written, or a value does not fit its type; no file is left then.
    """
    paths = []
    with WholeFiles() as files:
        for name, table in tables.items():
            stated = _stating(spec, table)
            paths.append(folder / f"{name}.ktx2")
            tags: dict[str, Attribute] = {"colorInteropID": spec.colour_space.interop_id}
            if stated.white_luminance is not None:
                tags["whiteLuminance"] = stated.white_luminance
            write_ktx2_texture(
                paths[-1],
                table.values,
                pixel=spec.pixel,
                attributes={**tags, **stated.attributes},
                files=files,
            )
            paths.append(folder / f"{name}.exr")
            with open_maps({paths[-1]: stated}, files) as writers:
                rows = table.values.reshape(stated.height, stated.width, -1)
                writers[paths[-1]].write_rows(0, stated.height, rows)
        texts = {f"luts.{language}": text for language, text in code.items()}
        texts[DESCRIPTION] = json.dumps(description, indent=1) + "\n"
        for name, text in texts.items():
            paths.append(folder / name)
            files.add(paths[-1]).write_text(text, encoding="utf-8")
    return tuple(paths)


def _stating(spec: MapSpec, table: Table) -> MapSpec:
    """Return what the files of a table state; of a volume, with its slices one above the other."""
    width, height, *depth = table.size
    attributes: dict[str, Attribute] = {
        **spec.attributes,
        "skybake:table": table.name,
        "skybake:quantity": table.quantity,
        "skybake:unit": table.unit,
    }
    if depth:
        attributes["skybake:slices"] = depth[0]
    return replace(
        spec,
        width=width,
        height=height * (depth[0] if depth else 1),
        channels=table.channels,
        white_luminance=spec.white_luminance if table.is_radiance else None,
        attributes=attributes,
    )
