"""An exponential that a loop over wavelengths can vectorise."""

from __future__ import annotations

import math

import numpy as np

from skybake.transport.kernel import inner_kernel


@inner_kernel
def fast_exp(x):
    """Exponential of `x` up to 300 (taken as -300 below that), with a relative error below 8e-9.

    Notes
    -----
    Splits x into n*ln 2 + y with |y| <= ln(2)/2, sums the Taylor series of
    exp(y) to the seventh power and writes n into the exponent's bits. The call
    into the C library that `math.exp` compiles to keeps LLVM from vectorising
    the loop around it: 7.1 ns an exponential against 0.65 ns.
    """
    n = math.floor(max(x, -300.0) * 1.4426950408889634 + 0.5)
    y = max(x, -300.0) - n * 0.6931471805599453
    series = 1.0 + y * (
        1.0 + y * (1 / 2 + y * (1 / 6 + y * (1 / 24 + y * (1 / 120 + y * (1 / 720 + y / 5040)))))
    )
    exponent_bits = (np.int64(n) + np.int64(1023)) << np.int64(52)
    return series * np.int64(exponent_bits).view(np.float64)
