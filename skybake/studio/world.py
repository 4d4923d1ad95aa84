"""The numbers of a preset that its user may change, with where they come from."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from skybake.preset import load_document, load_preset
from skybake.preset.document import Document, Key, dotted
from skybake.preset.find import read_preset


class _Number(NamedTuple):
    title: str
    unit: str
    least: float
    most: float
    is_logarithmic: bool = False


# By the last name of the key: what the number is, and the ends of its slider.
_NUMBERS = {
    "radius_km": _Number("Radius", "km", 100.0, 150_000.0, True),
    "atmosphere_top_km": _Number("Top of the atmosphere", "km", 1.0, 2000.0, True),
    "distance_au": _Number("Distance of the star", "au", 0.01, 50.0, True),
    "pressure_pa": _Number("Pressure at the ground", "Pa", 1.0, 1e7, True),
    "temperature_k": _Number("Temperature", "K", 30.0, 1000.0),
    "column_du": _Number("Column", "DU", 0.0, 1000.0),
    "optical_depth": _Number("Optical depth", "", 0.001, 100.0, True),
    "optical_depth_wavelength_nm": _Number("at a wavelength of", "nm", 380.0, 720.0),
    "angstrom_exponent": _Number("Ångström exponent", "", -1.0, 4.0),
    "scale_height_km": _Number("Scale height", "km", 0.1, 100.0, True),
    "center_km": _Number("Middle of the layer", "km", 0.0, 100.0),
    "half_width_km": _Number("Half width of the layer", "km", 0.1, 50.0, True),
    "scattering_per_km": _Number("Scattering at the ground", "km⁻¹", 1e-5, 10.0, True),
    "absorption_per_km": _Number("Absorption at the ground", "km⁻¹", 1e-5, 10.0, True),
    "asymmetry": _Number("Asymmetry", "", -0.95, 0.95),
    "depolarisation": _Number("Depolarisation", "", 0.0, 0.5),
    "albedo": _Number("Albedo", "", 0.0, 1.0),
    "cover": _Number("Cover", "", 0.0, 1.0),
    "base_km": _Number("Base", "km", 0.0, 30.0),
    "depth_km": _Number("Depth", "km", 0.01, 15.0, True),
    "size_km": _Number("Size", "km", 0.1, 50.0, True),
    "liquid_water_path_g_m2": _Number("Liquid water path", "g m⁻²", 0.1, 5000.0, True),
    "effective_radius_um": _Number("Effective radius", "µm", 1.0, 100.0, True),
}
_SHARE = _Number("Share", "", 0.0, 1.0)
_TABLE = re.compile(r"\s*\[([^\]]+)\]")
_LINE = re.compile(r"\s*([A-Za-z0-9_.-]+)\s*=\s*[^#]*(?:#\s*(.*))?$")


def world_of(preset: str) -> dict[str, Any]:
    """Return the numbers of a preset, fit for JSON.

    Parameters
    ----------
    preset : str
        Name or path.

    Returns
    -------
    dict
        ``name``, ``title``, ``source`` and ``values``, each with the key that ``--set`` takes, its
        ``title``, ``unit``, ``min`` and ``max`` of a slider, ``default`` and ``source``, which is
        the file's own comment.

    Raises
    ------
    PresetError
        If the preset is faulty.
    """
    planet, document = load_preset(preset), load_document(preset)
    comments: dict[str, Mapping[str, str]] = {}
    values = []
    for key, value in document.leaves():
        if isinstance(value, bool) or not isinstance(value, int | float):
            continue
        values.append(_value(key, float(value), _source(document, key, comments)))
    return {
        "name": planet.name,
        "title": planet.title,
        "source": planet.data_quality or ", ".join(comments),
        "values": values,
    }


def _value(key: Key, value: float, source: str) -> dict[str, Any]:
    number = _SHARE if "composition" in key else _NUMBERS.get(key[-1])
    if number is None:
        number = _Number(key[-1].replace("_", " "), "", min(0.0, value), max(1.0, 4.0 * value))
    owner = key[-1] if "composition" in key else " ".join(key[1:-1]).replace(" profile", "")
    return {
        "key": dotted(key).removeprefix("constituents."),
        "group": dotted(key[:2]) if key[0] in {"constituents", "clouds"} else key[0],
        "title": f"{owner}: {number.title}" if owner else number.title,
        "unit": number.unit,
        "min": min(number.least, value) if number.least > 0.0 or value < 0.0 else number.least,
        "max": max(number.most, value),
        "scale": "log" if number.is_logarithmic and value > 0.0 else "linear",
        "default": value,
        "source": source,
    }


def _source(document: Document, key: Key, comments: dict[str, Mapping[str, str]]) -> str:
    """Return the file of a value with the comment beside it or above it."""
    origin = document.source(key)
    if origin.name not in comments:
        path = origin.folder / Path(origin.name).name
        comments[origin.name] = comments_of(read_preset(path, origin.name))
    notes = comments[origin.name]
    known = (notes.get(dotted(key[:depth])) for depth in range(len(key), 1, -1))
    return ": ".join([origin.name, *filter(None, [next(filter(None, known), None)])])


def comments_of(text: str) -> Mapping[str, str]:
    """Return the comments of a preset's text, beside values or above them, by dotted keys."""
    found: dict[str, str] = {}
    table = ""
    above: list[str] = []
    for line in text.splitlines():
        heading, entry = _TABLE.match(line), _LINE.match(line)
        if line.lstrip().startswith("#"):
            above.append(line.lstrip("# ").rstrip())
            continue
        if heading:
            table = f"{heading[1]}."
        elif entry:
            note = " ".join(filter(None, (entry[2], *above)))
            if note:
                found[table + entry[1]] = note
        above = []
    return found
