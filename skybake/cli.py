"""The command line: commands, and errors as one line with an exit status."""

from __future__ import annotations

import os
import signal
import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import FrameType
from typing import Any, NoReturn

import click

from skybake.commands.advice import advised
from skybake.commands.memory import memory_text
from skybake.errors import SkybakeError
from skybake.formats.held_signals import wait_until_released
from skybake.version import __version__

FAILED = 1
INTERRUPTED = 130
ENDED_BY_SIGNAL = 128

_STANDARD_ERROR = 2
_RENAMED_WITHIN = 10.0

_ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))

_COMMANDS = (
    *("aerial", "cache", "chart", "check", "clouds", "convert", "ibl", "luts", "presets"),
    *("preview", "probe", "render", "sequence", "shot", "studio", "targets"),
)

# Message of the RuntimeError where a thread gets no stack or is not allowed.
_NO_THREAD = "can't start new thread"


class _EndedError(BaseException):
    """A signal, the argument, asks the process to end."""


class _CommandLine(click.Group):
    """A group whose errors are one line on stderr and an exit status.

    A command's module, of the same name, is imported when the command is called.
    """

    def list_commands(self, _ctx: click.Context) -> list[str]:
        """Return the names of all commands."""
        return list(_COMMANDS)

    def get_command(self, _ctx: click.Context, name: str) -> click.Command | None:
        """Return a command, or None if there is none of that name."""
        if name not in _COMMANDS:
            return None
        command: click.Command = getattr(import_module(f"skybake.commands.{name}"), name)
        return command

    def main(self, *args: Any, **kwargs: Any) -> NoReturn:
        """Parse, run and exit."""
        # Threads that numpy's linear algebra starts with cost more than they save here.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        kwargs["standalone_mode"] = False
        kwargs["prog_name"] = "skybake"
        ends_by_signal = False
        with warnings.catch_warnings(), _signals_raised():
            warnings.showwarning = _show_warning
            try:
                status = super().main(*args, **kwargs)
            except click.exceptions.NoArgsIsHelpError as error:
                error.show()
                status = error.exit_code
            except click.ClickException as error:
                status = _fail(error.format_message(), error.exit_code)
            except SkybakeError as error:
                status = _fail(advised(error), FAILED)
            except BrokenPipeError:
                # The reader of our output has closed it; Python cannot flush it at exit either.
                os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
                status = FAILED
            except click.Abort:
                status, ends_by_signal = _fail("interrupted", INTERRUPTED), True
            except _EndedError as error:
                status, ends_by_signal = _fail("terminated", ENDED_BY_SIGNAL + error.args[0]), True
            except MemoryError:
                status = _fail(f"memory: too little for this task ({memory_text()})", FAILED)
            except RuntimeError as error:
                if str(error) != _NO_THREAD:
                    raise
                limits = "too little memory, or too few processes allowed"
                status = _fail(f"threads: none can be started ({limits})", FAILED)
            except OSError as error:
                # Code that knows the file names it; this is a full disk below standard output.
                status = _fail(f"output: cannot be written ({error.strerror or error})", FAILED)
        if ends_by_signal:
            # Only now is the exception released, and with it what it kept alive.
            _exit_now(status)
        sys.exit(status or 0)


@contextmanager
def _signals_raised() -> Iterator[None]:
    """Raise signals that end a process as exceptions, so that no file is left half-written.

    Those that are ignored, as under nohup, or handled by a program that calls `main`,
    stay as they are.
    """
    raised = []
    if threading.current_thread() is threading.main_thread():
        raised = [number for number in _ENDING if signal.getsignal(number) is signal.SIG_DFL]
    for number in raised:
        signal.signal(number, _raise_ended)
    try:
        yield
    finally:
        for number in raised:
            signal.signal(number, signal.SIG_DFL)


def _raise_ended(number: int, _: FrameType | None) -> NoReturn:
    # Some programs send a signal twice, which must not interrupt the clean-up.
    signal.signal(number, signal.SIG_IGN)
    raise _EndedError(number)


def _fail(message: str, status: int) -> int:
    line = " ".join(message.split())
    click.echo(f"skybake: {line}", err=True)
    return status


def _exit_now(status: int) -> NoReturn:
    """Exit without waiting for threads, which may be compiling for seconds."""
    if threading.active_count() > 1:
        _leave(status)
    sys.exit(status)


def _leave(status: int) -> NoReturn:
    """End the process without the interpreter's clean-up, but not between two renames of a set."""
    wait_until_released(_RENAMED_WITHIN)
    for stream in sys.stdout, sys.stderr:
        try:
            if stream is not None:
                stream.flush()
        except OSError:
            status = status or FAILED
    os._exit(status)


def _open_standard_streams() -> None:
    """Open closed standard streams, so that no file to write takes their place."""
    while True:
        descriptor = os.open(os.devnull, os.O_RDWR)
        if descriptor > _STANDARD_ERROR:
            os.close(descriptor)
            break
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            mode = "w" if descriptor else "r"
            setattr(sys, name, os.fdopen(descriptor, mode, encoding="utf-8", closefd=False))


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    click.echo(f"skybake: warning: {' '.join(str(message).split())}", err=True)


@click.group(
    cls=_CommandLine,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, message="%(prog)s %(version)s")
def main() -> None:
    """Bake physically based HDR sky maps for any sun, altitude and planet.

    \b
    Examples:
      skybake render
      skybake render --sun 5deg --preset mars
      skybake presets list
      skybake preview earth_sun30.00deg_equirect.exr -o earth.png

    Exit status: 0 done, 1 failed, 2 wrong usage, 3 some frames failed, 130 interrupted,
    143 terminated.
    """


def run() -> NoReturn:
    """Run the command line as a process of its own.

    All files are closed by then, and the interpreter's clean-up of modules takes time: 0.2 s
    if numba is among them.
    """
    status: Any = 0
    _open_standard_streams()
    try:
        main()
    except SystemExit as leaving:
        status = leaving.code
    _leave(status or 0)
