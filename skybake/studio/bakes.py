"""Maps that the page asks to be baked at full size."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path, PurePosixPath, PureWindowsPath
from threading import Event
from typing import Any

from skybake.baking import default_path
from skybake.baking.checks import check_targets
from skybake.baking.paths import preview_beside
from skybake.baking.write import bake_scene
from skybake.errors import CancelledError, InputError, SkybakeError
from skybake.studio.reader import Reader, Request
from skybake.studio.scenes import SOLVING, Scenes
from skybake.studio.state import State

Tell = Callable[[dict[str, Any]], None]
"""Called from another thread with each message about a bake."""


class Bakes:
    """Bakes one map after the other into a folder.

    Parameters
    ----------
    reader : Reader
        Reads what is asked for.
    scenes : Scenes
        Whose pipeline is used.
    folder : Path
        Out of which no file is written.
    """

    def __init__(self, reader: Reader, scenes: Scenes, folder: Path) -> None:
        self._reader, self._scenes = reader, scenes
        self._folder = folder.resolve()
        self._numbers = itertools.count(1)
        self._running: dict[int, Event] = {}
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="bake")

    def start(self, state: State, output: str | None, tell: Tell) -> int:
        """Begin to bake, and return the number of the bake.

        Raises
        ------
        SkybakeError
            If the state or the name of the file is refused.
        """
        request = self._reader.read(state)
        path = self._target(output, request)
        check_targets(path, request.settings, _preview(request, path), ())
        number, cancel = next(self._numbers), Event()
        self._running[number] = cancel
        self._thread.submit(self._bake, number, request, path, cancel, tell)
        return number

    def cancel(self, number: Any) -> None:
        """Stop a bake, if it is running or waiting."""
        if isinstance(number, int) and number in self._running:
            self._running[number].set()

    def close(self) -> None:
        """Stop all bakes, and wait until their unfinished files are gone."""
        for cancel in list(self._running.values()):
            cancel.set()
        self._thread.shutdown(wait=True)

    def _bake(self, number: int, request: Request, path: Path, cancel: Event, tell: Tell) -> None:
        def report(stage: str, share: float | None = None) -> None:
            tell({"bake": number, "stage": stage, "progress": share})

        try:
            solving = partial(report, SOLVING)
            scene = self._scenes.scene(request, request.settings, cancel, solving)
            scene.workers.check()
            if not scene.sky.is_solved:
                report(SOLVING)
            baked = bake_scene(
                scene,
                path,
                preview=_preview(request, path),
                picture=request.picture,
                attributes=request.attributes,
                progress=lambda share: report("baking", share),
                stage=lambda name: report({"pixels": "baking"}.get(name, name)),
            )
        except CancelledError:
            tell({"bake": number, "cancelled": True})
        except SkybakeError as error:
            tell({"bake": number, "error": str(error)})
        except Exception as error:  # noqa: BLE001 - the page is told, the server goes on
            tell({"bake": number, "error": f"bake: failed unexpectedly ({error!r})"})
        else:
            files = [*baked.files, *([] if baked.preview is None else [baked.preview])]
            tell(
                {
                    "bake": number,
                    "done": True,
                    "files": [str(file.relative_to(self._folder)) for file in files],
                    "folder": str(self._folder),
                    "warnings": list(baked.warnings),
                }
            )
        finally:
            self._running.pop(number, None)

    def _target(self, output: str | None, request: Request) -> Path:
        """Return the path of the map."""
        if output is None:
            return self._folder / default_path(request.planet, request.settings)
        parts = PurePosixPath(output), PureWindowsPath(output)
        is_out = any(path.is_absolute() or path.drive or ".." in path.parts for path in parts)
        path = Path(output)
        if is_out or not path.name or not self._is_within(path):
            raise InputError(f"--output: must be in the working folder, got {output!r}")
        return self._folder / path

    def _is_within(self, path: Path) -> bool:
        """Whether a path is in the folder when all symbolic links have been followed."""
        return (self._folder / path).resolve().is_relative_to(self._folder)


def _preview(request: Request, path: Path) -> Path | None:
    return preview_beside(path) if request.has_preview else None
