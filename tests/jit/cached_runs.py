"""Processes that compile kernels or find them."""

import subprocess
import sys

SCRIPT = """
import sys
from skybake.jit.cache import cache_folder, is_warm
import numpy as np
from skybake.scattering.harmonics import build_harmonics, fill_harmonics
before = is_warm()
fill_harmonics(build_harmonics(2), 0.5, np.empty(6))
folder = cache_folder()
print(folder and folder.path, before, is_warm(), int("numba" not in sys.modules))
"""


LARGER = """
import numpy as np
from skybake import load_preset
from skybake.scattering.transmittance import build_columns
from skybake.optics.medium import build_medium
build_columns(build_medium(load_preset("earth"), np.array([550.0])), shape=(2, 2), steps=1)
"""


def run(cache=None, *, script=SCRIPT, wrapper=(), **environment):
    if cache is not None:
        environment["SKYBAKE_CACHE_DIR"] = str(cache)
    return subprocess.run(
        [*wrapper, sys.executable, "-W", "always", "-c", script],
        env={"PYTHONPATH": ":".join(sys.path), **environment},
        capture_output=True,
        text=True,
        check=True,
        timeout=240,
    )


def check_that_nothing_is_kept(result, warning):
    assert result.stdout.split() == ["None", "False", "False", "0"]
    assert result.stderr.count("RuntimeWarning") == 1
    assert warning in result.stderr
