"""Reads the knobs of the studio with the command line of ``skybake render`` itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.advice import advised
from skybake.commands.options import choices
from skybake.commands.options.described import (
    LEFT_OUT,
    described_groups,
    live_of,
    long_name,
    quantity_of,
)
from skybake.commands.options.files import check_within
from skybake.commands.options.place import day_from_options, place_from_options
from skybake.commands.options.previews import picture_from_options, preview_needs
from skybake.commands.options.times import moment_from_options
from skybake.commands.options.world import changes_from_options, world_from_options
from skybake.commands.render import render, requested_map
from skybake.errors import ArgumentError, InputError, SkybakeError
from skybake.jit.kept import Kept
from skybake.preset.find import is_path
from skybake.studio.reader import DayRequest, OptionError, Request
from skybake.studio.state import State, typed_texts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from skybake.preset import Planet

_OF_DAY = ("preset", "lat", "lon", "site", "ls", "tz", "date", "altitude", "refraction")
_KEPT_WORLDS = 8
_VIEW_TITLES = {"aces1": "ACES 1.3", "aces2": "ACES 2.0"}


class RenderReader:
    """Reads knobs as ``skybake render`` reads its options, within a folder.

    Parameters
    ----------
    folder : Path
        Out of which no file is read.
    preset : str, optional
        A preset that may be outside of it nonetheless.
    command : click.Command, optional
        Whose options there are.
    """

    def __init__(
        self, folder: Path, preset: str | None = None, command: click.Command = render
    ) -> None:
        self._folder = folder.resolve()
        self._preset = preset
        self._command = command
        self._options = {
            long_name(one): one
            for one in command.params
            if isinstance(one, click.Option) and one.name not in LEFT_OUT
        }
        self._worlds = _Worlds()
        self._of_worlds = [
            name for name, one in self._options.items() if live_of(one.name or "") == "solve"
        ]

    def described(self) -> dict[str, Any]:
        """Return the groups of options and the display transforms."""
        views = [{"name": name, "title": _VIEW_TITLES[name]} for name in choices.VIEWS]
        return {"groups": described_groups(self._command.params), "views": views}

    def words(self, state: State, output: str | None = None) -> list[str]:
        """Return the words of the command line that bakes the map."""
        words = ["skybake", self._command.name or "", *self._arguments(state)]
        return words if output is None else [*words, f"--output={output}"]

    def read(self, state: State) -> Request:
        """Read all options together."""
        with self._context(self._arguments(state)) as context:
            options = context.params
            requested = requested_map(context, self._worlds.load)
            moment = requested.moment
            return Request(
                requested.planet,
                requested.settings,
                picture_from_options({**options, "shot": None}, options["preview_ev"]),
                options["preset"],
                changes_from_options(context),
                None if moment is None else moment.attributes,
                self._has_looks(state),
            )

    def read_one(self, option: str, text: str) -> dict[str, Any]:
        """Return the value of one option, and its text in the usual form."""
        parameter = self._option(option)
        with _messages(option):
            value = _value(self._command, parameter, text)
        unit = quantity_of(parameter).unit
        number = None
        if isinstance(value, float) and unit in {"deg", "km"}:
            from skybake.units import degrees

            number = degrees(value) if unit == "deg" else value
        elif isinstance(value, int | float) and not isinstance(value, bool):
            number = value
        return {"value": number, "unit": unit, "text": text.strip()}

    def day(self, texts: Mapping[str, str]) -> DayRequest:
        """Read the options of a day: where, when, and by which clock."""
        state = State({name: texts[name] for name in _OF_DAY if texts.get(name)})
        arguments = [*self._arguments(state), "--time=noon"]
        if "date" not in state.options and "ls" not in state.options:
            arguments.append("--date=today")
        with self._context(arguments) as context:
            # Finds what is wrong with the place or the day, in the words of the options.
            moment_from_options(context)
            place = place_from_options(context, "--time")
            options = context.params
            return DayRequest(
                place,
                day_from_options(context, place),
                options["zone"],
                options["solar_longitude"],
                options["refraction"],
                options["altitude"],
            )

    def is_same_world(self, state: State, other: State) -> bool:
        """Whether two states that are not read yet have the same atmosphere for certain."""
        return state.changes == other.changes and all(
            state.options.get(name) == other.options.get(name) for name in self._of_worlds
        )

    def check_preset(self, preset: str) -> None:
        """Refuse a preset of a file that may not be read."""
        self._check_files(State({"preset": preset}))

    def _arguments(self, state: State) -> list[str]:
        self._check_files(state)
        for name in state.options:
            self._option(name)
        words = []
        for one in self._command.params:
            name = long_name(one)
            if name in state.options:
                words += _words(self._option(name), state.options[name])
            elif name == "set":
                words += [f"--set={key}={text}" for key, text in state.changes.items()]
        if self._has_looks(state):
            words.append("--preview")
        return words

    def _has_looks(self, state: State) -> bool:
        """Whether an option says how a preview looks, which needs one."""
        looks = preview_needs({"preview": None})
        return any((self._options[name].name or "") in looks for name in state.options)

    def _option(self, name: str) -> click.Option:
        if name not in self._options:
            raise OptionError(f"No such option: --{name}", name)
        return self._options[name]

    def _check_files(self, state: State) -> None:
        for name, text in typed_texts(state):
            if name != "preset" or text != self._preset:
                with _messages(name):
                    check_within(self._folder, name, text)
        for key, text in state.changes.items():
            check_within(self._folder, "set", f"{key}={text}")

    @contextmanager
    def _context(self, arguments: Sequence[str]) -> Iterator[click.Context]:
        with (
            _messages(None),
            self._command.make_context(self._command.name, list(arguments)) as context,
        ):
            yield context


class _Worlds:
    """Loads worlds, and keeps the last ones that consist of no user's file: those may change."""

    def __init__(self) -> None:
        self._kept: Kept[str, Planet] = Kept(_KEPT_WORLDS)

    def load(self, context: click.Context) -> Planet:
        """Return the world of the options."""
        preset = context.params["preset"]
        key = repr((preset, changes_from_options(context)))
        if self._kept.has(key):
            return self._kept.get(key, lambda: world_from_options(context))
        planet = world_from_options(context)
        if not is_path(preset) and "files" not in planet.recipe:
            self._kept.put(key, planet)
        return planet


