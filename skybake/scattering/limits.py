"""What of an atmosphere the solver can hold, told before it begins."""

from __future__ import annotations

from skybake.errors import TooThickError, UnsolvableError
from skybake.optics.delta_m import ScaledMedium
from skybake.scattering.grid import thickest_depth

MAX_DEPTH = 30.0
"""Vertical optical depth up to which the solution is good: where nothing is absorbed, 2 % of
the light that reaches the ground at depth 10, 6 % at depth 30."""

MAX_PEAK = 0.45
"""Share of the light that a forward peak may hold; Henyey and Greenstein's at asymmetry 0.948.
Of larger ones the peak's restoration by depth leaves negative light beside the sun."""

MAX_LAST_MOMENT = 0.05
"""Size of the last moment that stays. A backward peak, whose moments change sign from order to
order, cannot be truncated: where its series ends in the midst the diffuse field swings below 0;
Henyey and Greenstein's does so in twilight at asymmetry -0.85, where this moment is 0.10."""


def check_medium(scaled: ScaledMedium) -> None:
    """Refuse a medium in which all orders of scattering cannot be solved for.

    Raises
    ------
    TooThickError
        If its vertical optical depth is above `MAX_DEPTH` at any wavelength.
    UnsolvableError
        If a phase function has a forward peak or a backward one that is too strong.
    """
    depth = thickest_depth(scaled.medium)
    if depth > MAX_DEPTH:
        raise TooThickError(
            "multiple scattering: optical depth of the atmosphere without forward peaks must be "
            f"at most {MAX_DEPTH:g} at every wavelength, got {depth:.3g}"
        )
    lit = scaled.medium.scattering.max(axis=1) > 0.0
    peak = float(scaled.fraction[lit].max(initial=0.0))
    if peak > MAX_PEAK:
        raise UnsolvableError(
            f"multiple scattering: forward peak of a phase function, its moment of order "
            f"{scaled.moments.shape[1]}, must be at most {MAX_PEAK:g}, got {peak:.3g}"
        )
    last = float(abs(scaled.moments[lit, -1]).max(initial=0.0))
    if last > MAX_LAST_MOMENT:
        raise UnsolvableError(
            f"multiple scattering: backward peak of a phase function, its moment of order "
            f"{scaled.moments.shape[1] - 1}, must be at most {MAX_LAST_MOMENT:g}, got {last:.3g}"
        )
