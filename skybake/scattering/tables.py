"""The tables of an atmosphere, which rays look up."""

from __future__ import annotations

from typing import NamedTuple

from skybake.optics.delta_m import ScaledMedium
from skybake.optics.medium import Array, Medium
from skybake.optics.phase_basis import PhaseBasis
from skybake.scattering.aureole import Aureole
from skybake.scattering.field import DiffuseField
from skybake.scattering.horizon_peaks import HorizonPeaks


class Atmosphere(NamedTuple):
    """A medium and its tables: what depends neither on the observer nor on a source of light.

    Attributes
    ----------
    medium : Medium
        The medium itself.
    scaled : ScaledMedium
        The same without forward peaks, and what restores them. Its wavelengths, and those of
        all tables but `basis`, are as `pad_wavelengths` leaves them.
    shells : ndarray of float64
        Altitudes at which rays are cut into steps. [km]
    columns : ndarray of float64
        Columns toward a source, see `build_columns`.
    field : DiffuseField
        The light that was scattered before.
    aureole : Aureole
        What forward peaks scatter of light that other peaks bent.
    horizon_peaks : HorizonPeaks
        What forward peaks scatter of diffuse light across the horizon.
    basis : PhaseBasis
        Curves that the phase functions of `scaled` are sums of.
    """

    medium: Medium
    scaled: ScaledMedium
    shells: Array
    columns: Array
    field: DiffuseField
    aureole: Aureole
    horizon_peaks: HorizonPeaks
    basis: PhaseBasis
