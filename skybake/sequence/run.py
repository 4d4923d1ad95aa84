"""Bakes frames, and reports those that fail."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

from skybake.errors import SkybakeError
from skybake.image.picture import picture_ev
from skybake.image.picture_settings import PictureSettings
from skybake.image.scene import Scene
from skybake.sequence.frame import FrameOutcome
from skybake.sequence.plan import Frame, Plan
from skybake.sequence.pool import Run
from skybake.sky.sky import Sky


@dataclass(frozen=True)
class FrameEvent:
    """Progress of one frame.

    Attributes
    ----------
    frame : Frame
        Which.
    kind : {"baked", "skipped", "failed", "retried"}
        A frame that is retried has failed and will be tried again.
    done, total : int
        Frames that are baked, skipped or failed so far, and the total.
    message : str
        Why it failed.
    """

    frame: Frame
    kind: Literal["baked", "skipped", "failed", "retried"]
    done: int
    total: int
    message: str = ""


@dataclass(frozen=True)
class SequenceResult:
    """Result of a sequence.

    Attributes
    ----------
    outcomes : tuple of FrameOutcome
        Frames that are done, by ascending number.
    failures : dict of int to str
        Why the others failed, by number.
    """

    outcomes: tuple[FrameOutcome, ...]
    failures: dict[int, str]


def bake_frames(
    plan: Plan,
    run: Run,
    *,
    retries: int = 0,
    tell: Callable[[FrameEvent], None] = lambda _: None,
    keep: Callable[[FrameOutcome], FrameOutcome] = lambda outcome: outcome,
) -> SequenceResult:
    """Bake the frames of a plan.

    Parameters
    ----------
    plan : Plan
        The sequence.
    run : Run
        What bakes frames, as `skybake.sequence.pool.local_pool`.
    retries : int, optional
        How often a frame that failed is tried again, after all others.
    tell : callable, optional
        Called with each `FrameEvent`.
    keep : callable, optional
        Called with each `FrameOutcome`, returns what of it is kept until the end.
    """
    outcomes: list[FrameOutcome] = []
    failures: dict[int, str] = {}
    waiting = plan.frames
    total = len(waiting)
    done = 0
    for attempt in range(retries + 1):
        failed = []
        for frame, outcome in run(waiting):
            message = ""
            kind: Literal["baked", "skipped", "failed", "retried"]
            if isinstance(outcome, FrameOutcome):
                kind = "baked" if outcome.is_new else "skipped"
                outcomes.append(keep(outcome))
                failures.pop(frame.number, None)
            else:
                kind = "failed" if attempt == retries else "retried"
                failed.append(frame)
                failures[frame.number] = message = _message(outcome)
            done += kind != "retried"
            tell(FrameEvent(frame, kind, done, total, message))
        waiting = tuple(sorted(failed, key=lambda frame: frame.number))
        if not waiting:
            break
    outcomes.sort(key=lambda outcome: outcome.number)
    return SequenceResult(tuple(outcomes), dict(sorted(failures.items())))


def prepare(plan: Plan, notice: Callable[[str], None] | None = None) -> None:
    """Build the tables that all frames share, on all CPUs; otherwise each frame builds its own.

    Parameters
    ----------
    plan : Plan
        The sequence.
    notice : callable, optional
        Called with a human-readable line when something takes long that later runs need not repeat.
    """
    missing = [sky for sky in _skies(plan) if not sky.is_solved]
    if not missing:
        return
    if notice is not None:
        times = "once" if len(missing) == 1 else f"{len(missing)} times"
        notice(f"solving for the light in this atmosphere, {times}")
    if len(plan.planets) == 1:
        _ = missing[0].atmosphere


def _skies(plan: Plan) -> Iterator[Sky]:
    lighting = plan.frames[0].settings.lighting
    for planet in plan.planets:
        yield Sky(planet, lighting.sun_elevation, method=lighting.method)


def common_ev(plan: Plan, picture: PictureSettings) -> float:
    """Exposure value for all pictures of a sequence: that of the frame with the highest sun."""
    frame = plan.highest_sun()
    return picture_ev(Scene(plan.planet(frame), frame.settings), picture)


def _message(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text if isinstance(error, SkybakeError) else f"{type(error).__name__}: {text}"