def _value(command: click.Command, option: click.Option, text: str) -> Any:
    context = click.Context(command, info_name=command.name)
    try:
        return option.type_cast_value(context, [text] if option.multiple else text)
    except click.BadParameter as error:
        # The message names the option, as it does where the whole command line is parsed.
        error.ctx, error.param = context, option
        raise


def _words(option: click.Option, value: Any) -> list[str]:
    flag = max(option.opts, key=len)
    if isinstance(value, bool):
        if not option.is_flag:
            raise OptionError(f"Option '{flag}' requires an argument.", flag.lstrip("-"))
        if value:
            return [flag]
        return [max(option.secondary_opts, key=len)] if option.secondary_opts else []
    if option.is_flag:
        raise OptionError(f"Option '{flag}' does not take a value.", flag.lstrip("-"))
    texts = value if isinstance(value, tuple) else (value,)
    return [f"{flag}={text}" for text in texts]


@contextmanager
def _messages(option: str | None) -> Iterator[None]:
    """Raise what the command line would print as an `OptionError` of the same message."""
    try:
        yield
    except click.ClickException as error:
        parameter = getattr(error, "param", None)
        if parameter is not None:
            option = long_name(parameter)
        message = " ".join(error.format_message().split())
        raise OptionError(message, option or _named(message)) from error
    except OptionError:
        raise
    except (ArgumentError, InputError) as error:
        raise OptionError(" ".join(advised(error).split()), option or _named(str(error))) from error
    except SkybakeError as error:
        raise OptionError(" ".join(advised(error).split()), option) from error


def _named(message: str) -> str | None:
    """Return the option at the beginning of a message such as ``--time: ...``."""
    head = message.partition(":")[0].split(" ")[0]
    return head.lstrip("-") if head.startswith("--") else None
