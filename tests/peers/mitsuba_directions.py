"""What Mitsuba's emitter envmap shows toward directions in its axes."""

import numpy as np


def shown(file, directions):
    """Return its version, and RGB toward unit vectors, shape (direction, 3)."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    scene = mi.load_dict({"type": "scene", "sky": {"type": "envmap", "filename": str(file)}})
    colours = []
    for direction in directions:
        seen = mi.SurfaceInteraction3f()
        seen.wi = -mi.Vector3f(*direction)
        colours.append(list(scene.environment().eval(seen)))
    return mi.__version__, np.array(colours)
