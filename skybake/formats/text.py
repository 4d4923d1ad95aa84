"""Characters that a line of text for another program may contain."""

from __future__ import annotations

import re

# Control characters, and the surrogates that encode bytes that are not UTF-8.
_UNFIT = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff]")


def is_plain_line(text: str) -> bool:
    """Whether a text is valid Unicode, on one line and without control characters."""
    return _UNFIT.search(text) is None
