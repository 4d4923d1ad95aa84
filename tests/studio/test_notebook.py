"""In a notebook skies, images and the studio show themselves."""

import subprocess
import sys
import urllib.error
import urllib.request

import pytest

import skybake

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def frame():
    return skybake.studio("mars", height=500)


def test_the_studio_is_a_frame_in_a_cell(frame):
    html = frame._repr_html_()
    assert f'<iframe src="{frame.url}"' in html
    assert 'height="500"' in html


def test_the_frame_is_served_by_the_notebook_itself(frame):
    address, _, token = frame.url.partition("?")
    with urllib.request.urlopen(f"{address}api/options?{token}") as answer:  # noqa: S310
        assert b'"preset": "mars"' in answer.read()
        # The page of the notebook has another origin.
        assert "frame-ancestors" not in answer.headers["Content-Security-Policy"]
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(f"{address}api/options")  # noqa: S310


def test_an_unknown_preset_is_refused_at_once():
    with pytest.raises(skybake.PresetError, match="unknown preset 'vulcan'"):
        skybake.studio("vulcan")


@pytest.mark.parametrize(
    "first", ["import skybake.studio.state", "from skybake import studio", "import skybake.cli"]
)
def test_the_function_is_there_whatever_is_imported_first(first):
    code = f"{first}\nimport skybake\nassert callable(skybake.studio)\nfrom skybake import studio\n"
    code += "assert studio is skybake.studio\nimport skybake.studio.state"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_skies_and_images_are_pictures():
    sky = skybake.Sky("earth", sun_elevation=0.5)
    assert sky._repr_png_().startswith(PNG)
    assert sky.image("fisheye", 64)._repr_png_().startswith(PNG)
