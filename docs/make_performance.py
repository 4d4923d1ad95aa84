"""Writes docs/performance.md and the README's table from what the benchmarks have measured.

Usage: ``python docs/make_performance.py``, after ``python -m benchmarks.render --json
benchmarks/render.json --cold`` and ``python -m benchmarks.scaling --json benchmarks/scaling.json``.
Needs matplotlib.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
FRAMES = "96 frames 2048x1024"
LARGE = "4096x2048"
ORDER = (
    *("floor 4096x2048", LARGE, "4096x2048 mars", "4096x2048 at 400 km"),
    *("Mitsuba 4096x2048", "Blender 4096x2048", "2048x1024", "cubemap 1024", FRAMES),
    *("64x32", "2048x1024 cold", "help"),
)
NAMES = {
    "floor 4096x2048": "floor, 4096x2048",
    LARGE: "`--size 4096x2048`",
    "4096x2048 mars": "`--size 4096x2048 --preset mars`",
    "4096x2048 at 400 km": "`--size 4096x2048 --altitude 400km`",
    "64x32": "`--size 64x32`",
    "2048x1024": "`--size 2048x1024`",
    "cubemap 1024": "`--projection cubemap --size 1024`",
    FRAMES: "`sequence`, 96 frames of 2048x1024",
    "2048x1024 cold": "`--size 2048x1024`, nothing compiled, nothing solved",
    "help": "`--help`",
}


def main() -> None:
    """Read the measurements and write the documents."""
    measured = json.loads((ROOT / "benchmarks" / "render.json").read_text())
    scaling = json.loads((ROOT / "benchmarks" / "scaling.json").read_text())
    medians, about = measured["medians"], measured["about"]
    table = _table(medians)
    template = (DOCS / "performance.template.md").read_text()
    text = template.format(
        table=table, **_about(about), **_ratios(medians), **_growth(scaling["series"], medians)
    )
    (DOCS / "performance.md").write_text(text)
    _write_readme(table, about)
    _plot(scaling["series"], DOCS / "images" / "scaling.png")


def _table(medians: dict[str, Any]) -> str:
    lines = ["| | wall | CPU | peak memory |", "|---|---|---|---|"]
    lines += [
        f"| {NAMES.get(case, case)} | {row['wall']:.2f} s | {row['cpu']:.2f} s | "
        f"{row['rss']:.0f} MB |"
        for case in ORDER
        if (row := medians.get(case))
    ]
    return "\n".join(lines)


def _about(about: dict[str, Any]) -> dict[str, Any]:
    versions = {name.lower(): number for name, number in about["versions"].items()}
    peers = {name.lower(): number for name, number in about["peers"].items()}
    names = ("processor", "cpus", "date", "python", "runs")
    return {name: about[name] for name in names} | versions | peers


def _ratios(medians: dict[str, Any]) -> dict[str, str]:
    large, small = medians[LARGE], medians["2048x1024"]

    def ratio(figure: str, other: str) -> str:
        return f"{large[figure] / medians[other][figure]:.2f} times"

    return {
        "floor": f"{medians['floor 4096x2048']['wall']:.2f}",
        "floor_wall": ratio("wall", "floor 4096x2048"),
        "mitsuba_cpu": ratio("cpu", "Mitsuba 4096x2048"),
        "blender_cpu": ratio("cpu", "Blender 4096x2048"),
        "rss": f"{large['rss']:.0f} MB",
        "wall_2k": f"{small['wall']:.2f} s",
        "frames": FRAMES,
        "frames_wall": f"{medians[FRAMES]['wall']:.1f} s",
        "cold": f"{medians['2048x1024 cold']['wall']:.1f} s",
    }


def _growth(series: dict[str, Any], medians: dict[str, Any]) -> dict[str, str]:
    lines = ["| over | from | to | wall | power |", "|---|---|---|---|---|"]
    for name, points in series.items():
        first, last = points[0], points[-1]
        lines.append(
            f"| {name} | {first['work']:.3g} | {last['work']:.3g} | "
            f"{first['wall']:.2f} to {last['wall']:.2f} s | {exponent(points):.2f} |"
        )
    before, last = series["pixels"][-2:]
    per_pixel = (last["wall"] - before["wall"]) / (last["work"] - before["work"])
    pixels = 32768 * 16384
    band = 2 * 128 * (32768 - 16384) * 12 / 1e6
    return {
        "growth": "\n".join(lines),
        "serial": f"{medians['64x32']['wall']:.2f}",
        "per_megapixel": f"{per_pixel * 1e9:.0f}",
        "wall_32k": f"{last['wall'] + per_pixel * (pixels - last['work']):.0f}",
        "rss_32k": f"{last['rss'] + band:.0f}",
    }


def exponent(points: list[dict[str, float]]) -> float:
    """Slope of log wall time over log work between the two last points."""
    before, last = points[-2:]
    return math.log(last["wall"] / before["wall"]) / math.log(last["work"] / before["work"])


def _write_readme(table: str, about: dict[str, Any]) -> None:
    path = ROOT / "README.md"
    kept = ("| | wall", "|---", "| floor", "| `--size 4096x2048` ", "| Mitsuba", "| Blender")
    kept += ("| `--size 2048x1024` ", "| `--projection", "| `sequence`", "| `--size 2048x1024`,")
    rows = "\n".join(line for line in table.splitlines() if line.startswith(kept))
    peers = ", ".join(f"{name} {number}" for name, number in about["peers"].items())
    block = f"{rows}\n\n{about['processor']}, {about['cpus']} CPUs, {about['date']}; {peers}."
    marked = re.compile(r"(<!-- speed -->\n).*?(\n<!-- /speed -->)", re.DOTALL)
    text, count = marked.subn(lambda found: f"{found[1]}{block}{found[2]}", path.read_text())
    if count != 1:
        raise SystemExit(f"{path}: must have one place marked for the speed, got {count}")
    path.write_text(text)


def _plot(series: dict[str, Any], path: Path) -> None:
    figure, axes = plt.subplots(2, 2, figsize=(9.0, 6.5), layout="constrained")
    for axis, (name, points) in zip(axes.flat, series.items(), strict=True):
        work = [point["work"] for point in points]
        axis.plot(work, [point["wall"] for point in points], "o-", label="wall [s]")
        axis.plot(work, [point["cpu"] for point in points], "s--", label="CPU [s]")
        if name in {"wavelengths", "constituents"}:
            solve = [point["solve_cpu"] for point in points]
            axis.plot(work, solve, "^:", label="CPU to solve once [s]")
        if name == "pixels":
            memory = axis.twinx()
            memory.plot(work, [point["rss"] for point in points], "d-.", color="grey")
            memory.set_ylabel("peak memory [MB]", color="grey")
            memory.set_ylim(bottom=0.0)
        if name == "pixels":
            axis.set_xscale("log")
            axis.set_yscale("log")
            axis.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.yaxis.set_major_formatter(ScalarFormatter())
            axis.yaxis.set_minor_formatter(NullFormatter())
        else:
            axis.set_xticks(work)
            axis.set_ylim(bottom=0.0)
        axis.set_xlabel(name)
        axis.set_title(f"power {exponent(points):.2f} at the end", fontsize=10)
        axis.grid(visible=True, which="both", alpha=0.3)
        axis.legend(fontsize=8)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
