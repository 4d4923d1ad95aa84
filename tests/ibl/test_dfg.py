"""The split sum's table is the integral over the hemisphere."""

import math

import pytest
from scipy.integrate import dblquad

from skybake.ibl.dfg import dfg_table

EDGE = 32


def _integral(view, roughness, power):
    """Integral of GGX's specular term over light directions, times (1 - v.h) ** power."""
    a = roughness**4
    across = math.sqrt(1.0 - view * view)

    def integrand(turn, angle):
        light = math.cos(angle)
        x, y = math.sin(angle) * math.cos(turn), math.sin(angle) * math.sin(turn)
        length = math.sqrt((x + across) ** 2 + y * y + (light + view) ** 2)
        height = (light + view) / length
        meeting = (across * (x + across) + view * (light + view)) / length
        density = a / (math.pi * (height * height * (a - 1.0) + 1.0) ** 2)
        shadowing = 0.5 / (
            light * math.sqrt(view * view * (1.0 - a) + a)
            + view * math.sqrt(light * light * (1.0 - a) + a)
        )
        return density * shadowing * light * (1.0 - meeting) ** power * math.sin(angle)

    return 2.0 * dblquad(integrand, 0.0, math.pi / 2, 0.0, math.pi, epsabs=1e-5, epsrel=1e-5)[0]


@pytest.fixture(scope="module")
def table():
    return dfg_table(EDGE)


@pytest.mark.parametrize(("row", "column"), [(31, 3), (20, 16), (16, 30), (12, 8)])
def test_scale_and_bias_are_integrals_of_the_brdf(table, row, column):
    view, roughness = (column + 0.5) / EDGE, (row + 0.5) / EDGE
    whole, fresnel = _integral(view, roughness, 0), _integral(view, roughness, 5)
    scale, bias = table[row, column]
    assert scale == pytest.approx(whole - fresnel, abs=2e-3)
    assert bias == pytest.approx(fresnel, abs=2e-3)


def test_the_multiscatter_form_is_bias_and_the_sum(table):
    other = dfg_table(EDGE, multiscatter=True)
    assert other[..., 0] == pytest.approx(table[..., 1])
    assert other[..., 1] == pytest.approx(table.sum(axis=-1))
