"""Errors that a user can cause, each with a one-line message.

A message reads *where: what must hold, got value*. The command line prints it
on stderr and exits with status 1.
"""

from __future__ import annotations

from collections.abc import Mapping


class SkybakeError(Exception):
    """An error in the user's input or in the target of the result."""


class PresetError(SkybakeError, ValueError):
    """A preset cannot be found or read, or breaks a rule of physics or syntax.

    Parameters
    ----------
    *faults : str
        All errors, one line each; the message of the exception is the first of them.

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
    """A preset is usable, but not exactly as it was written."""


class OutputError(SkybakeError, OSError):
    """A file cannot be written completely; nothing is left under its name."""


class CancelledError(Exception):
    """Work was stopped on request; not an error."""


class InputError(SkybakeError, ValueError):
    """A value or an input file is outside what skybake can work with."""


class UnsolvableError(InputError):
    """All orders of scattering cannot be solved for in an atmosphere."""


class TooThickError(UnsolvableError):
    """An atmosphere is optically too thick for all orders of scattering to be solved for."""


class ArgumentError(InputError):
    """Arguments of a function cannot be used, alone or together.

    Parameters
    ----------
    problem : str
        The message, with names of arguments in braces, as
        ``{latitude}: needs {longitude} as well``.
    **values : object
        Values of the other names in braces.
    """

    def __init__(self, problem: str, /, **values: object) -> None:
        self._problem, self._values = problem, values
        super().__init__(self.text({}))

    def text(self, names: Mapping[str, str]) -> str:
        """Return the message with other names for the arguments, such as those of options."""
        return self._problem.format_map(_Names({**names, **self._values}))


class _Names(dict[str, object]):
    """Names that stand for themselves unless others are given."""

    def __missing__(self, name: str) -> str:
        return name
