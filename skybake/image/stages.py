"""The stages from a sky to the table that pixels read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skybake.optics.medium import Array
from skybake.sky.sky import Sky
from skybake.sky.spectral_table import SpectralTable, fold_table
from skybake.sky.table import FoldedTable

if TYPE_CHECKING:
    from skybake.clouds.cloudscape import Cloudscape
    from skybake.image.settings import Clouds
    from skybake.night.air import NightAir
    from skybake.sky.stokes_table import StokesTable


class Stages:
    """Computes each stage when it is needed, and keeps none.

    Parameters
    ----------
    keeps_light_of_clouds : bool, optional
        Whether the light of clouds is kept on disk, as for another map of the same sky.

    Attributes
    ----------
    keeps_light_of_clouds : bool
        As given.
    """

    def __init__(self, *, keeps_light_of_clouds: bool = True) -> None:
        self.keeps_light_of_clouds = keeps_light_of_clouds

    def spectral_table(self, sky: Sky, *, finely: bool = False) -> SpectralTable:
        """Light around the observer in all wavelengths; the one stage that traces rays."""
        return sky.skylight.spectral_table(sky.source, finely=finely)

    def stokes_table(self, sky: Sky) -> StokesTable:
        """Linear polarisation around the observer in all wavelengths."""
        from skybake.sky.stokes_table import stokes_table

        return stokes_table(sky.skylight, sky.source, self.spectral_table(sky))

    def folded_table(self, sky: Sky, rgb_weights: Array, *, finely: bool = False) -> FoldedTable:
        """Light around the observer as pixel values.

        Parameters
        ----------
        sky : Sky
            What is seen.
        rgb_weights : ndarray of float64, shape (wavelength, 3)
            Pixel values are the radiance per unit irradiance times these.
        finely : bool, optional
            As of `skybake.sky.spectral_table.table_geometry`.
        """
        return fold_table(self.spectral_table(sky, finely=finely), sky.skylight.basis, rgb_weights)

    def cloudscape(self, sky: Sky, weights: Array, clouds: Clouds) -> Cloudscape | None:
        """Return a world's clouds over the observer, or None where there is none.

        Parameters
        ----------
        sky : Sky
            The observer, the air and what lights it.
        weights : ndarray of float64, shape (wavelength, channel)
            As of `skybake.clouds.build.build_cloudscape`.
        clouds : Clouds
            When they are seen, and how finely.
        """
        # Clear skies do not wait for kernels of clouds.
        from skybake.clouds.build import build_cloudscape

        return build_cloudscape(
            sky.planet.clouds,
            sky,
            weights,
            time=clouds.time,
            quality=clouds.quality,
            workers=sky.workers,
            keeps_light=self.keeps_light_of_clouds,
        )

    def night_air(self, sky: Sky, *, has_airglow: bool, has_city: bool) -> NightAir:
        """Return what of the night over the observer no hour changes."""
        # By day there is none.
        from skybake.night.air import NightAir

        return NightAir(sky, has_airglow=has_airglow, has_city=has_city)
