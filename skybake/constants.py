"""Constants of nature, in the units that the code computes with unless said otherwise."""

from __future__ import annotations

ASTRONOMICAL_UNIT = 149_597_870.7
"""Definition of the au, IAU 2012 resolution B2. [km]"""

BOLTZMANN = 1.380649e-23
"""Exact, SI 2019. [J K⁻¹]"""

DOBSON_UNIT = 2.686780e20
"""Molecules in a layer 10 um thick at 273.15 K and 101325 Pa, CODATA 2018. [m⁻²]"""

STANDARD_NUMBER_DENSITY = 2.546899e25
"""Molecules of air at 288.15 K and 101325 Pa, to which tabulated refractive indices
belong; Bodhaine et al. (1999). [m⁻³]"""
