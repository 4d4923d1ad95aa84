"""Lines on standard error about what takes long, and what to know of a result."""

from __future__ import annotations

import sys
from pathlib import Path

import click


def announce(output: Path) -> None:
    """Print what is baked, and on the first run why it takes longer."""
    announce_kernels()
    if not sys.stderr.isatty():
        notice(f"baking {output}")


def announce_kernels() -> None:
    """Print on the first run why it takes longer."""
    from skybake.jit.cache import is_warm

    if not is_warm():
        notice("compiling kernels, once for this version")


def warn(line: str) -> None:
    """Print what a user should know of a result."""
    notice(f"warning: {line}")


def notice(line: str) -> None:
    """Print what takes long."""
    click.echo(f"skybake: {line}", err=True)
