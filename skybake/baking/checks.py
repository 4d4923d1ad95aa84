"""What can be refused of a map's files before anything is computed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from skybake.baking.paths import map_paths
from skybake.errors import InputError
from skybake.formats.cube_file import check_cube_encoding, is_cube_file
from skybake.formats.preview import check_preview
from skybake.formats.writer import check_map_path
from skybake.image.settings import MapSettings


def check_targets(
    output: Path,
    settings: MapSettings,
    preview: Path | None = None,
    light_files: Sequence[Path] = (),
) -> None:
    """Raise the errors of a map's files that can be found before anything is computed.

    Raises
    ------
    InputError
        If a suffix names no format, or the format cannot hold the map.
    OutputError
        If a file cannot be written under its name.
    """
    for path in map_paths(output, settings):
        check_map_path(path)
        _check_encoding(path, settings)
    if preview is not None:
        check_preview(preview)
    if light_files:
        from skybake.sidecar.light_file import check_light_files

        check_light_files(light_files, settings.view.projection, map_paths(output, settings))


def _check_encoding(path: Path, settings: MapSettings) -> None:
    """Refuse a type, a compression or smaller copies that the format of a file does not have."""
    encoding = settings.encoding
    if is_cube_file(path):
        check_cube_encoding(path, encoding.pixel, encoding.compression)
    elif encoding.pixel in ("rgb9e5", "r11g11b10"):
        raise InputError(f"{path}: pixel {encoding.pixel} must be in .ktx2")
    if encoding.layers or settings.lighting.sun_disc == "separate":
        from skybake.baking.parts import check_parts

        check_parts(path, settings)
    if not settings.sensor.is_eye:
        from skybake.baking.bands import check_bands

        check_bands(path, settings)
    if encoding.mips:
        from skybake.baking.mips import check_mips

        check_mips(path, settings.view.projection)
