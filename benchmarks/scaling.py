"""Measures how time and memory of whole processes grow with the work.

Usage: ``python -m benchmarks.scaling [--runs 3] [--json FILE]``. Over size (1024 to 16384),
wavelengths (3 to 64), constituents (4 to 12) and CPUs. The exponent of a series is the slope of
log time over log work between its two last points, where constant costs weigh least.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.processes import machine, medians, usage

WIDTHS = (1024, 2048, 4096, 8192, 16384)
WAVELENGTHS = (3, 8, 16, 32, 64)
HAZES = (1, 3, 6, 9)
SMALL = "512x256"

HAZE = """
[constituents.haze{number}]
kind = "aerosol"
optical_depth = 0.01
optical_depth_wavelength_nm = 550.0
relative_extinction = "opac_continental_average"
single_scattering_albedo = "opac_continental_average"
profile = {{ kind = "exponential", scale_height_km = {height} }}
phase = {{ kind = "henyey-greenstein", asymmetry = 0.6 }}
"""


def render(*options: str) -> list[str]:
    """Command of a render."""
    return [sys.executable, "-m", "skybake", "render", "--sun", "5deg", "-q", *options]


def series(folder: Path) -> Iterator[tuple[str, float, list[str], dict[str, str]]]:
    """Name, amount of work, command and environment of every point."""
    output = ("-o", str(folder / "a.exr"))
    for width in WIDTHS:
        size = f"{width}x{width // 2}"
        yield "pixels", width * width / 2, render("--size", size, *output), {}
    for count in WAVELENGTHS:
        wavelengths = [380.0 + 340.0 * i / (count - 1) for i in range(count)]
        preset = folder / f"wavelengths{count}.toml"
        preset.write_text(f'extends = "earth"\nwavelengths_nm = {wavelengths}\n')
        yield "wavelengths", count, render("--size", SMALL, "--preset", str(preset), *output), {}
    for count in HAZES:
        preset = folder / f"hazes{count}.toml"
        hazes = [HAZE.format(number=i, height=1.0 + i) for i in range(count)]
        preset.write_text('extends = "earth"\n' + "".join(hazes))
        command = render("--size", SMALL, "--preset", str(preset), *output)
        yield "constituents", 3 + count, command, {}
    for cpus in range(1, len(os.sched_getaffinity(0)) + 1):
        bound = ["taskset", "-c", f"0-{cpus - 1}", *render("--size", "8192x4096", *output)]
        yield "CPUs", cpus, bound, {}


def measure(runs: int, folder: Path) -> dict[str, list[dict[str, float]]]:
    """Median figures of every point; the first run also solves, and its extra time is kept."""
    found: dict[str, list[dict[str, float]]] = {}
    for name, work, command, environment in series(folder):
        first = usage(command, os.environ | environment)
        figures = medians([usage(command, os.environ | environment) for _ in range(runs)])
        solved = max(first["cpu"] - figures["cpu"], 0.0)
        found.setdefault(name, []).append({"work": work, **figures, "solve_cpu": solved})
        print(name, work, {key: round(value, 2) for key, value in figures.items()}, flush=True)
    return found


def exponent(points: list[dict[str, float]], figure: str) -> float:
    """Slope of log figure over log work between the two last points."""
    before, last = points[-2:]
    return math.log(last[figure] / before[figure]) / math.log(last["work"] / before["work"])


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        found = measure(options.runs, Path(name))
    for name, points in found.items():
        print(f"{name}: wall grows with the power {exponent(points, 'wall'):.2f}")
    if options.json:
        document = {"about": machine() | {"runs": options.runs}, "series": found}
        options.json.write_text(json.dumps(document, indent=1) + "\n")


if __name__ == "__main__":
    main()
