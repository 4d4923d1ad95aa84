"""Sequences that are baked quickly, as processes."""

import time

from tests.cli.runs import SMALL, run

QUICK = ("sequence", *SMALL, "--method", "hillaire", "--sun", "20deg..60deg")


def bake(folder, *arguments, status=0):
    """Bake quietly into a folder; returns standard error."""
    found, output, errors = run(*QUICK, "-o", "a.#.exr", "-q", *arguments, cwd=folder)
    assert (found, output) == (status, ""), errors
    return errors


def contents(folder):
    """Bytes of all files by name."""
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}


def wait_for(condition, process):
    """Wait until something has happened while a process runs."""
    while not condition():
        assert process.poll() is None
        time.sleep(0.005)
