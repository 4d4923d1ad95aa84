"""What holds for options of any subject: how they are added, and when they are refused.

Options are named like the arguments of the functions that take their values, so that an
error in an argument can be reported as one in the option.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TypeVar

import click
from click.core import ParameterSource

from skybake.errors import ArgumentError

Command = TypeVar("Command", bound=Callable[..., Any])
Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

Needs = Mapping[str, tuple[bool, str]]
"""By the name of an option: whether it has an effect with the others, and if not, why."""


def options_together(*options: Decorator) -> Callable[[Command], Command]:
    """Return one decorator that adds options in the order of the help."""

    def add(command: Command) -> Command:
        decorated: Any = command
        for option in reversed(options):
            decorated = option(decorated)
        added: Command = decorated
        return added

    return add


def some_of(options: Decorator, *names: str) -> Iterator[Decorator]:
    """Yield those options of several that have some names, in the order of the help."""
    command = click.command()(options(lambda **_: None))
    for option in command.params:
        if option.name in names:
            yield click.option(cls=_same(option))


def _same(option: click.Parameter) -> Any:
    return lambda *_, **__: option


def is_given(context: click.Context, name: str) -> bool:
    """Whether an option was typed."""
    return context.get_parameter_source(name) is not ParameterSource.DEFAULT


def check_needs(context: click.Context, *all_needs: Needs) -> None:
    """Refuse options that would have no effect with the others.

    Raises
    ------
    click.UsageError
        That names the first of them, in the order of the help.
    """
    names = option_names(context)
    for name, option in names.items():
        for needs in all_needs:
            is_fine, problem = needs.get(name, (True, ""))
            if not is_fine and is_given(context, name):
                raise click.UsageError(f"{option}: {problem}")


def option_names(context: click.Context) -> dict[str, str]:
    """Return the long form of each option by its name."""
    return {
        parameter.name or "": max(parameter.opts, key=len) for parameter in context.command.params
    }


@contextmanager
def usage_faults(context: click.Context, **others: str) -> Iterator[None]:
    """Report errors in arguments as wrong usage of the options of the same names.

    Parameters
    ----------
    context : click.Context
        With the options.
    **others : str
        Options for arguments of other names.
    """
    try:
        yield
    except ArgumentError as error:
        raise click.UsageError(error.text(option_names(context) | others)) from error
