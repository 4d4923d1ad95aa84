"""Errors that a user can cause, each with a one-line message.

A message reads *where: what must hold, got value*. The command line prints it
on stderr and exits with status 1.
"""

from __future__ import annotations


class SkybakeError(Exception):
    """A fault in what the user gave or in where the result should go."""


class PresetError(SkybakeError, ValueError):
    """A preset cannot be found, read, or breaks a rule of physics or grammar."""


class OutputError(SkybakeError, OSError):
    """A file cannot be written whole; nothing is left under its name."""


class InputError(SkybakeError, ValueError):
    """A value or an input file lies outside what skybake can work with."""
