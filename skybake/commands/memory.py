"""The memory that a process may use."""

from __future__ import annotations

import sys

from skybake.errors import InputError

LEAST = 1 << 30
"""Address space below which libraries abort the process instead of reporting an error. [byte]"""


def memory_limit() -> int | None:
    """Address space that this process may use, if it is limited. [byte]"""
    if sys.platform == "win32":
        return None
    # Absent on Windows.
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return None if limit == resource.RLIM_INFINITY else limit


def memory_text() -> str:
    """Return how much memory there is, for messages."""
    limit = memory_limit()
    return "the system has no more" if limit is None else f"the limit is {limit >> 20} MB"


def check_memory() -> None:
    """Refuse to start what would be aborted later.

    Raises
    ------
    InputError
        If the limit of this process is lower than any map needs.
    """
    limit = memory_limit()
    if limit is not None and limit < LEAST:
        raise InputError(
            f"memory: skybake needs at least {LEAST >> 30} GB of address space ({memory_text()})"
        )
