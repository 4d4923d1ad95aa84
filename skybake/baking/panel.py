"""Images of a scene, computed band by band: what one file holds."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Literal

import numpy as np
import numpy.typing as npt

from skybake.baking.scene import Scene
from skybake.projection import cubemap, equirect

Pixels = npt.NDArray[np.float32]

LIMB_SAMPLES = 16
LIMB_COARSE = 0.05


class Panel(ABC):
    """One rectangle of pixels.

    Attributes
    ----------
    width, height : int
        [pixel]
    envmap : {"latlong", "cube", None}
        What OpenEXR calls the mapping.
    peak : float
        Largest value that the sun's disc adds to a pixel.
    """

    width: int
    height: int
    envmap: Literal["latlong", "cube"] | None = None
    peak: float

    @abstractmethod
    def rows(self, first: int, last: int) -> Pixels:
        """Compute the rows first..last, shape (last - first, width, 3)."""


class EquirectPanel(Panel):
    """An equirect map, see `skybake.projection.equirect`."""

    envmap = "latlong"

    def __init__(self, scene: Scene, width: int) -> None:
        self.width, self.height = width, width // 2
        self._scene = scene
        self._zenith = equirect.row_zeniths(self.height)[:, None]
        bearing = equirect.column_bearings(width)
        self._azimuth = (bearing - scene.settings.sun_azimuth)[None]
        self._disc = _Disc(
            scene,
            equirect.disc_cells(
                width,
                self.height,
                scene.sun_zenith,
                scene.settings.sun_azimuth,
                scene.sun.angular_radius,
            ),
            width,
        )
        self.peak = self._disc.peak

    def rows(self, first: int, last: int) -> Pixels:
        """Compute the rows first..last."""
        pixels = _sky(self._scene, self._zenith[first:last], self._azimuth, math.pi / self.height)
        return _finish(self._scene, pixels, self._disc, first)


class FacePanel(Panel):
    """One face of a cubemap, see `skybake.projection.cubemap`."""

    def __init__(self, scene: Scene, face: str, edge: int) -> None:
        self.width = self.height = edge
        self._scene = scene
        self._face = face
        self._disc = _Disc(
            scene,
            cubemap.disc_cells(
                face,
                edge,
                scene.sun_zenith,
                scene.settings.sun_azimuth,
                scene.sun.angular_radius,
            ),
            edge,
        )
        self.peak = self._disc.peak

    def rows(self, first: int, last: int) -> Pixels:
        """Compute the rows first..last."""
        zenith, bearing = cubemap.face_angles(self._face, self.width, first, last)
        azimuth = bearing - self._scene.settings.sun_azimuth
        pixels = _sky(self._scene, zenith, azimuth, math.pi / 2.0 / self.width)
        return _finish(self._scene, pixels, self._disc, first)


class CrossPanel(Panel):
    """Six faces as a horizontal cross, black around them."""

    def __init__(self, scene: Scene, edge: int) -> None:
        self.width, self.height = 4 * edge, 3 * edge
        self._faces = {face: FacePanel(scene, face, edge) for face in cubemap.FACES}
        self.peak = max(face.peak for face in self._faces.values())

    def rows(self, first: int, last: int) -> Pixels:
        """Compute the rows first..last."""
        edge = self.width // 4
        out = np.zeros((last - first, self.width, 3), np.float32)
        for face, (row, column) in cubemap.CROSS_ORIGINS.items():
            begin, end = max(first, row * edge), min(last, (row + 1) * edge)
            if begin < end:
                part = self._faces[face].rows(begin - row * edge, end - row * edge)
                out[begin - first : end - first, column * edge : (column + 1) * edge] = part
        return out


class ColumnPanel(Panel):
    """Six faces below each other, turned the way OpenEXR's cube environment wants them."""

    envmap = "cube"

    def __init__(self, scene: Scene, edge: int) -> None:
        self.width, self.height = edge, 6 * edge
        self._faces = [FacePanel(scene, face, edge) for face in cubemap.FACES]
        self.peak = max(face.peak for face in self._faces)

    def rows(self, first: int, last: int) -> Pixels:
        """Compute the rows first..last."""
        edge = self.width
        parts = []
        while first < last:
            face, begin = divmod(first, edge)
            end = min(begin + last - first, edge)
            name = cubemap.FACES[face]
            flipped = cubemap.is_flipped_vertically(name)
            span = (edge - end, edge - begin) if flipped else (begin, end)
            parts.append(cubemap.openexr_face(name, self._faces[face].rows(*span)))
            first += end - begin
        return np.ascontiguousarray(np.concatenate(parts))


