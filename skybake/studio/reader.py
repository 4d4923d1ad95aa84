"""What the studio asks of a command line: to read knobs, and to say what they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from typing import Any, Protocol

from skybake.ephemeris.place import Place
from skybake.errors import InputError
from skybake.image.picture_settings import PictureSettings
from skybake.image.settings import MapSettings
from skybake.optics.changes import PresetChanges
from skybake.preset import Planet
from skybake.studio.state import State


class OptionError(InputError):
    """A text that an option does not take.

    Attributes
    ----------
    option : str or None
        Its long name without dashes, if it is known.
    """

    def __init__(self, message: str, option: str | None = None) -> None:
        super().__init__(message)
        self.option = option


@dataclass(frozen=True)
class Request:
    """A map as knobs ask for it.

    Attributes
    ----------
    planet : Planet
        The world, with its changes.
    settings : MapSettings
        Of the map.
    picture : PictureSettings
        How it is shown.
    preset : str
        As it is typed.
    changes : PresetChanges
        What is changed of it.
    attributes : mapping of str to Any, or None
        What files state of time and place.
    has_preview : bool
        Whether the command writes a picture beside the map.
    """

    planet: Planet
    settings: MapSettings
    picture: PictureSettings
    preset: str
    changes: PresetChanges
    attributes: Mapping[str, Any] | None = None
    has_preview: bool = False


@dataclass(frozen=True)
class DayRequest:
    """A day at a place.

    Attributes
    ----------
    place : Place
        Where the sun is seen from.
    day : date or None
        By the local clock; None in a season of Mars.
    zone : str or None
        Time zone of the clock; None is mean solar time.
    solar_longitude : float or None
        Season of Mars. [rad]
    refraction : bool or None
        As of `skybake.sun_at`.
    altitude : float
        Of the observer above the ground. [km]
    """

    place: Place
    day: date | None
    zone: str | None = None
    solar_longitude: float | None = None
    refraction: bool | None = None
    altitude: float = 0.0


class Reader(Protocol):
    """Reads knobs as a command line reads its options.

    All of it raises an `OptionError`, or another `SkybakeError`, with the message of the command
    line for what that refuses.
    """

    def described(self) -> dict[str, Any]:
        """Return the groups of options, and the display transforms, as the page gets them."""

    def words(self, state: State, output: str | None = None) -> list[str]:
        """Return the words of the command line that bakes the map."""

    def read(self, state: State) -> Request:
        """Read all options together."""

    def read_one(self, option: str, text: str) -> dict[str, Any]:
        """Return the value of one option, and its text in the usual form."""

    def day(self, texts: Mapping[str, str]) -> DayRequest:
        """Read the options of a day: where, when, and by which clock."""

    def is_same_world(self, state: State, other: State) -> bool:
        """Whether two states that are not read yet have the same atmosphere for certain."""

    def check_preset(self, preset: str) -> None:
        """Refuse a preset of a file that may not be read."""
