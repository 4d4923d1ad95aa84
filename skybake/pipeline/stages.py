"""The stages between an atmosphere and pixels, with what is kept of each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skybake.image.stages import Stages
from skybake.jit.kept import Kept
from skybake.optics.medium import Array
from skybake.sky.sky import Sky
from skybake.sky.spectral_table import SpectralTable
from skybake.sky.table import FoldedTable

if TYPE_CHECKING:
    from skybake.night.air import NightAir

TableKey = tuple[str, str, float, float, bool]


class KeptStages(Stages):
    """Stages that compute only what the last few requests have not computed.

    A spectral table is that of an atmosphere, an observer's altitude and a sun's elevation;
    a folded one that of a spectral table, a colour space and a scale besides. The air of the
    night is that of an atmosphere and an altitude.

    Parameters
    ----------
    most : int
        Spectral tables to keep, 6 to 70 MB each, and twice as many folded ones, 5 MB each.
    keeps_light_of_clouds : bool, optional
        As of `Stages`.
    """

    def __init__(self, most: int, *, keeps_light_of_clouds: bool = True) -> None:
        super().__init__(keeps_light_of_clouds=keeps_light_of_clouds)
        self._spectral: Kept[TableKey, SpectralTable] = Kept(most)
        self._folded: Kept[tuple[TableKey, bytes], FoldedTable] = Kept(2 * most)
        self._night_air: Kept[tuple[str, float, bool, bool], NightAir] = Kept(most)

    def spectral_table(self, sky: Sky, *, finely: bool = False) -> SpectralTable:
        """Light around the observer in all wavelengths."""
        return self._spectral.get(_table_key(sky, finely), lambda: self.trace(sky, finely=finely))

    def trace(self, sky: Sky, *, finely: bool) -> SpectralTable:
        """Trace the rays of a spectral table."""
        return super().spectral_table(sky, finely=finely)

    def has_traced(self, sky: Sky) -> bool:
        """Whether the rays of a sky are traced already, or being traced."""
        return any(self._spectral.has(_table_key(sky, finely)) for finely in (False, True))

    def folded_table(self, sky: Sky, rgb_weights: Array, *, finely: bool = False) -> FoldedTable:
        """Light around the observer as pixel values."""
        make = super().folded_table
        key = _table_key(sky, finely), rgb_weights.tobytes()
        return self._folded.get(key, lambda: make(sky, rgb_weights, finely=finely))

    def night_air(self, sky: Sky, *, has_airglow: bool, has_city: bool) -> NightAir:
        """Return what of the night over the observer no hour changes."""
        make = super().night_air
        key = sky.atmosphere_key, sky.altitude, has_airglow, has_city
        return self._night_air.get(
            key, lambda: make(sky, has_airglow=has_airglow, has_city=has_city)
        )


class CoarseStages(KeptStages):
    """Stages for a first glance, whose rays are a third in twilight and in dust."""

    def trace(self, sky: Sky, *, finely: bool) -> SpectralTable:
        """Trace the rays of a spectral table at few azimuths."""
        return sky.skylight.spectral_table(sky.source, finely=finely, coarsely=not finely)

    @staticmethod
    def has_fewer_rays(sky: Sky) -> bool:
        """Whether it has fewer rays than other stages."""
        few, all_rays = (
            sky.skylight.table_geometry(sky.source, coarsely=coarsely).mu.size
            for coarsely in (True, False)
        )
        return few < all_rays


def _table_key(sky: Sky, finely: bool) -> TableKey:
    return sky.atmosphere_key, sky.method, sky.altitude, sky.sun_elevation, finely
