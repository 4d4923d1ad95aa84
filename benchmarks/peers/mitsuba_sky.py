"""Bakes Mitsuba's `sunsky` emitter into a map: ``mitsuba_sky.py WIDTH ELEVATION_DEG FILE.exr``.

Mitsuba has no command for it; these are the fewest lines that do it, with its fastest variant.
"""

import math
import sys

import drjit
import mitsuba

mitsuba.set_variant("llvm_ad_rgb")

width, elevation = int(sys.argv[1]), math.radians(float(sys.argv[2]))
height = width // 2
sun = [0.0, -math.cos(elevation), math.sin(elevation)]
emitter = mitsuba.load_dict({"type": "sunsky", "sun_direction": sun, "turbidity": 3.0})
row, column = drjit.meshgrid(
    drjit.arange(mitsuba.Float, height), drjit.arange(mitsuba.Float, width), indexing="ij"
)
zenith, azimuth = (row + 0.5) / height * drjit.pi, (column + 0.5) / width * 2.0 * drjit.pi
interaction = drjit.zeros(mitsuba.SurfaceInteraction3f)
interaction.wi = -mitsuba.Vector3f(
    drjit.sin(zenith) * drjit.sin(azimuth),
    drjit.sin(zenith) * drjit.cos(azimuth),
    drjit.cos(zenith),
)
pixels = mitsuba.TensorXf(drjit.ravel(emitter.eval(interaction)), (height, width, 3))
half = mitsuba.Struct.Type.Float16
mitsuba.Bitmap(pixels).convert(mitsuba.Bitmap.PixelFormat.RGB, half, False).write(sys.argv[3])
