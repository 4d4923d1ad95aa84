"""The program: ``skybake`` and ``python -m skybake``."""

from __future__ import annotations

import os
import sys
from typing import NoReturn

_INTERRUPTED = 130


def run() -> NoReturn:
    """Import and run the command line, either of which an interrupt ends without a traceback."""
    try:
        from skybake.cli import run as run_command_line

        run_command_line()
    except KeyboardInterrupt:
        sys.stderr.write("skybake: interrupted\n")
        sys.stderr.flush()
        os._exit(_INTERRUPTED)


if __name__ == "__main__":
    run()
