"""How thick an atmosphere Hillaire's closure can be trusted with."""

from __future__ import annotations

from skybake.errors import TooThickError
from skybake.optics.medium import Medium, vertical_columns

TRUSTED_DEPTH = 1.0
"""Vertical optical depth of scattering, where it is least, up to which the sky is up to a third
too dark: at 0.9, a visibility of 5 km on Earth, by 40 %."""

MOST_DEPTH = 3.0
"""Beyond, hardly a tenth of the light is left; at 4.9, a visibility of 1 km, a sixtieth."""


def check_closure(medium: Medium) -> None:
    """Refuse an atmosphere in which the closure's light is no guide at all.

    Raises
    ------
    TooThickError
        If its optical depth is above `MOST_DEPTH`.
    """
    depth = _least_depth(medium)
    if depth > MOST_DEPTH:
        raise TooThickError(
            f"Hillaire's closure: optical depth of the atmosphere must be at most {MOST_DEPTH:g}, "
            f"got {depth:.3g}"
        )


def closure_warning(medium: Medium) -> str | None:
    """Say that the closure is too dark in an atmosphere, or return None if it is not."""
    depth = _least_depth(medium)
    if depth <= TRUSTED_DEPTH:
        return None
    return (
        f"Hillaire's closure leaves the sky too dark, by a third and more, at an optical depth of "
        f"{depth:.3g}; use the method full"
    )


def _least_depth(medium: Medium) -> float:
    """Vertical optical depth of scattering at the wavelength where it is least."""
    return float((vertical_columns(medium) @ medium.scattering).min())
