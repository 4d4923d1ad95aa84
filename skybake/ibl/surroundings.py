"""Light from all around as lighting maps are made of it: a cube, and points beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from skybake.angles import direction_from_angles, zenith_azimuth
from skybake.colour.space import rgb_from_xyz
from skybake.ibl.cube import Cube, texel_directions
from skybake.ibl.points import Points, disc, no_points
from skybake.image.discs import ShownDisc, shown_moon, shown_sun
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.projection.cells import Cells
from skybake.projection.cubemap import Cubemap


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Light from all around.

    Attributes
    ----------
    cube : ndarray of float32, shape (6, m, m, 3)
        All of it, as a perfect mirror shows it.
    smooth : ndarray of float32, shape (6, n, n, 3)
        All but the points, as large as its details need.
    points : Points
        What is too small for texels, such as the sun.
    """

    cube: Cube
    smooth: Cube
    points: Points

    @property
    def peak(self) -> float:
        """Largest magnitude of a value."""
        return float(np.abs(self.cube).max())


def surroundings_of_scene(scene: Scene, edge: int) -> Surroundings:
    """Evaluate a scene on a cube; the discs that it shows are points besides.

    Parameters
    ----------
    scene : Scene
        What is around.
    edge : int
        Of the cube. [pixel]
    """
    smooth = np.empty((6, edge, edge, 3), np.float32)
    cube = np.empty_like(smooth)
    for face, canvas in enumerate(Cubemap(edge).canvases()):
        layers = Raster(scene, canvas).layers(0, edge)
        sky = layers.plane("sky")
        smooth[face] = 0.0 if sky is None else sky
        discs = [layers.plane(name) for name in ("sun", "moon")]
        cube[face] = smooth[face] + sum(each for each in discs if each is not None)
        scene.workers.check()
    return Surroundings(cube, smooth, sun_points(scene).joined(moon_points(scene)))


def sun_points(scene: Scene) -> Points:
    """Return the disc of a scene's sun, as it is drawn, as points; none if it is not shown."""
    shown = shown_sun(scene)
    return no_points() if shown is None else _disc_points(scene, shown, scene.sun_xyz()[0])


def moon_points(scene: Scene) -> Points:
    """Return the disc of a scene's Moon as points, none of a scene that does not show it."""
    shown = shown_moon(scene)
    if shown is None or scene.moonlit is None:
        return no_points()
    return _disc_points(scene, shown, scene.moonlit.xyz()[0])


def _disc_points(scene: Scene, shown: ShownDisc, xyz: np.ndarray) -> Points:
    """Return a disc as points of the light that files state, XYZ on a plane that faces it. [lx]"""
    centre = direction_from_angles(shown.bearing, 0.5 * math.pi - shown.zenith)
    directions, distances, sizes = disc(centre, shown.angular_radius)
    zenith, azimuth = zenith_azimuth(directions)
    nowhere = np.zeros((len(sizes), 0))
    cells = Cells(zenith, azimuth, distances, sizes, nowhere.astype(np.int64), nowhere)
    flux = shown.flux(cells)
    # The parts of the disc are a coarser sum.
    encoding = scene.settings.encoding
    stated = rgb_from_xyz(encoding.space) @ xyz / encoding.white_luminance
    total = flux.sum(axis=0)
    is_lit = np.abs(total) > 0.0
    flux *= np.where(is_lit, stated / np.where(is_lit, total, 1.0), 0.0)
    return Points(directions, flux)


def without_disc(cube: Cube, direction: np.ndarray, radius: float, pixel: float = 0.0) -> Cube:
    """Return a cube in which a disc is as bright as the ring around it.

    Parameters
    ----------
    cube : ndarray of float32, shape (6, n, n, 3)
        The light.
    direction, radius : ndarray of float64, shape (3,), float
        Unit vector of the disc's centre, and its angular radius. [rad]
    pixel : float, optional
        Extent of the pixels that the cube was made of, if they were larger than its texels. [rad]
    """
    edge = cube.shape[1]
    # The largest texels are 2 / edge wide, and the disc touches them up to their diagonal.
    extent = max(pixel, 2.0 / edge)
    reach, ring = radius + 1.5 * extent, radius + 3.5 * extent
    apart = np.linalg.norm(texel_directions(edge) - direction.astype(np.float32), axis=-1)
    distance = 2.0 * np.arcsin(np.minimum(0.5 * apart, 1.0))
    around = (distance > reach) & (distance <= ring)
    filled = cube.copy()
    filled[distance <= reach] = cube[around].mean(axis=0, dtype=np.float64)
    return filled
