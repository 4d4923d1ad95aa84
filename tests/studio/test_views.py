"""When a request gives way to a newer one."""

import pytest

from skybake.errors import CancelledError, InputError
from skybake.studio.state import State
from skybake.studio.views import Cancel, ViewRequest, view_request


@pytest.fixture
def view():
    return ViewRequest(1, State(), "equirect", (64, 32))


def test_a_quick_picture_is_finished_for_a_knob_that_moves_on(view):
    view.supersede(has_same_world=True)
    assert not view.cancel.is_set()
    with pytest.raises(CancelledError):
        view.enter_slow()


def test_slow_work_is_stopped_at_once(view):
    view.enter_slow()
    view.supersede(has_same_world=True)
    assert view.cancel.is_set()


@pytest.mark.parametrize("has_same_world", [False, True])
def test_an_atmosphere_that_the_newer_picture_needs_is_solved_to_the_end(view, has_same_world):
    view.enter_slow()
    view.is_solving = True
    view.supersede(has_same_world=has_same_world)
    assert view.cancel.is_set() is not has_same_world


def test_finished_work_is_not_stopped_any_more():
    cancel = Cancel()
    assert cancel.finish()
    cancel.set()
    assert not cancel.is_set()


def test_stopped_work_is_not_finished():
    cancel = Cancel()
    cancel.set()
    assert not cancel.finish()


@pytest.mark.parametrize(
    "data",
    [
        {"view": {"kind": "sphere"}},
        {"view": {"size": [8, 4]}},
        {"view": {"size": [64, 64]}},
        {"view": {"size": [8192, 4096]}},
        {"view": {"size": "64x32"}},
        {"view": {"size": [64.0, 32.0]}},
        {"view": {"size": [True, False]}},
        {"view": 5},
    ],
)
def test_a_view_that_is_none_is_refused(data):
    with pytest.raises(InputError, match="view: "):
        view_request(data, 1)
