"""What a check of a map found."""

from __future__ import annotations

from typing import NamedTuple


class Finding(NamedTuple):
    """One of the findings.

    Attributes
    ----------
    check : str
        What was looked at, as "nan" or "wrap".
    is_wrong : bool
        Whether it is a fault, or only worth knowing.
    text : str
        What was found, in one line.
    """

    check: str
    is_wrong: bool
    text: str
