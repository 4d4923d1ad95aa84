"""Values of options: how they are read, and what they may be.

The choices repeat those of the engine, because help and completion must not wait
for the engine's imports; a test holds both lists to each other.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path

import click

from skybake.errors import InputError
from skybake.units import parse_angle, parse_length

PROJECTIONS = ("equirect", "cubemap")
CUBE_LAYOUTS = ("faces", "cross", "exr")
COLOUR_SPACES = ("lin_rec709", "acescg", "lin_rec2020", "lin_p3d65", "aces2065-1", "xyz")
UNITS = ("ev15", "nits")
PIXELS = ("auto", "half", "float")
SUN_DISCS = ("include", "exclude", "only")
METHODS = ("hillaire", "march")
VIEWS = ("aces2", "aces1")

_Context = click.Context | None
_Parameter = click.Parameter | None


class Quantity(click.ParamType):
    """A number with a unit, within bounds.

    Parameters
    ----------
    name : str
        As help shows it.
    parse : callable
        From text to the unit that the engine works in; raises InputError.
    low, high : float
        Bounds, in the engine's unit.
    rule : str
        The bounds in words.
    """

    def __init__(
        self,
        name: str,
        parse: Callable[[str], float],
        low: float = -math.inf,
        high: float = math.inf,
        rule: str = "",
    ) -> None:
        self.name = name
        self._parse = parse
        self._low = low
        self._high = high
        self._rule = rule

    def convert(self, value: str, param: _Parameter, ctx: _Context) -> float:
        """Read and check a value."""
        try:
            number = self._parse(value)
        except InputError as error:
            self.fail(str(error), param, ctx)
        if not self._low <= number <= self._high:
            self.fail(f"must be {self._rule}, got {value}", param, ctx)
        return number


BEARING = Quantity("angle", parse_angle)
# The tolerance is for 5400arcmin, which is 90deg but for the last bit.
_RIGHT_ANGLE = math.pi / 2 + 1e-9
ELEVATION = Quantity("angle", parse_angle, -_RIGHT_ANGLE, _RIGHT_ANGLE, "from -90deg to 90deg")
ALTITUDE = Quantity("length", parse_length, 0.0, rule="at least 0m, the ground")


class Size(click.ParamType):
    """Width and height, or the edge of a square: ``4096x2048``, ``1024``."""

    name = "size"

    def convert(
        self, value: str | tuple[int, ...], param: _Parameter, ctx: _Context
    ) -> tuple[int, ...]:
        """Read one or two whole numbers."""
        if isinstance(value, tuple):
            return value
        if not re.fullmatch(r"\d{1,9}(x\d{1,9})?", value, re.ASCII):
            self.fail(
                f"must be 4096x2048 for equirect or 1024 for a cubemap, got {value!r}", param, ctx
            )
        return tuple(int(number) for number in value.split("x"))


class ExposureValue(click.ParamType):
    """An exposure value, or ``auto``, which becomes None."""

    name = "auto|N"

    def convert(
        self, value: str | float | None, param: _Parameter, ctx: _Context
    ) -> float | None:
        """Read ``auto`` or a finite number."""
        if value is None or value == "auto":
            return None
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not -30.0 <= number <= 40.0:
            self.fail(f"must be auto or a number from -30 to 40, got {value!r}", param, ctx)
        return number


EV = ExposureValue()


class FilePath(click.ParamType):
    """The path of a file with one of some suffixes.

    Parameters
    ----------
    *suffixes : str
        Lower case, with their dots.
    """

    name = "file"

    def __init__(self, *suffixes: str) -> None:
        self._suffixes = suffixes

    def convert(self, value: str | Path, param: _Parameter, ctx: _Context) -> Path:
        """Check the suffix."""
        path = Path(value)
        if path.suffix.lower() not in self._suffixes:
            known = " or ".join(self._suffixes)
            self.fail(f"{path}: suffix must be {known}, got {path.suffix!r}", param, ctx)
        return path

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[click.shell_completion.CompletionItem]:
        """Leave it to the shell to complete files."""
        return [click.shell_completion.CompletionItem(incomplete, type="file")]
