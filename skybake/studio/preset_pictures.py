"""Small pictures of the presets, made when they are first asked for."""

from __future__ import annotations

import math
from concurrent.futures import Future, ThreadPoolExecutor
from threading import Lock
from typing import Any

from skybake.formats.preview import png_bytes
from skybake.image.picture_settings import PictureSettings
from skybake.image.settings import map_settings
from skybake.jit.workers import Workers
from skybake.pipeline import Pipeline
from skybake.preset import load_document, preset_names
from skybake.projection import Perspective

WIDTH, HEIGHT = 256, 144

_SHOT = Perspective(
    WIDTH,
    HEIGHT,
    fov=math.radians(80.0),
    azimuth=math.radians(195.0),
    elevation=math.radians(18.0),
)


class PresetPictures:
    """Makes pictures one after the other on one CPU, so that the view keeps the rest."""

    def __init__(self) -> None:
        self._pipeline = Pipeline(workers=Workers(1), keep=1)
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="preset")
        self._made: dict[str, Future[bytes]] = {}
        self._lock = Lock()

    def picture(self, name: str) -> Future[bytes]:
        """Return the PNG of a preset that comes with skybake, once it is made."""
        with self._lock:
            if name not in self._made:
                self._made[name] = self._thread.submit(self._make, name)
            return self._made[name]

    def close(self) -> None:
        """Make no more pictures."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    def _make(self, name: str) -> bytes:
        settings = map_settings(
            sun_elevation=math.radians(12.0),
            sun_azimuth=math.radians(210.0),
            sun_disc="exclude",
            clouds_quality="draft",
        )
        picture = PictureSettings(shot=_SHOT)
        return png_bytes(self._pipeline.picture(name, settings, width=WIDTH, picture=picture))


def preset_list() -> list[dict[str, Any]]:
    """Return the presets that come with skybake, as the page gets them."""
    listed = []
    for name in preset_names():
        data = load_document(name).data
        title, _, summary = data["title"].partition(": ")
        listed.append(
            {
                "name": name,
                "title": title,
                "summary": summary,
                "picture": f"/api/preset-picture/{name}",
            }
        )
    return listed
