"""Times whole processes of skybake beside the floor and beside its peers.

Usage: ``python -m benchmarks.render [--runs 7] [--json FILE] [--mitsuba PYTHON]
[--blender PYTHON] [--large] [--cold]``. Runs are interleaved and the median is taken, so that a
machine's moods fall on all alike. The floor is a process that imports numpy, numba and
OpenImageIO and writes the same pixels as skybake has baked. Mitsuba comes with the extra ``bench``
(it needs LLVM's shared library); it may also lie in another environment, as Blender (``pip install
bpy``) must where it wants another Python: each is named by the interpreter that has it.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from benchmarks.processes import machine, medians, usage

PEERS = Path(__file__).parent / "peers"
FRAMES = 96

FLOOR = """
import sys
import numpy, numba
import OpenImageIO as oiio
source = oiio.ImageBuf(sys.argv[1])
spec = oiio.ImageSpec(source.spec())
spec["compression"] = "zip:2"
pixels = source.get_pixels(oiio.HALF)
import time, resource
begin, used = time.perf_counter(), resource.getrusage(resource.RUSAGE_SELF).ru_utime
out = oiio.ImageOutput.create(sys.argv[2])
out.open(sys.argv[2], spec)
out.write_image(pixels)
out.close()
wall = time.perf_counter() - begin
print(wall, resource.getrusage(resource.RUSAGE_SELF).ru_utime - used)
"""
IMPORTS = "import numpy, numba, OpenImageIO"


def cases(folder: Path, options: argparse.Namespace) -> dict[str, list[str]]:
    """Commands by name."""
    skybake = [sys.executable, "-m", "skybake"]

    def map_of(size: str, *more: str, name: str = "a.exr") -> list[str]:
        output = str(folder / name)
        return [*skybake, "render", "--sun", "5deg", "-q", "--size", size, "-o", output, *more]

    named = {
        "imports": [sys.executable, "-c", IMPORTS],
        "help": [*skybake, "--help"],
        "64x32": map_of("64x32"),
        "2048x1024": map_of("2048x1024"),
        "4096x2048": map_of("4096x2048", name="large.exr"),
        "4096x2048 mars": map_of("4096x2048", "--preset", "mars"),
        "4096x2048 at 400 km": map_of("4096x2048", "--altitude", "400km"),
        "cubemap 1024": map_of("1024", "--projection", "cubemap"),
    }
    if options.mitsuba:
        named["Mitsuba 4096x2048"] = [
            *(options.mitsuba, str(PEERS / "mitsuba_sky.py")),
            *("4096", "5", str(folder / "mitsuba.exr")),
        ]
    if options.blender:
        named["Blender 4096x2048"] = [
            *(options.blender, str(PEERS / "blender_sky.py")),
            *("4096", "5", str(folder / "blender.exr")),
        ]
    if options.large:
        named["16384x8192"] = map_of("16384x8192")
    return named


def sequence(folder: Path) -> list[str]:
    """Command of a sequence."""
    return [
        *(sys.executable, "-m", "skybake", "sequence", "--sun", "-6deg..90deg", "-q"),
        *("--frames", f"1-{FRAMES}", "--size", "2048x1024", "-o", str(folder / "sky.####.exr")),
    ]


def floor(folder: Path, imports: dict[str, float]) -> dict[str, float]:
    """Cost of the imports and of writing what skybake has baked."""
    files = [str(folder / "large.exr"), str(folder / "floor.exr")]
    written = usage([sys.executable, "-c", FLOOR, *files])
    wall, cpu = (float(part) for part in written["output"].split())
    return {"wall": imports["wall"] + wall, "cpu": imports["cpu"] + cpu, "rss": written["rss"]}


def peer_versions(options: argparse.Namespace) -> dict[str, str]:
    """Versions of the peers, as they say themselves."""
    asked = {
        "Mitsuba": (options.mitsuba, "import mitsuba; print(mitsuba.__version__)"),
        "Blender": (options.blender, "import bpy; print(bpy.app.version_string)"),
    }
    return {
        name: str(usage([python, "-c", code])["output"]).split()[-1]
        for name, (python, code) in asked.items()
        if python
    }


def measure(options: argparse.Namespace, folder: Path) -> dict[str, list[dict[str, float]]]:
    """Run everything, interleaved."""
    results: dict[str, list[dict[str, float]]] = {}
    named = cases(folder, options)
    for command in named.values():
        usage(command)
    for _ in range(options.runs):
        for case, command in named.items():
            results.setdefault(case, []).append(usage(command))
        results.setdefault("floor 4096x2048", []).append(floor(folder, results["imports"][-1]))
    frames = f"{FRAMES} frames 2048x1024"
    results[frames] = [usage(sequence(folder)) for _ in range(min(options.runs, 3))]
    if options.cold:
        for run in range(min(options.runs, 3)):
            cold = {"SKYBAKE_CACHE_DIR": str(folder / f"cold{run}")}
            command = ["env", *(f"{key}={value}" for key, value in cold.items())]
            results.setdefault("2048x1024 cold", []).append(usage([*command, *named["2048x1024"]]))
    return results


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--json", type=Path)
    parser.add_argument(
        "--mitsuba",
        metavar="PYTHON",
        default=sys.executable if find_spec("mitsuba") else None,
        help="interpreter that has mitsuba",
    )
    parser.add_argument("--blender", metavar="PYTHON", help="interpreter that has bpy")
    parser.add_argument("--large", action="store_true", help="also 16384x8192")
    parser.add_argument("--cold", action="store_true", help="also without compiled kernels")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        results = {case: medians(runs) for case, runs in measure(options, Path(name)).items()}
    print(f"{'case':<22} {'wall s':>8} {'CPU s':>8} {'peak MB':>8}")
    for case, row in results.items():
        print(f"{case:<22} {row['wall']:8.2f} {row['cpu']:8.2f} {row['rss']:8.0f}")
    if options.json:
        about = machine() | {"runs": options.runs, "peers": peer_versions(options)}
        options.json.write_text(json.dumps({"about": about, "medians": results}, indent=1) + "\n")


if __name__ == "__main__":
    main()
