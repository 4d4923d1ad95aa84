"""Content behind a digest of itself and of what it is for.

What was truncated, damaged, or stored under a name that is not its own has another
digest, and is made anew instead of being used. The digest is not a signature: who may write
the files is checked by `skybake.jit.private_folder`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence

_SIZE = hashlib.sha256().digest_size


def add_digest(content: bytes, purpose: str) -> bytes:
    """Return content behind a SHA-256 digest of its purpose and of itself.

    Parameters
    ----------
    content : bytes
        What is kept.
    purpose : str
        What it is for: whatever must be the same where it is used.
    """
    return b"".join(parts_with_digest([content], purpose))


def parts_with_digest(
    parts: Sequence[bytes | memoryview], purpose: str
) -> list[bytes | memoryview]:
    """Do what `add_digest` does for content in parts, none of which is copied."""
    return [_digest(parts, purpose), *parts]


def remove_digest(stored: bytes, purpose: str) -> memoryview | None:
    """Return the content of what `add_digest` made for a purpose; None if it is anything else."""
    content = memoryview(stored)[_SIZE:]
    return content if _digest([content], purpose) == stored[:_SIZE] else None


def _digest(parts: Iterable[bytes | memoryview], purpose: str) -> bytes:
    head = purpose.encode()
    digest = hashlib.sha256(len(head).to_bytes(8, "little") + head)
    for part in parts:
        digest.update(part)
    return digest.digest()
