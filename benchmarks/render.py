"""Times whole processes of ``skybake render`` beside the floor of their imports and file write.

Usage: ``python benchmarks/render.py [--runs 7] [--json FILE] [--large]``. Runs are
interleaved and the median is taken, so that a machine's moods fall on all alike.
The floor is a process that imports numpy, numba and OpenImageIO and writes the
same pixels as skybake has baked.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from datetime import UTC, datetime
from pathlib import Path

FLOOR = """
import sys
import numpy, numba
import OpenImageIO as oiio
source = oiio.ImageBuf(sys.argv[1])
spec = oiio.ImageSpec(source.spec())
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


def measure(command: list[str], environment: dict[str, str]) -> dict[str, float]:
    """Wall seconds, CPU seconds and peak resident memory of one process."""
    begin = time.perf_counter()
    process = subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    output, errors = process.communicate()
    wall = time.perf_counter() - begin
    if process.returncode:
        raise SystemExit(f"{' '.join(command)}: must succeed, got {errors.strip()}")
    return {"wall": wall, "output": output}


def usage(command: list[str], environment: dict[str, str]) -> dict[str, float]:
    """Run a command in a child of its own, so that its CPU time and memory are its alone."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reader)
        result = measure(command, environment)
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        result |= {"cpu": used.ru_utime + used.ru_stime, "rss": used.ru_maxrss / 1024}
        os.write(writer, json.dumps(result).encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader) as pipe:
        text = pipe.read()
    os.waitpid(child, 0)
    if not text:
        raise SystemExit(f"{' '.join(command)}: must succeed")
    return json.loads(text)


def cases(folder: Path, *, large: bool) -> dict[str, list[str]]:
    """Commands by name."""
    render = [sys.executable, "-m", "skybake", "render", "--sun", "5deg", "--quiet"]

    def map_of(size: str, *options: str) -> list[str]:
        return [*render, "--size", size, "-o", str(folder / f"{size}.exr"), *options]

    named = {
        "imports": [sys.executable, "-c", IMPORTS],
        "help": [sys.executable, "-m", "skybake", "--help"],
        "2048x1024": map_of("2048x1024"),
        "4096x2048": map_of("4096x2048"),
        "4096x2048 mars": map_of("4096x2048", "--preset", "mars"),
        "cubemap 1024": [
            *(*render, "--projection", "cubemap", "--size", "1024"),
            *("-o", str(folder / "cube.exr")),
        ],
    }
    if large:
        named["16384x8192"] = map_of("16384x8192")
    return named


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--large", action="store_true", help="also 16384x8192")
    parser.add_argument("--cold", action="store_true", help="also without compiled kernels")
    options = parser.parse_args()
    results: dict[str, list[dict[str, float]]] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        environment = dict(os.environ)
        named = cases(folder, large=options.large)
        for command in named.values():
            usage(command, environment)
        floor = [sys.executable, "-c", FLOOR]
        floor += [str(folder / "4096x2048.exr"), str(folder / "floor.exr")]
        for _ in range(options.runs):
            for case, command in named.items():
                results.setdefault(case, []).append(usage(command, environment))
            written = usage(floor, environment)
            wall, cpu = (float(part) for part in written["output"].split())
            imports = results["imports"][-1]
            results.setdefault("floor 4096x2048", []).append(
                {
                    "wall": imports["wall"] + wall,
                    "cpu": imports["cpu"] + cpu,
                    "rss": written["rss"],
                }
            )
        if options.cold:
            for run in range(min(options.runs, 3)):
                cold = environment | {"SKYBAKE_CACHE_DIR": str(folder / f"cold{run}")}
                results.setdefault("2048x1024 cold", []).append(usage(named["2048x1024"], cold))
    medians = {
        case: {key: statistics.median(run[key] for run in runs) for key in ("wall", "cpu", "rss")}
        for case, runs in results.items()
    }
    print(f"{'case':<18} {'wall s':>8} {'CPU s':>8} {'peak MB':>8}")
    for case, row in medians.items():
        print(f"{case:<18} {row['wall']:8.2f} {row['cpu']:8.2f} {row['rss']:8.0f}")
    if options.json:
        about = {
            "date": datetime.now(UTC).date().isoformat(),
            "machine": platform.processor() or platform.machine(),
            "cpus": len(os.sched_getaffinity(0)),
            "python": platform.python_version(),
            "runs": options.runs,
        }
        options.json.write_text(json.dumps({"about": about, "medians": medians}, indent=1) + "\n")


if __name__ == "__main__":
    main()
