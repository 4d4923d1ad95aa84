"""Ways to run the command line: in this process, and in one of its own."""

import os
import pty
import subprocess
import sys
from pathlib import Path

from click.testing import CliRunner

import skybake
from skybake.cli import main
from skybake.sequence.digests import FOLDER as DIGESTS

PACKAGES = str(Path(skybake.__file__).parents[1])
SMALL = ("--size", "64x32")

# Root may write everywhere, unless a capability is taken from it.
AS_A_USER = ("setpriv", "--bounding-set=-dac_override,-dac_read_search") if os.getuid() == 0 else ()
"""Wrapper of a process that may write only where its permissions say so."""


def invoke(*arguments):
    """Run in this process; click's result has output, stdout, stderr and exit_code."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def start(*arguments, code="from skybake.cli import run; run()", wrapper=(), **keywords):
    """Start a process with the command line, or with other code that has its arguments."""
    return subprocess.Popen(
        [*wrapper, sys.executable, "-c", code, *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": PACKAGES} | keywords.pop("env", {}),
        stdout=keywords.pop("stdout", subprocess.PIPE),
        stderr=keywords.pop("stderr", subprocess.PIPE),
        text=True,
        **keywords,
    )


def installed(folder, skybake=f'exec {sys.executable} -m skybake "$@"'):
    """Environment in which a shell finds our programs, as an installation puts them there.

    What `skybake` does may be given as lines of a shell.
    """
    folder.mkdir()
    for name, lines in (("skybake", skybake), ("dask", f'exec {sys.executable} -m dask "$@"')):
        program = folder / name
        program.write_text(f"#!/bin/sh\n{lines}\n")
        program.chmod(0o755)
    return os.environ | {"PATH": f"{folder}:{os.environ['PATH']}", "PYTHONPATH": PACKAGES}


def run(*arguments, **keywords):
    """Run in a process of its own; returns exit status, stdout and stderr."""
    process = start(*arguments, **keywords)
    output, errors = process.communicate(timeout=240)
    return process.returncode, output, errors


def render(target, *arguments, **keywords):
    """Render in a process of its own, which must say nothing; returns the bytes of the map."""
    status, output, errors = run(
        *("render", *arguments, "-o", target, "--quiet"), cwd=target.parent, **keywords
    )
    assert (status, output, errors) == (0, "", "")
    return target.read_bytes()


def run_on_terminal(*arguments, **keywords):
    """Run with a terminal for standard error; returns exit status, stdout, and its bytes."""
    terminal, end = pty.openpty()
    process = start(*arguments, stderr=end, **keywords)
    os.close(end)
    seen = b""
    try:
        while chunk := os.read(terminal, 4096):
            seen += chunk
    except OSError:  # the other end is closed
        pass
    os.close(terminal)
    output, _ = process.communicate(timeout=60)
    return process.returncode, output, seen


def listing(folder):
    """Names in a folder, hidden ones too, but for the digests of frames."""
    return sorted(path.name for path in folder.iterdir() if path.name != DIGESTS)
