"""How messages repeat what the user gave."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

MAX_SHOWN = 60
"""Most characters of a value in a message."""


def shown(value: Any) -> str:
    """Value for a message: one line, cut where it gets long."""
    try:
        text = repr(value)
    except ValueError:  # Python refuses to print an integer of more than 4300 digits.
        return "an integer of thousands of digits"
    return text if len(text) <= MAX_SHOWN else f"{text[:MAX_SHOWN]}..."


def nearest(word: str, known: Iterable[str]) -> str:
    """Known words similar to a word, the most similar first; empty if none is."""
    return ", ".join(get_close_matches(word, list(known), n=3, cutoff=0.6))
