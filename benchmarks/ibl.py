"""Times the lighting maps of a 4096x2048 map, beside Filament's cmgen where it is installed.

Usage: ``python -m benchmarks.ibl [--runs 5] [--json FILE]``. The set is a specular cube of 256 with
7 mips, irradiance of 64, harmonics and the split sum's table; runs are interleaved and the median
is taken.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
from pathlib import Path

from benchmarks.processes import machine, medians, usage

SKYBAKE = [sys.executable, "-m", "skybake"]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        source = folder / "map.exr"
        usage([*SKYBAKE, "render", "--size", "4096x2048", "-q", "-o", str(source)])
        commands = {"skybake": [*SKYBAKE, "ibl", "--input", str(source), "-q", "-o", str(folder)]}
        cmgen = shutil.which("cmgen")
        if cmgen is not None:
            commands["cmgen"] = [cmgen, "-q", "-x", str(folder / "cmgen"), "-f", "exr", str(source)]
        for command in commands.values():
            usage(command)
        runs: dict[str, list[dict[str, float]]] = {one: [] for one in commands}
        for _ in range(arguments.runs):
            for one, command in commands.items():
                runs[one].append(usage(command))
    measured = {one: medians(of_one) for one, of_one in runs.items()}
    for one, figures in measured.items():
        print(
            f"{one:8} {figures['wall']:6.2f} s wall {figures['cpu']:6.2f} s CPU "
            f"{figures['rss']:6.0f} MB"
        )
    if arguments.json is not None:
        result = {"machine": machine(), "medians": measured}
        arguments.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
