"""A sequence as commands for other machines, instead of being baked here."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import values
from skybake.commands.options.clouds import absolute_layer
from skybake.commands.options.rules import Needs, options_together
from skybake.commands.options.world import read_value

if TYPE_CHECKING:
    from skybake.sequence.plan import Plan

_GIVEN = "skybake.commands.options.emit.given"

# Options that concern only the machine that collects the frames, or only this call.
_LEFT_OUT = {
    *("only", "emit_commands", "emit_openjd", "chunk_size", "dry_run", "as_json", "dask"),
    *("manifests", "contact_sheet", "animate", "fps", "style", "quiet"),
}
_OF_PREVIEWS = {"preview_ev", "white_balance", "shot", "view"}
_PATHS = {"camera", "output", "preview", "exposure_curve"}

HOW = frozenset({"skip_existing", "retry", "workers"})
"""Options that determine how frames are baked, not which."""


class RememberingCommand(click.Command):
    """A command that remembers its options as they were typed."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse, and keep the texts of the options."""
        ctx.meta[_GIVEN] = self.make_parser(ctx).parse_args(list(args))[0]
        return super().parse_args(ctx, args)


def remember(context: click.Context, name: str, text: str) -> None:
    """Replace the text of an option that was typed, if the command remembers any."""
    given = context.meta.get(_GIVEN, {})
    if name in given:
        given[name] = text


_CHUNK = 10

emit_options = options_together(
    click.option(
        "--emit-commands",
        is_flag=True,
        help="Print a command for each chunk of frames, for a farm or GNU parallel, and bake "
        "nothing.",
    ),
    click.option(
        "--emit-openjd",
        metavar="FOLDER",
        type=values.folder,
        help="Write an Open Job Description with a task for each chunk, and bake nothing.",
    ),
    click.option(
        "--chunk-size",
        metavar="N",
        type=click.IntRange(min=1),
        show_default=str(_CHUNK),
        help="Frames in a chunk.",
    ),
)


def is_asked(options: Mapping[str, Any]) -> bool:
    """Whether the options ask for commands."""
    return options["emit_commands"] or options["emit_openjd"] is not None


def emit_needs(options: Mapping[str, Any]) -> Needs:
    """Return what the options of emitted commands need, and which options they exclude."""
    emits = is_asked(options)
    return {
        "chunk_size": (emits, "needs --emit-commands or --emit-openjd"),
        "dry_run": (not emits, "cannot be combined with --emit-commands or --emit-openjd"),
    }


def emit(context: click.Context, plan: Plan) -> None:
    """Print or write the commands that the options ask for.

    Raises
    ------
    SkybakeError
        If a format cannot hold them, or a file cannot be written.
    """
    from skybake.sequence import farm, frames

    options = context.params
    numbers = [frame.number for frame in plan.frames]
    if options["only"] is not None:
        numbers = [number for number in numbers if number in set(options["only"])]
    given, size = command_from_options(context, plan), options["chunk_size"] or _CHUNK
    lines = farm.commands(given, frames.chunks(numbers, size))
    if options["emit_openjd"] is not None:
        name = "" if plan.output is None else plan.output.name
        words = [*given, "--progress=openjd"]
        template = farm.write_openjd(options["emit_openjd"], words, numbers, size, name)
        if not options["emit_commands"]:
            lines = [str(template)]
    for line in lines:
        click.echo(line)


def command_from_options(
    context: click.Context, plan: Plan, leave_out: Collection[str] = ()
) -> list[str]:
    """Return a command that bakes the same frames from any folder, without ``--only``.

    Parameters
    ----------
    context : click.Context
        With the options of ``skybake sequence``.
    plan : Plan
        What they ask for.
    leave_out : collection of str, optional
        Names of other options to leave out.
    """
    given: dict[str, Any] = context.meta[_GIVEN]
    left_out = _LEFT_OUT | set(leave_out)
    if "preview" not in given:
        # They were for the contact sheet, which is left out too.
        left_out |= _OF_PREVIEWS
    words = ["skybake", "sequence"]
    for parameter in context.command.params:
        name = parameter.name or ""
        if name in left_out or name not in given:
            continue
        option = max(parameter.secondary_opts if given[name] is False else parameter.opts, key=len)
        texts = given[name] if parameter.multiple else [given[name]]
        words += [_word(option, name, text) for text in texts]
    if "output" not in given and plan.output is not None:
        words.append(f"--output={plan.output.absolute()}")
    return words


def _word(option: str, name: str, value: Any) -> str:
    # Flags, and options whose value was omitted, have no text.
    if not isinstance(value, str):
        return option
    is_file = name == "preset" and (value.lower().endswith(".toml") or os.sep in value)
    if is_file or name in _PATHS:
        value = str(Path(value).absolute())
    elif name in {"changes", "ground_albedo"}:
        value = _with_absolute_file(value)
    elif name == "clouds":
        value = absolute_layer(value)
    return f"{option}={value}"


def _with_absolute_file(change: str) -> str:
    """Make the path of a user's file absolute in ``KEY=FILE`` or ``FILE``."""
    from skybake.preset.tables import is_user_file

    key, equals, value = change.rpartition("=")
    file = read_value(value.strip())
    # 3/8 of the sky is no path.
    is_cover = key.strip().endswith(".cover")
    if is_cover or not isinstance(file, str) or not is_user_file(file):
        return change
    return f"{key}{equals}{Path(file).absolute()}"
