"""What frames leave in memory."""

import gc
import math

import skybake
from skybake.clouds.cloudscape import Cloudscape


def test_the_light_of_clouds_ends_with_their_frame(tmp_path):
    settings = skybake.map_settings(
        size=16, sun_elevation=math.radians(40.0), method="hillaire", clouds_quality="draft"
    )
    plan = skybake.plan_sequence(
        "earth-overcast",
        frames="1-2",
        settings=settings,
        cloud_time=skybake.Ramp(0.0, 60.0),
        output=str(tmp_path / "a.####.exr"),
    )
    before = sum(isinstance(each, Cloudscape) for each in gc.get_objects())
    gc.disable()
    try:
        skybake.bake_sequence(plan, workers=1)
        after = sum(isinstance(each, Cloudscape) for each in gc.get_objects())
    finally:
        gc.enable()
    assert after == before
