"""What commands print of a picture that they wrote."""

from __future__ import annotations

from pathlib import Path


def picture_line(path: Path, ev: float, white: tuple[float, float] | None) -> str:
    """Return the file, its exposure and, if it is balanced, the xy of the light that is white."""
    line = f"{path}  exposed for EV {ev:.2f}"
    return line if white is None else f"{line}, white is xy {white[0]:.4f} {white[1]:.4f}"
