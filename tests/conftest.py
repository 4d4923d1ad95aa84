"""Settings of all tests."""

from hypothesis import settings

# Kernels compile within the first example, and a run must not depend on luck.
settings.register_profile("skybake", deadline=None, derandomize=True, database=None)
settings.load_profile("skybake")
