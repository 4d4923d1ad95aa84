"""Phase functions of a preset."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from itertools import pairwise

from skybake.errors import PresetWarning
from skybake.preset.optics_model import (
    CornetteShanksPhase,
    DoubleHenyeyGreensteinPhase,
    HenyeyGreensteinPhase,
    Phase,
    RayleighPhase,
    TabulatedPhase,
)
from skybake.preset.polarisation import (
    read_angles,
    read_polarisation,
    wavelength_of_column,
)
from skybake.preset.section import Gather, Section

PHASES = (
    "rayleigh",
    "henyey-greenstein",
    "cornette-shanks",
    "double-henyey-greenstein",
    "tabulated",
)

ASYMMETRY = (-0.75, 0.9)
"""What the solver holds without negative light, measured at optical depths of 0.3 and 3 and suns
from 60 to -6 deg: a backward peak cannot be truncated, and of a sharper forward peak more lies in
what is truncated than single scattering restores."""

MAX_DEVIATION = 0.01
"""By which the integral of a table may differ from 1; within it the table is normalised."""

NOTED_DEVIATION = 1e-3
"""Less is due to the rounding of a table's digits, and needs no warning."""


def read_phase(section: Section, asymmetry: tuple[float, float] = ASYMMETRY) -> Phase:
    """Read ``phase``.

    Parameters
    ----------
    section : Section
        Its table.
    asymmetry : tuple of float, optional
        Least and greatest mean cosine that the transport holds.

    Raises
    ------
    PresetError
        With each key and the rule that it breaks.
    """
    kind = section.choice("kind", PHASES)
    read = Gather(section)
    phase: Phase
    if kind == "rayleigh":
        # 1/2 belongs to a molecule that can be polarised along one axis only.
        phase = RayleighPhase(read(section.spectrum, "depolarisation", 0.0, 0.5, default=0.0))
    elif kind == "henyey-greenstein":
        phase = HenyeyGreensteinPhase(read(section.spectrum, "asymmetry", *asymmetry))
    elif kind == "cornette-shanks":
        phase = CornetteShanksPhase(read(section.spectrum, "asymmetry", *asymmetry))
    elif kind == "double-henyey-greenstein":
        phase = DoubleHenyeyGreensteinPhase(
            read(section.spectrum, "first_asymmetry", *asymmetry),
            read(section.spectrum, "second_asymmetry", *asymmetry),
            read(section.spectrum, "first_fraction", 0.0, 1.0),
        )
    else:
        phase = read(_read_table, section)
        if section.has("polarisation"):
            polarisation = read(read_polarisation, section)
            if phase is not None:
                phase = replace(phase, polarisation=polarisation)
    read.finish()
    return phase


def _read_table(section: Section) -> TabulatedPhase:
    columns, angle = read_angles(section, "table")
    bands = sorted(
        (wavelength_of_column(section, "table", key), values)
        for key, values in columns.items()
        if key != "angle_deg"
    )
    if not bands:
        section.fail("table", "must have a column of values beside angle_deg")
    if len({wavelength for wavelength, _ in bands}) < len(bands):
        section.fail("table", "wavelengths must differ from each other")
    if any(min(values) <= 0.0 for _, values in bands):
        section.fail("table", "values must be greater than 0")
    wavelengths = tuple(wavelength for wavelength, _ in bands)
    if len(bands) > 1:
        section.check_cover("table", wavelengths)
    for wavelength, values in bands:
        _check_integral(section, wavelength, integral_over_sphere(angle, values))
    return TabulatedPhase(
        section.where("table"),
        angle,
        wavelengths if len(bands) > 1 else (),
        tuple(values for _, values in bands),
    )


def integral_over_sphere(angle: tuple[float, ...], values: tuple[float, ...]) -> float:
    """Integral over the sphere of a table that is interpolated in its logarithm.

    Parameters
    ----------
    angle : tuple of float
        Ascending from 0 to pi. [rad]
    values : tuple of float
        Positive. [sr⁻¹]

    Notes
    -----
    Exact, by the integral of exp(s t) sin t, which is
    exp(s t) (s sin t - cos t) / (s² + 1).
    """
    total = 0.0
    for (a, left), (b, right) in pairwise(zip(angle, values, strict=True)):
        slope = (math.log(right) - math.log(left)) / (b - a)
        upper = right * (slope * math.sin(b) - math.cos(b))
        lower = left * (slope * math.sin(a) - math.cos(a))
        total += (upper - lower) / (slope * slope + 1.0)
    return 2.0 * math.pi * total


def _check_integral(section: Section, wavelength: float, integral: float) -> None:
    deviation = abs(integral - 1.0)
    if not deviation <= MAX_DEVIATION:
        section.fail(
            "table",
            f"must integrate to 1 over the sphere within 1 %, "
            f"got {integral:.4f} at {wavelength:g} nm",
        )
    if deviation > NOTED_DEVIATION:
        warnings.warn(
            f"{section.where('table')}: integrates to {integral:.4f} over the sphere at "
            f"{wavelength:g} nm and is normalised to 1",
            PresetWarning,
            stacklevel=2,
        )
