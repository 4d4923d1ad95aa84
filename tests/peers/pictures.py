"""Pictures of the programs' scenes for the documentation."""

import numpy as np
from PIL import Image

from skybake.image.picture import code_values
from skybake.image.settings import Encoding

EV = 14.0


def write_picture(path, pixels):
    """Write linear pixels as a PNG, all through the same display transform."""
    shown = code_values(np.ascontiguousarray(pixels, np.float32), Encoding(), EV, "aces1", None)
    Image.fromarray(shown).save(path, optimize=True)
