"""Files behind a digest of their content, whole or not at all.

Every file is a SHA-256 digest and what it is a digest of, so that what was cut short,
or comes from elsewhere, is made anew instead of being trusted.
"""

from __future__ import annotations

import hashlib
import uuid
from pathlib import Path

_DIGEST_SIZE = hashlib.sha256().digest_size


def seal(content: bytes) -> bytes:
    """Return content behind its digest."""
    return hashlib.sha256(content).digest() + content


def unseal(sealed: bytes) -> memoryview | None:
    """Return the content of what `seal` made, or None if it is not as it was made."""
    content = memoryview(sealed)[_DIGEST_SIZE:]
    return content if hashlib.sha256(content).digest() == sealed[:_DIGEST_SIZE] else None


def read_sealed(path: Path) -> memoryview | None:
    """Return the content of a file, or None if it is missing or not as it was written."""
    try:
        return unseal(path.read_bytes())
    except OSError:
        return None


def write_sealed(path: Path, content: bytes) -> None:
    """Write a file beside its name and rename it.

    Raises
    ------
    OSError
        If there is no room for it; nothing is left then.
    """
    temporary = path.with_name(f".{path.stem}-{uuid.uuid4().hex[:16]}{path.suffix}")
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        temporary.write_bytes(seal(content))
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
