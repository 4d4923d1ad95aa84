"""Radiances that cannot be are not told."""

import csv
import io
import math

import numpy as np
import pytest

from skybake.errors import UnsolvableError
from skybake.inspect.probe import default_directions, probe, read_directions
from skybake.preset import load_preset
from skybake.reference import cloudy
from skybake.sky.sky import Sky

SUN = math.radians(20.0)


@pytest.fixture
def spoil(monkeypatch):
    """Pass radiances of every sky through a function."""
    evaluate = Sky.radiance_per_irradiance

    def spoil(change):
        monkeypatch.setattr(
            Sky, "radiance_per_irradiance", lambda self, mu, nu: change(evaluate(self, mu, nu))
        )

    return spoil


def probed():
    planet = load_preset("earth-hillaire2020")
    return probe(planet, default_directions(SUN), sun_elevation=SUN, method="hillaire")


@pytest.mark.parametrize(
    ("factor", "fault"), [(-1.0, r"at least 0 .*got -\d"), (math.nan, "must be finite, got nan")]
)
def test_negative_or_undefined_radiance_is_refused_in_a_line(spoil, factor, fault):
    spoil(lambda radiance: radiance * factor)
    with pytest.raises(UnsolvableError, match=fault) as caught:
        probed()
    assert len(str(caught.value).splitlines()) == 1


def test_radiance_below_0_by_rounding_is_told_as_0(spoil):
    spoil(lambda radiance: np.where(radiance == radiance.min(), -1e-12, radiance))
    rows = csv.DictReader(io.StringIO(probed()))
    values = [float(row[f"radiance_{w}nm"]) for row in rows for w in (680, 550, 440)]
    assert min(values) == 0.0


def test_clouds_are_traced_clockwise_from_the_bearing_of_the_sun(monkeypatch):
    seen = {}

    def radiance(medium, fields, phases, altitude, elevation, sun, zenith, bearing, *, samples):
        seen.update(fields=fields, sun=sun, zenith=zenith, bearing=bearing, samples=samples)
        assert [phase.shape for phase in phases] == [(1025, 1)]
        return np.ones((2, 1, zenith.size))[:, 0, :, None]

    monkeypatch.setattr(cloudy, "radiance", radiance)
    directions = read_directions("x", ["view_zenith_deg,relative_azimuth_deg", "10,0", "60,-90"])
    text = probe(
        load_preset("earth-overcast"),
        directions,
        sun_elevation=SUN,
        sun_azimuth=math.radians(120.0),
        wavelengths=np.array([550.0]),
        per_irradiance=True,
        method="reference",
        samples=7,
    )
    assert text.splitlines()[1:] == ["10,0,1,1", "60,-90,1,1"]
    np.testing.assert_allclose(np.degrees(seen["bearing"]), [120.0, 30.0])
    np.testing.assert_allclose(np.degrees(seen["zenith"]), [10.0, 60.0])
    assert math.degrees(seen["sun"]) == pytest.approx(120.0)
    assert (len(seen["fields"]), seen["samples"]) == (1, 7)
