"""Light from all around as lighting maps are made of it: a cube, and points beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from skybake.angles import direction_from_angles, zenith_azimuth
from skybake.colour.space import rgb_from_xyz
from skybake.ibl.cube import Cube, texel_directions
from skybake.ibl.points import Points, disc, no_points
from skybake.image.discs import sun_flux
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
    """Evaluate a scene on a cube; its sun's disc, if it is to be shown, is points besides.

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
        sky, sun = layers.plane("sky"), layers.plane("sun")
        smooth[face] = 0.0 if sky is None else sky
        cube[face] = smooth[face] if sun is None else smooth[face] + sun
        scene.workers.check()
    has_sun = "sun" in scene.layer_names
    return Surroundings(cube, smooth, sun_points(scene) if has_sun else no_points())


def sun_points(scene: Scene) -> Points:
    """Return the disc of a scene's sun, as it is drawn, as points."""
    elevation = 0.5 * math.pi - scene.sun_zenith
    centre = direction_from_angles(scene.sun_bearing, elevation)
    directions, distances, sizes = disc(centre, scene.sun.angular_radius)
    zenith, azimuth = zenith_azimuth(directions)
    nowhere = np.zeros((len(sizes), 0))
    cells = Cells(zenith, azimuth, distances, sizes, nowhere.astype(np.int64), nowhere)
    flux = sun_flux(scene, cells)
    # As much light as files state, of which the parts of the disc are a coarser sum.
    encoding = scene.settings.encoding
    stated = rgb_from_xyz(encoding.space) @ scene.sun_xyz()[0] / encoding.white_luminance
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
