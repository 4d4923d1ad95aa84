"""An exponential that a loop over wavelengths can vectorise."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel


@kernel
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


_LOG2_E = np.float32(1.4426950408889634)
_LN2_HIGH, _LN2_LOW = np.float32(0.693359375), np.float32(-2.12194440e-4)
_C2, _C3, _C4 = np.float32(1 / 2), np.float32(1 / 6), np.float32(1 / 24)
_C5, _C6 = np.float32(1 / 120), np.float32(1 / 720)
_HALF, _ONE, _LEAST = np.float32(0.5), np.float32(1.0), np.float32(-87.0)


@kernel
def fast_exp32(x):
    """`fast_exp` in single precision, up to 87 and from -87, with a relative error below 3e-7."""
    x = max(x, _LEAST)
    n = np.floor(x * _LOG2_E + _HALF)
    y = x - n * _LN2_HIGH - n * _LN2_LOW
    series = _ONE + y * (_ONE + y * (_C2 + y * (_C3 + y * (_C4 + y * (_C5 + y * _C6)))))
    exponent_bits = np.int32((np.int32(n) + np.int32(127)) << np.int32(23))
    return series * exponent_bits.view(np.float32)
