"""Records of frames for tests."""

import math

from skybake.sequence.manifest import FrameRecord, SequenceHeader

HEADER = SequenceHeader(
    preset="earth",
    projection="equirect",
    colorspace="acescg",
    sun_disc="exclude",
    sun_angular_diameter_deg=0.533,
    recipe={"map": {"width": 64}, "preset": {"name": "earth"}},
)


def direction(elevation, azimuth):
    elevation, azimuth = math.radians(elevation), math.radians(azimuth)
    return (
        math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation),
        -math.cos(elevation) * math.cos(azimuth),
    )


def record(frame, elevation=30.0, azimuth=180.0, **changes):
    values = {
        "frame": frame,
        "time": f"2026-06-21T12:{frame % 60:02d}:00Z",
        "label": f"14:{frame % 60:02d}",
        "sun_elevation_deg": elevation,
        "sun_azimuth_deg": azimuth,
        "altitude_m": 0.0,
        "sun_direction": direction(elevation, azimuth),
        "sun_colour": (1.2, 0.98, 0.61),
        "sun_distance_au": 1.0,
        "sun_angular_diameter_deg": 0.533,
        "sun_illuminance_lux": 90000.0,
        "direct_illuminance_lux": 45000.0,
        "sky_illuminance_lux": 12345.678,
        "white_luminance_cd_m2": 39321.6,
        "exposure_ev": 14.25,
        "files": (f"sky.{frame:04d}.exr",),
        "sha256": ("ab" * 32,),
        "preview": None,
    }
    return FrameRecord(**{**values, **changes})
