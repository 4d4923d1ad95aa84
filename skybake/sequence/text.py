"""What may stand in a line of text that another program reads."""

from __future__ import annotations

import re

# Control characters, and the halves of pairs that stand for bytes that are no UTF-8.
_UNFIT = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff]")


def is_plain_line(text: str) -> bool:
    """Whether a text is valid Unicode, on one line and without control characters."""
    return _UNFIT.search(text) is None
