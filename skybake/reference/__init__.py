"""The unbiased path tracer: slow, obvious, and what the fast path is judged by."""

from skybake.reference.estimate import (
    BATCHES,
    Irradiance,
    irradiance,
    radiance,
    single_scattering,
)

__all__ = ["BATCHES", "Irradiance", "irradiance", "radiance", "single_scattering"]
