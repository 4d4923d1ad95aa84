"""Scenes of what knobs ask for, kept while they are looked at."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import replace
from threading import Event, Lock
from typing import NamedTuple

from skybake.image.aim import Aim, Lookout, aimed
from skybake.image.layers import Pixels
from skybake.image.scene import Scene
from skybake.image.sensor import Sensor
from skybake.image.settings import Encoding, MapSettings, View
from skybake.jit.workers import ALL_CPUS
from skybake.pipeline.stages import CoarseStages, KeptStages
from skybake.projection import Equirect, Perspective
from skybake.studio.figures import world_key
from skybake.studio.reader import Request

KEPT_SCENES = 4
KEPT_SUNS = 4

SOLVING, TRACING, CLOUDS = "solving atmosphere", "tracing light", "solving clouds"
ECLIPSE = "following the eclipse"
"""Stages that take long."""

FAR = 3.0
"""Altitude from which all of a planet is seen, in its radii."""

Stage = Callable[[str, float | None], None]
"""Called with the stage that begins, and the share of it that is done, if it is known."""


class Finished(NamedTuple):
    """A scene whose pixels have all been computed.

    Attributes
    ----------
    scene : Scene
        Which nobody stops any more.
    pixels : ndarray of float32, shape (row, column, 3)
        Its last full picture.
    """

    scene: Scene
    pixels: Pixels


class Scenes:
    """Makes scenes of shared stages, and keeps the last of them with what they have computed."""

    def __init__(self) -> None:
        self._stages = KeptStages(KEPT_SUNS)
        self._coarse_stages = CoarseStages(KEPT_SUNS)
        self._kept: OrderedDict[str, Finished] = OrderedDict()
        self._lock = Lock()

    def scene(
        self,
        request: Request,
        settings: MapSettings,
        cancel: Event,
        listener: Callable[[float], None] | None = None,
    ) -> Scene:
        """Return a new scene.

        Parameters
        ----------
        request : Request
            The world.
        settings : MapSettings
            What is seen of it.
        cancel : threading.Event
            Stops the work.
        listener : callable, optional
            Called with the share of the atmosphere's solution that is done.
        """
        workers = ALL_CPUS.with_cancel(cancel, listener)
        return Scene(request.planet, settings, workers, self._stages)

    def finished(self, request: Request, settings: MapSettings) -> Finished | None:
        """Return the scene of a request before, if it is kept."""
        key = _key(request, settings)
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
            return self._kept.get(key)

    def first_glance(self, request: Request, scene: Scene, cancel: Event) -> Scene:
        """Return a scene that looks nearly the same and is there sooner.

        It is the scene itself where no ray has to be traced any more, few determine all, or clouds
        take longest.
        """
        is_traced = self._stages.has_traced(scene.sky)
        if scene.planet.clouds or is_traced or not CoarseStages.has_fewer_rays(scene.sky):
            return scene
        workers = ALL_CPUS.with_cancel(cancel)
        return Scene(request.planet, scene.settings, workers, self._coarse_stages)

    def keep(self, request: Request, scene: Scene, pixels: Pixels) -> None:
        """Keep a scene that is finished, for requests that only show it otherwise."""
        with self._lock:
            self._kept[_key(request, scene.settings)] = Finished(scene, pixels)
            while len(self._kept) > KEPT_SCENES:
                self._kept.popitem(last=False)


def equirect_settings(request: Request) -> MapSettings:
    """Return settings of the whole sky as an eye sees it, whatever kind of map it becomes."""
    return _seen(request, replace(request.settings.view, projection=Equirect(), rotation=0.0))


def planet_settings(request: Request, size: tuple[int, int]) -> MapSettings:
    """Return settings of the planet as it is seen from afar."""
    lighting, asked = request.settings.lighting, request.settings.view
    altitude = max(asked.altitude, FAR * request.planet.radius)
    where = Lookout(request.planet, altitude, lighting.sun_azimuth, lighting.sun_elevation)
    picture: Perspective = aimed(Aim("planet"), where, size)
    return _seen(request, View(altitude, picture))


def solve(scene: Scene, stage: Stage) -> None:
    """Solve the atmosphere of a scene, and say so if it is not solved yet."""
    if not scene.sky.is_solved:
        stage(SOLVING, None)
        _ = scene.sky.atmosphere
        stage(TRACING, None)


def prepare(scene: Scene, stage: Stage) -> None:
    """Compute what pixels are made of, and say what takes long."""
    if scene.settings.view.altitude > scene.planet.atmosphere_top:
        # The terminator needs many rays.
        stage(TRACING, None)
    if scene.settings.lighting.moon is not None:
        stage(ECLIPSE, None)
    _ = scene.table
    scene.workers.check()
    if scene.planet.clouds:
        stage(CLOUDS, None)
        scene.light_clouds()
        scene.workers.check()


def _seen(request: Request, view: View) -> MapSettings:
    lighting = request.settings.lighting
    if lighting.sun_disc == "separate":
        lighting = replace(lighting, sun_disc="include")
    return replace(
        request.settings, view=view, lighting=lighting, encoding=Encoding(), sensor=Sensor()
    )


def _key(request: Request, settings: MapSettings) -> str:
    return f"{world_key(request.planet)}\n{settings!r}"
