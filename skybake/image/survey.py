"""The table of a sky that brings no negative light, and what it looks like all around."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from skybake.errors import UnsolvableError
from skybake.image.stages import Stages
from skybake.optics.medium import Array
from skybake.projection.equirect import column_bearings, row_zeniths
from skybake.sky.sky import Sky
from skybake.sky.spectral_table import radiance_at_nodes
from skybake.sky.table import FoldedTable, horizon_angles

SURVEY_ROWS = 256
"""Rows of an equirect map by which the light of a scene is judged."""

ROUNDING = 1e-6
"""Of the brightest luminance: what single precision leaves below 0 where there is no light."""

DARK = 1e-9
"""Of the luminance of a white surface in full sun, below which a negative one is none: on Earth a
fifth of that of the sky in a dark night."""

UNDERSHOOT = 0.01
"""Of the brightest luminance: the most that cubics may be below 0; it is 0 then."""

Evaluate = Callable[[FoldedTable, Array, Array, float], np.ndarray]


def survey_directions(rows: int = SURVEY_ROWS) -> tuple[Array, Array, float]:
    """Zenith angles, azimuths and footprint of a small map of the whole sphere. [rad]"""
    return row_zeniths(rows)[:, None], column_bearings(2 * rows)[None], math.pi / rows


class Survey:
    """Makes the table of a sky and looks at it.

    Where few azimuths ring at a sharp shadow the table has all of them, and where cubics swing
    far below 0 beside its edge, between rays that are sound, it is linear.

    Parameters
    ----------
    sky : Sky
        Whose light it is.
    stages : Stages
        What makes tables.
    rgb_weights, xyz_weights : ndarray of float64, shape (wavelength, 3)
        As of `skybake.image.scene.Scene`.
    luminance : ndarray of float64, shape (3,)
        Weights of pixel values. [cd m⁻²]
    evaluate : callable
        Returns pixel values of a table at zenith angles, azimuths and a footprint.

    Attributes
    ----------
    table : FoldedTable
        The sky as pixel values.
    pixels : ndarray of float32, shape (SURVEY_ROWS, column, 3)
        At `survey_directions`.

    Raises
    ------
    UnsolvableError
        If a luminance is negative beyond rounding, or not finite.
    """

    def __init__(
        self,
        sky: Sky,
        stages: Stages,
        *,
        rgb_weights: Array,
        xyz_weights: Array,
        luminance: Array,
        evaluate: Evaluate,
    ) -> None:
        self._sky, self._stages = sky, stages
        self._xyz_weights, self._luminance = xyz_weights, luminance
        self._evaluate = evaluate
        least, most = self._look(stages.folded_table(sky, rgb_weights))
        if least < -self._rounding(most):
            least, most = self._look(stages.folded_table(sky, rgb_weights, finely=True))
            if least < -self._rounding(most) and self._has_sound_rays():
                if least < -UNDERSHOOT * most:
                    least, most = self._look(self.table._replace(is_linear=True))
                least = 0.0 if least > -UNDERSHOOT * most else least
        if least < -self._rounding(most):
            raise UnsolvableError(
                "light: luminance must be at least 0 beside a brightest one of "
                f"{most:.3g} cd/m2, got {least:.3g}; the atmosphere is beyond what the method "
                "resolves"
            )

    def _look(self, table: FoldedTable) -> tuple[float, float]:
        """Take a table, and return its least and its greatest luminance. [cd m⁻²]"""
        self.table = table
        self.pixels = self._evaluate(table, *survey_directions())
        return _range(self.pixels, self._luminance)

    def _has_sound_rays(self) -> bool:
        """Whether the rays that the table interpolates between bring no negative light."""
        table = self._stages.spectral_table(self._sky, finely=True)
        radiance = radiance_at_nodes(table, self._sky.skylight.phase)
        least, most = _range(radiance, self._xyz_weights[:, 1])
        return least >= -self._rounding(most)

    def _rounding(self, brightest: float) -> float:
        """Luminance below which a negative one is none. [cd m⁻²]"""
        white = float(self._xyz_weights[:, 1].sum()) / math.pi
        return max(ROUNDING * brightest, DARK * white)


class Unlit(NamedTuple):
    """What stands for a `Survey` of a sky whose sun gives no light that is seen.

    Attributes
    ----------
    table : FoldedTable
        That says where horizon and atmosphere begin, and holds no light.
    pixels : ndarray of float32, shape (SURVEY_ROWS, column, 3)
        Zeros.
    """

    table: FoldedTable
    pixels: np.ndarray


def unlit(sky: Sky) -> Unlit:
    """Return the survey of a sky without its sun; no ray is traced for that."""
    medium = sky.medium
    first, horizon = horizon_angles(sky.skylight.radius, medium.r_bottom, medium.r_top)
    table = FoldedTable(
        zenith_first=first,
        zenith_horizon=horizon,
        source_zenith=sky.source.zenith,
        values=np.zeros((2, 1, 1), np.float32),
        curves=np.zeros((1, 1), np.float32),
        is_linear=True,
    )
    return Unlit(table, np.zeros((SURVEY_ROWS, 2 * SURVEY_ROWS, 3), np.float32))


def _range(values: np.ndarray, weights: Array) -> tuple[float, float]:
    """Return the least and the greatest luminance, the sum of values times weights. [cd m⁻²]"""
    with np.errstate(invalid="ignore"):
        luminance = values @ weights
    least, most = float(luminance.min()), float(luminance.max())
    if not math.isfinite(least) or not math.isfinite(most):
        raise UnsolvableError(f"light: luminance must be finite, got {least + most}")
    return least, most