class _Disc:
    """Pixel values of the sun's disc: the rows that it touches, dense."""

    def __init__(self, scene: Scene, cells: equirect.Cells, width: int) -> None:
        if scene.settings.sun_disc == "exclude" or cells.distance.size == 0:
            self.first, self.pixels, self.peak = 0, np.zeros((0, width, 3), np.float32), 0.0
            return
        used = cells.texel[cells.weight > 0.0] // width
        self.first = int(used.min())
        rows = int(used.max()) + 1 - self.first
        flux = scene.disc_flux(cells)
        pixels = np.zeros((rows * width, 3))
        for corner in range(cells.texel.shape[1]):
            weight = cells.weight[:, corner]
            lit = weight > 0.0
            texel = cells.texel[lit, corner] - self.first * width
            for channel in range(3):
                pixels[:, channel] += np.bincount(
                    texel, weight[lit] * flux[lit, channel], minlength=rows * width
                )
        self.pixels = pixels.reshape(rows, width, 3).astype(np.float32)
        self.peak = float(np.abs(pixels).max())

    def add_to(self, pixels: Pixels, first: int) -> None:
        """Add the disc to a band that begins at row `first`."""
        begin = max(first, self.first)
        end = min(first + len(pixels), self.first + len(self.pixels))
        if begin < end:
            pixels[begin - first : end - first] += self.pixels[
                begin - self.first : end - self.first
            ]


def _sky(scene: Scene, zenith: np.ndarray, azimuth: np.ndarray, height: float) -> Pixels:
    shape = np.broadcast_shapes(zenith.shape, azimuth.shape)
    if scene.settings.sun_disc == "only":
        return np.zeros((*shape, 3), np.float32)
    pixels = scene.evaluate(zenith, azimuth, height)
    limb = _limb(scene, zenith, height)
    if limb.any():
        # Seen from space the air is a thin line; within a pixel it falls from bright to black.
        offsets = height * ((np.arange(LIMB_SAMPLES) + 0.5) / LIMB_SAMPLES - 0.5)
        fine = zenith[limb][:, None] + offsets
        if zenith.shape[1] == 1:
            samples = scene.evaluate(fine.reshape(-1, 1), azimuth, height / LIMB_SAMPLES)
            samples = samples.reshape(-1, LIMB_SAMPLES, shape[1], 3)
            pixels[limb[:, 0]] = samples.mean(axis=1)
        else:
            around = np.broadcast_to(azimuth, shape)[limb]
            around = np.broadcast_to(around[:, None], fine.shape)
            pixels[limb] = scene.evaluate(fine, around, height / LIMB_SAMPLES).mean(axis=1)
    return pixels


def _limb(scene: Scene, zenith: np.ndarray, height: float) -> np.ndarray:
    """Pixels that hold a part of the limb, where the limb is only a few pixels high."""
    first, last = scene.view.zenith_first, scene.view.zenith_horizon
    if first == 0.0 or height < LIMB_COARSE * (last - first):
        return np.zeros(zenith.shape, np.bool_)
    overlaps: np.ndarray = (zenith + 0.5 * height > first) & (zenith - 0.5 * height < last)
    return overlaps


def _finish(scene: Scene, pixels: Pixels, disc: _Disc, first: int) -> Pixels:
    disc.add_to(pixels, first)
    if scene.settings.clamp_negative:
        np.maximum(pixels, 0.0, out=pixels)
    return pixels
