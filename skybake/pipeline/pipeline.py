"""A pipeline that stays hot between requests, such as frames, previews or changed settings."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from threading import Event

from skybake.image.image import Image, image_of_scene
from skybake.image.picture import CodeValues, picture_ev, thumbnail
from skybake.image.picture_settings import PictureSettings
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.pipeline.stages import KeptStages
from skybake.preset import Planet, load_preset

KEPT = 2

Progress = Callable[[str, float], None]
"""Called with the name of a stage and the share of it that is done, from 0 to 1."""


class Pipeline:
    """Makes images, and keeps what of one serves the next.

    Another exposure, scale or colour space folds the light anew and traces no ray; another
    projection or size only evaluates pixels; another sun or altitude keeps the atmosphere.

    Parameters
    ----------
    workers : Workers, optional
        Threads that do the work.
    keep : int, optional
        Suns and altitudes whose light stays in memory, 6 to 70 MB each.
    keeps_light_of_clouds : bool, optional
        Whether the light of clouds is kept on disk, 50 MB and more for each sky: not worth it where
        each is seen once.

    Notes
    -----
    Several threads may use it at once; what two of them need is computed once.
    """

    def __init__(
        self,
        *,
        workers: Workers = ALL_CPUS,
        keep: int = KEPT,
        keeps_light_of_clouds: bool = True,
    ) -> None:
        self.workers = workers
        self._stages = KeptStages(keep, keeps_light_of_clouds=keeps_light_of_clouds)

    def scene(
        self, preset: Planet | str | Path, settings: MapSettings, cancel: Event | None = None
    ) -> Scene:
        """Return a scene whose stages are shared with those before it.

        Parameters
        ----------
        preset : Planet, str or Path
            A loaded planet, a preset's name, or the path of a preset's file.
        settings : MapSettings
            What is looked at, what lights it, and what its numbers mean.
        cancel : threading.Event, optional
            Stops the work of this scene when another thread sets it.

        Raises
        ------
        SkybakeError
            If the preset or a setting cannot be used.
        """
        planet = preset if isinstance(preset, Planet) else load_preset(preset)
        workers = self.workers if cancel is None else self.workers.with_cancel(cancel)
        return Scene(planet, settings, workers, self._stages)

    def image(
        self,
        preset: Planet | str | Path,
        settings: MapSettings,
        *,
        progress: Progress | None = None,
        cancel: Event | None = None,
    ) -> Image:
        """Make an image.

        Parameters
        ----------
        preset, settings, cancel
            As of `scene`.
        progress : callable, optional
            Called with the stage, "atmosphere", "sky", "clouds" of a world that has them, or
            "pixels", and the share of it that is done.

        Raises
        ------
        SkybakeError
            If the preset or a setting cannot be used.
        CancelledError
            If another thread has set `cancel`; what was finished until then is kept.
        """
        scene = self.scene(preset, settings, cancel)
        _prepare(scene, progress)
        return image_of_scene(scene, _of_stage(progress, "pixels"))

    def picture(
        self,
        preset: Planet | str | Path,
        settings: MapSettings,
        *,
        width: int,
        picture: PictureSettings | None = None,
        progress: Progress | None = None,
        cancel: Event | None = None,
    ) -> CodeValues:
        """Make a display-referred picture; of a map of the whole sphere an equirect one.

        Parameters
        ----------
        preset, settings, progress, cancel
            As of `image`.
        width : int
            [pixel]
        picture : PictureSettings, optional
            How it shows the sky.

        Returns
        -------
        ndarray of uint8, shape (row, width, 3)
            Code values of sRGB.
        """
        scene = self.scene(preset, settings, cancel)
        _prepare(scene, progress)
        picture = picture or PictureSettings()
        return thumbnail(scene, picture_ev(scene, picture), picture, width)


def _prepare(scene: Scene, progress: Progress | None) -> None:
    """Compute the stages before the pixels, to report each on its own."""
    stages: list[tuple[str, Callable[[], object]]] = [
        ("atmosphere", lambda: scene.sky.atmosphere),
        ("sky", lambda: scene.table),
    ]
    if scene.planet.clouds:
        stages.append(("clouds", scene.light_clouds))
    for name, stage in stages:
        scene.workers.check()
        report = _of_stage(progress, name)
        if report is not None:
            report(0.0)
        stage()
        if report is not None:
            report(1.0)


def _of_stage(progress: Progress | None, stage: str) -> Callable[[float], None] | None:
    if progress is None:
        return None
    return lambda share: progress(stage, share)
