"""The judge: an unbiased path tracer, and single scattering by direct quadrature."""
