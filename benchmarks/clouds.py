"""Times whole processes of skybake with clouds beside those without.

Usage: ``python -m benchmarks.clouds [--runs 3] [--json FILE] [--large]``. Each case is run once
before, so that kernels are compiled and atmospheres and shapes are on disk. A frame of a sequence
is what each of those costs that follow the first. What is printed is the table of
``docs/clouds.md``.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path

from benchmarks.processes import FIGURES, machine, medians, usage

FRAMES = 5
CUMULUS = ("--clouds", "cumulus:0.4")


def render(size: str, sun: str, output: Path, *more: str) -> list[str]:
    """Command of a map."""
    skybake = (sys.executable, "-m", "skybake", "render", "-q")
    return [*skybake, "--size", size, "--sun", sun, "-o", str(output), *more]


def sequence(frames: int, output: Path) -> list[str]:
    """Command of a sequence in which clouds drift and change under a sun that stands still."""
    skybake = (sys.executable, "-m", "skybake", "sequence", "-q")
    about = ("--size", "2048x1024", "--sun", "45deg", "--frames", f"1-{frames}")
    moments = ("--cloud-time", f"10s..{10 * frames}s" if frames > 1 else "10s")
    return [*skybake, *about, *moments, *CUMULUS, "-o", str(output)]


def cases(folder: Path, *, is_large: bool) -> dict[str, list[str]]:
    """Commands by name."""
    output = folder / "a.exr"
    named = {
        "2048 x 1024, no clouds": render("2048x1024", "45deg", output),
        "2048 x 1024, sun at 45 deg": render("2048x1024", "45deg", output, *CUMULUS),
        "2048 x 1024, sun at 5 deg": render("2048x1024", "5deg", output, *CUMULUS),
        "4096 x 2048, sun at 45 deg": render("4096x2048", "45deg", output, *CUMULUS),
        "4096 x 2048, sun at 5 deg": render("4096x2048", "5deg", output, *CUMULUS),
        "first frame": sequence(1, folder / "one.####.exr"),
        "all frames": sequence(FRAMES, folder / "all.####.exr"),
    }
    if is_large:
        named["8192 x 4096, sun at 45 deg"] = render("8192x4096", "45deg", output, *CUMULUS)
    return named


def with_frame(results: dict[str, dict[str, float]]) -> dict[str, dict[str, float]]:
    """Put a frame that follows the first in the place of both sequences."""
    first, every = results.pop("first frame"), results.pop("all frames")
    frame = {key: (every[key] - first[key]) / (FRAMES - 1) for key in FIGURES}
    return {**results, "2048 x 1024, a frame of a sequence": {**frame, "rss": every["rss"]}}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--large", action="store_true", help="also 8192x4096")
    options = parser.parse_args()
    runs: dict[str, list[dict[str, float]]] = {}
    with tempfile.TemporaryDirectory() as name:
        named = cases(Path(name), is_large=options.large)
        usage(named["2048 x 1024, sun at 5 deg"])
        usage(named["all frames"])
        for _ in range(options.runs):
            for case, command in named.items():
                runs.setdefault(case, []).append(usage(command))
    results = with_frame({case: medians(each) for case, each in runs.items()})
    print("| map | CPU s | s | memory |\n|---|---|---|---|")
    for case, row in results.items():
        print(f"| {case} | {row['cpu']:.1f} | {row['wall']:.1f} | {row['rss']:.0f} MB |")
    if options.json:
        about = machine() | {"runs": options.runs}
        options.json.write_text(json.dumps({"about": about, "medians": results}, indent=1) + "\n")


if __name__ == "__main__":
    main()
