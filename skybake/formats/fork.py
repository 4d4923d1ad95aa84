"""Threads of OpenEXR in processes that are forked.

A forked process has none of its parent's threads, but its copy of OpenEXR counts on them and
would wait for them for ever. So they end before a fork, and start anew on either side when the
next file is opened.
"""

from __future__ import annotations

import os

import OpenImageIO

_BY_CPUS, _NONE = 0, -1


def end_threads_before_forks() -> None:
    """Make files of OpenImageIO usable in processes that are forked from now on."""
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(
            before=_end_threads, after_in_parent=_allow_threads, after_in_child=_start_over
        )


def _end_threads() -> None:
    OpenImageIO.attribute("exr_threads", _NONE)
    # The number is looked at where a file is opened for writing.
    output = OpenImageIO.ImageOutput.create("exr")
    if output is not None and output.open(os.devnull, OpenImageIO.ImageSpec(1, 1, 1, "half")):
        output.close()
        output.geterror()


def _allow_threads() -> None:
    OpenImageIO.attribute("exr_threads", _BY_CPUS)


def _start_over() -> None:
    _allow_threads()
    # OpenImageIO's own threads cannot be ended, only left unused.
    OpenImageIO.attribute("threads", 1)
