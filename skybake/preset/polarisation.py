"""How particles of a preset polarise the light that they scatter."""

from __future__ import annotations

import math
from itertools import pairwise

from skybake.preset.optics_model import PolarisationTable
from skybake.preset.section import Section

KEY = "polarisation"
ELEMENTS = "p12", "p33"

LARGEST = 1.0 + 1e-6
"""Of an element over P11, but for the rounding of a table's digits."""


def read_polarisation(section: Section) -> PolarisationTable:
    """Read the table that ``polarisation`` names.

    Raises
    ------
    PresetError
        If it is not a table of elements that some particle could have.
    """
    columns, angle = read_angles(section, KEY)
    elements: dict[str, dict[float, tuple[float, ...]]] = {name: {} for name in ELEMENTS}
    for column, values in columns.items():
        if column == "angle_deg":
            continue
        name, _, wavelength = column.partition("_")
        if name not in elements:
            section.fail(KEY, f"columns must be named p12_NM or p33_NM, got {column!r}")
        if not max(map(abs, values)) <= LARGEST:
            section.fail(KEY, f"{column} must be from -1 to 1")
        elements[name][wavelength_of_column(section, KEY, wavelength)] = values
    p12, p33 = elements.values()
    if not p12 or set(p12) != set(p33):
        section.fail(KEY, "must have a column p12_ and a column p33_ for each of its wavelengths")
    wavelengths = tuple(sorted(p12))
    section.check_cover(KEY, wavelengths)
    return PolarisationTable(
        section.where(KEY),
        angle,
        wavelengths,
        tuple(p12[each] for each in wavelengths),
        tuple(p33[each] for each in wavelengths),
    )


def read_angles(
    section: Section, key: str
) -> tuple[dict[str, tuple[float, ...]], tuple[float, ...]]:
    """Read a table over scattering angle; its columns and its angles in radians."""
    columns = section.table(key, "angle_deg")
    degrees = columns.get("angle_deg", ())
    if not degrees or degrees[0] != 0.0 or degrees[-1] != 180.0:
        section.fail(key, "column angle_deg must run from 0 to 180")
    if any(a >= b for a, b in pairwise(degrees)):
        section.fail(key, "angle_deg must ascend")
    return columns, tuple(math.radians(a) for a in degrees)


def wavelength_of_column(section: Section, key: str, column: str) -> float:
    """Wavelength that a column of a table is named by. [nm]"""
    try:
        wavelength = float(column)
    except ValueError:
        wavelength = math.nan
    if not 1.0 <= wavelength <= 1e6:
        section.fail(key, f"columns must be named by their wavelength in nm, got {column!r}")
    return wavelength
