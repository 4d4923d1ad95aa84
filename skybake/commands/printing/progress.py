"""Progress while maps are baked: on terminals, in logs and for farms."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.printing.notices import notice

if TYPE_CHECKING:
    from skybake.sequence.run import FrameEvent

_STEPS = 1000

_LABELS = {"pixels": "baking"}
"""What a bar calls a stage by another name."""

STYLES = ("auto", "bar", "plain", "openjd", "none")


class MapProgress:
    """Shows a map's stage and the share of its pixels that is done.

    Parameters
    ----------
    bar : click progress bar
        On the terminal.
    """

    def __init__(self, bar: Any) -> None:
        self._bar = bar

    def __call__(self, share: float) -> None:
        """Show the share of the pixels that is done."""
        self._bar.update(round(share * _STEPS) - self._bar.pos)

    def begin(self, stage: str) -> None:
        """Show the stage that begins."""
        self._bar.label = _LABELS.get(stage, stage)
        self._bar.render_progress()


@contextmanager
def map_progress(*, quiet: bool) -> Iterator[MapProgress | None]:
    """Yield what shows the progress of a map, or None without a terminal."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    with click.progressbar(length=_STEPS, label=_LABELS["pixels"], file=sys.stderr) as bar:
        yield MapProgress(bar)


class FrameProgress:
    """Reports frames as they are done.

    Parameters
    ----------
    style : {"bar", "plain", "openjd", "none"}
        A bar, a line for each frame on standard error, or lines of the Open Job
        Description on standard output.
    bar : click progress bar, optional
        For the style of this name.
    """

    def __init__(self, style: str, bar: Any = None) -> None:
        self._style = style
        self._bar = bar
        self._started = time.perf_counter()
        self._baked = 0

    def __call__(self, event: FrameEvent) -> None:
        """Report one frame."""
        self._baked += event.kind == "baked"
        if self._style == "bar":
            self._bar.update(event.done - self._bar.pos, self._speed(event).partition(", ")[2])
        elif self._style == "plain":
            notice(self._line(event))
        elif self._style == "openjd":
            click.echo(f"openjd_progress: {100.0 * event.done / event.total:.1f}")
            click.echo(f"openjd_status: {self._line(event)}")

    def _line(self, event: FrameEvent) -> str:
        news = f"{event.kind} {event.frame.output}"
        if event.message:
            return f"{event.done}/{event.total} {news}: {event.message}"
        return f"{event.done}/{event.total} {news}{self._speed(event)}"

    def _speed(self, event: FrameEvent) -> str:
        """Frames per second and remaining time; empty as long as all frames are skipped."""
        if not self._baked:
            return ""
        rate = self._baked / (time.perf_counter() - self._started)
        left = event.total - event.done
        return f", {rate:.1f} frames/s" + (f", {left / rate:.0f} s left" if left else "")


@contextmanager
def frame_progress(style: str, total: int, *, quiet: bool) -> Iterator[FrameProgress]:
    """Yield what reports frames; ``auto`` is a bar on a terminal and lines elsewhere."""
    if style == "auto":
        style = "none" if quiet else "bar" if sys.stderr.isatty() else "plain"
    if style != "bar":
        yield FrameProgress(style)
        return
    with click.progressbar(
        length=total,
        label="baking",
        file=sys.stderr,
        item_show_func=lambda speed: speed,
        show_eta=False,
        show_percent=False,
        show_pos=True,
    ) as bar:
        yield FrameProgress(style, bar)
