"""Wall time, CPU time and peak memory of whole processes."""

from __future__ import annotations

import json
import os
import platform
import re
import resource
import statistics
import subprocess
import time
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

FIGURES = ("wall", "cpu", "rss")


def usage(command: list[str], environment: dict[str, str] | None = None) -> dict[str, float]:
    """Run a command in a child of its own, so that its CPU time and memory are its alone.

    Returns
    -------
    dict
        ``wall`` and ``cpu`` [s], ``rss`` [MB], and ``output``, its standard output.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reader)
        result = _measure(command, environment)
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        result |= {"cpu": used.ru_utime + used.ru_stime, "rss": used.ru_maxrss * 1024 / 1e6}
        os.write(writer, json.dumps(result).encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader) as pipe:
        text = pipe.read()
    os.waitpid(child, 0)
    if not text:
        raise SystemExit(f"{' '.join(command)}: must succeed")
    return json.loads(text)


def medians(runs: list[dict[str, float]]) -> dict[str, float]:
    """Median of each figure over runs."""
    return {key: statistics.median(run[key] for run in runs) for key in FIGURES}


def machine() -> dict[str, object]:
    """Return the machine and the versions that were measured."""
    packages = ("skybake", "numpy", "numba", "OpenImageIO")
    return {
        "date": datetime.now(UTC).date().isoformat(),
        "processor": _processor(),
        "cpus": len(os.sched_getaffinity(0)),
        "python": platform.python_version(),
        "versions": {name: version(name) for name in packages},
    }


def _measure(command: list[str], environment: dict[str, str] | None) -> dict[str, float]:
    begin = time.perf_counter()
    process = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    wall = time.perf_counter() - begin
    if process.returncode:
        raise SystemExit(f"{' '.join(command)}: must succeed, got {process.stderr.strip()}")
    return {"wall": wall, "output": process.stdout[-4000:]}


def _processor() -> str:
    cpuinfo = Path("/proc/cpuinfo")
    found = cpuinfo.exists() and re.search(r"model name\s*: (.*)", cpuinfo.read_text())
    return found[1] if found else platform.machine()
