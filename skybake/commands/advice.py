"""Advice on what else a user can try, after an error message."""

from __future__ import annotations

from skybake.errors import SkybakeError, UnsolvableError


def advised(error: SkybakeError) -> str:
    """Return an error's message, and which options help if there are any."""
    if isinstance(error, UnsolvableError):
        return f"{error}; use probe --method reference"
    return str(error)
