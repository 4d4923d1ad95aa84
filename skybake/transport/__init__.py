"""Light along a ray: geometry, columns and marching, in numba kernels."""
