"""The stages between an atmosphere and pixels, with what is kept of each."""

from __future__ import annotations

from skybake.image.stages import Stages
from skybake.jit.kept import Kept
from skybake.optics.medium import Array
from skybake.scattering.atmosphere import atmosphere_key
from skybake.sky.sky import Sky
from skybake.sky.spectral_table import SpectralTable
from skybake.sky.table import FoldedTable

TableKey = tuple[str, str, float, float, bool]


class KeptStages(Stages):
    """Stages that compute only what the last few requests have not computed.

    A spectral table is that of an atmosphere, an observer's altitude and a sun's elevation;
    a folded one that of a spectral table, a colour space and a scale besides.

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

    def spectral_table(self, sky: Sky, *, finely: bool = False) -> SpectralTable:
        """Light around the observer in all wavelengths."""
        make = super().spectral_table
        return self._spectral.get(_table_key(sky, finely), lambda: make(sky, finely=finely))

    def folded_table(self, sky: Sky, rgb_weights: Array, *, finely: bool = False) -> FoldedTable:
        """Light around the observer as pixel values."""
        make = super().folded_table
        key = _table_key(sky, finely), rgb_weights.tobytes()
        return self._folded.get(key, lambda: make(sky, rgb_weights, finely=finely))


def _table_key(sky: Sky, finely: bool) -> TableKey:
    key = atmosphere_key(sky.medium, sky.table_method)
    return key, sky.method, sky.altitude, sky.sun_elevation, finely
