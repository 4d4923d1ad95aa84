"""Values that change evenly over the frames of a sequence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Ramp:
    """A value that changes evenly from the first frame to the last.

    Attributes
    ----------
    first, last : float
        Equal if it is constant.
    """

    first: float
    last: float

    def at(self, share: float) -> float:
        """Value after a share of the way, exact at both ends."""
        return (1.0 - share) * self.first + share * self.last


def at_share(value: float | Ramp, share: float) -> float:
    """Value of what may change, after a share of the way."""
    return value.at(share) if isinstance(value, Ramp) else value


def shares(numbers: Sequence[int]) -> list[float]:
    """How far along each frame is from the first to the last, 0 to 1."""
    first, span = numbers[0], numbers[-1] - numbers[0]
    return [(number - first) / span if span else 0.0 for number in numbers]
