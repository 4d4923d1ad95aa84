"""One request of a view, from the knobs to the messages with its pictures."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from threading import Event, Lock
from typing import Any

from skybake.errors import CancelledError, InputError, SkybakeError
from skybake.image.layers import Pixels
from skybake.image.settings import Encoding, MapSettings
from skybake.projection import Equirect, Projection
from skybake.studio.figures import exposures, figures_of
from skybake.studio.frames import LARGEST_WIDTH, coarse, halves, message, picture
from skybake.studio.reader import OptionError, Reader, Request
from skybake.studio.scenes import (
    SOLVING,
    Scenes,
    equirect_settings,
    planet_settings,
    prepare,
    solve,
)
from skybake.studio.state import State, state_from_json

Send = Callable[[dict[str, Any] | bytes], None]
"""Called from another thread with each answer."""

KINDS = ("equirect", "planet")
SMALLEST = 16


class Cancel(Event):
    """Stops work, but not what is kept of it once it is finished."""

    def __init__(self) -> None:
        super().__init__()
        self._finishing = Lock()
        self._is_finished = False

    def set(self) -> None:
        """Stop the work, if it is not finished."""
        with self._finishing:
            if not self._is_finished:
                super().set()

    def finish(self) -> bool:
        """Let nothing stop it any more; returns whether nothing has."""
        with self._finishing:
            self._is_finished = not self.is_set()
            return self._is_finished


@dataclass
class ViewRequest:
    """What a page asks to see, and how far its answer is.

    Attributes
    ----------
    number : int
        By which the page knows the answer.
    state : State
        What the knobs are set to.
    kind : {"equirect", "planet"}
        The whole sky, or the planet from afar.
    size : tuple of int
        Width and height. [pixel]
    cancel : Cancel
        Stops the work.
    superseded : threading.Event
        Set when there is a newer request.
    is_slow : bool
        Whether it is at work that takes long, or already refines: a newer request then stops it,
        and else waits for the coarse picture, so that a picture follows a moving knob.
    is_solving : bool
        Whether that work is the atmosphere, which a newer request may need as well.
    """

    number: int
    state: State
    kind: str
    size: tuple[int, int]
    cancel: Cancel = field(default_factory=Cancel)
    superseded: Event = field(default_factory=Event)
    is_slow: bool = False
    is_solving: bool = False

    def supersede(self, *, has_same_world: bool) -> None:
        """Give way to a newer request as soon as that serves it."""
        self.superseded.set()
        if self.is_slow and not (self.is_solving and has_same_world):
            self.cancel.set()

    def enter_slow(self) -> None:
        """Tell that what follows takes long.

        Raises
        ------
        CancelledError
            If there is a newer request.
        """
        self.is_slow = True
        if self.superseded.is_set():
            raise CancelledError("cancelled")


def view_request(data: dict[str, Any], number: int) -> ViewRequest:
    """Read a request.

    Raises
    ------
    InputError
        If it is no request of a view.
    """
    view = data.get("view", {})
    kind = view.get("kind", "equirect") if isinstance(view, dict) else view
    if kind not in KINDS:
        raise InputError(f"view: must be one of {', '.join(KINDS)}, got {kind!r}")
    size = view.get("size", [1024, 512])
    is_pair = isinstance(size, list) and len(size) == 2
    if not is_pair or not all(type(one) is int and one >= SMALLEST for one in size):
        raise InputError(f"view: size must be two whole numbers from {SMALLEST}, got {size!r}")
    width, height = size
    if max(width, height) > LARGEST_WIDTH or (kind == "equirect" and width != 2 * height):
        raise InputError(
            f"view: size must be at most {LARGEST_WIDTH} and of an equirect view 2:1, got {size!r}"
        )
    return ViewRequest(number, state_from_json(data.get("state", {})), kind, (width, height))


def answer(view: ViewRequest, reader: Reader, scenes: Scenes, send: Send) -> None:
    """Answer a request, in a thread that may take its time; errors become answers too."""
    try:
        _answer(view, reader, scenes, send)
    except CancelledError:
        send({"id": view.number, "cancelled": True})
    except SkybakeError as error:
        option = error.option if isinstance(error, OptionError) else None
        send({"id": view.number, "error": str(error), "option": option})
    except Exception as error:  # noqa: BLE001 - the page is told, the server goes on
        send({"id": view.number, "error": f"view: failed unexpectedly ({error!r})"})


def _answer(view: ViewRequest, reader: Reader, scenes: Scenes, send: Send) -> None:
    if view.cancel.is_set():
        raise CancelledError("cancelled")
    request = reader.read(view.state)
    settings, projection = _seen(view, request)
    header = {
        "id": view.number,
        "kind": view.kind,
        "channels": 3,
        "type": "float16",
        "command": shlex.join(reader.words(view.state)),
    }

    def show(pixels: Pixels, figures: dict[str, Any], *, is_final: bool) -> None:
        height, width = pixels.shape[:2]
        texels, factor = halves(pixels)
        scale = factor * Encoding().white_luminance
        sized = {"width": width, "height": height, "scale": scale, "final": is_final}
        lit = {**figures, **exposures(figures, request.picture, scale)}
        send(message({**header, **sized, "figures": lit}, texels))

    def tell(name: str, share: float | None) -> None:
        send({"id": view.number, "stage": name, "progress": share})

    def stage(name: str, share: float | None) -> None:
        view.enter_slow()
        view.is_solving = name == SOLVING
        tell(name, share)

    finished = scenes.finished(request, settings)
    if finished is not None and finished.pixels.shape[1::-1] == view.size:
        show(finished.pixels, figures_of(finished.scene, request.picture), is_final=True)
        return
    if finished is None:
        scene = scenes.scene(request, settings, view.cancel, partial(tell, SOLVING))
        solve(scene, stage)
        first = scenes.first_glance(request, scene, view.cancel)
        prepare(first, stage)
    else:
        first = scene = finished.scene
    figures = figures_of(first, request.picture)
    glance = coarse(projection)
    if glance is not None:
        show(picture(first, glance), figures, is_final=False)
        view.enter_slow()
    if first is not scene:
        prepare(scene, stage)
        figures = figures_of(scene, request.picture)
    pixels = picture(scene, projection)
    # First of all, since a page that has its picture may at once ask for it otherwise.
    if view.cancel.finish():
        scenes.keep(request, scene, pixels)
    show(pixels, figures, is_final=True)


def _seen(view: ViewRequest, request: Request) -> tuple[MapSettings, Projection]:
    if view.kind == "planet":
        settings = planet_settings(request, view.size)
        return settings, settings.view.projection
    return equirect_settings(request), Equirect(view.size[0])
