"""Errors that a user can cause, each with a one-line message.

A message reads *where: what must hold, got value*. The command line prints it
on stderr and exits with status 1.
"""

from __future__ import annotations


class SkybakeError(Exception):
    """A fault in what the user gave or in where the result should go."""


class PresetError(SkybakeError, ValueError):
    """A preset cannot be found, read, or breaks a rule of physics or grammar.

    Parameters
    ----------
    *faults : str
        All that is wrong, a line each; the error's own message is the first of them.

    Attributes
    ----------
    faults : tuple of str
        The same.
    """

    def __init__(self, *faults: str) -> None:
        more = len(faults) - 1
        hint = f" (and {more} more, see 'skybake presets check')" if more > 0 else ""
        super().__init__(f"{faults[0]}{hint}")
        self.faults = faults


class PresetWarning(UserWarning):
    """A preset is usable, but not quite as it was written."""


class OutputError(SkybakeError, OSError):
    """A file cannot be written whole; nothing is left under its name."""


class CancelledError(Exception):
    """Work was given up because somebody asked for that; no fault."""


class InputError(SkybakeError, ValueError):
    """A value or an input file lies outside what skybake can work with."""


class TooThickError(InputError):
    """An atmosphere is optically too thick for all orders of scattering to be solved for."""
