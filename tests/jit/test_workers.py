import os
import threading

import numpy as np
import pytest

from skybake.errors import CancelledError
from skybake.jit.workers import Workers


@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("chunk", [1, 3, 7, 100])
@pytest.mark.parametrize("rows", [0, 1, 10, 64])
def test_every_row_is_worked_on_once(rows, chunk, count):
    visits = np.zeros(rows, int)

    def work(first, last):
        visits[first:last] += 1

    Workers(count).run_rows(rows, work, chunk=chunk)
    assert (visits == 1).all()


@pytest.mark.parametrize("count", [1, 3])
def test_work_that_fails_tells_its_caller(count):
    def work(first, last):
        if first == 3:
            raise ArithmeticError("row 3")

    with pytest.raises(ArithmeticError, match="row 3"):
        Workers(count).run_rows(8, work)


def test_one_worker_is_the_callers_own_thread():
    threads = set()
    Workers(1).run_rows(4, lambda *_: threads.add(threading.current_thread()))
    assert threads == {threading.current_thread()}


@pytest.mark.parametrize("count", [1, 2])
def test_work_that_is_cancelled_stops_before_its_next_rows(count):
    cancel, done = threading.Event(), []

    def work(first, last):
        done.append(first)
        if len(done) == 3:
            cancel.set()

    with pytest.raises(CancelledError):
        Workers(count, cancel).run_rows(1000, work)
    assert len(done) < 3 + count


@pytest.mark.parametrize("count", [1, 2])
def test_items_are_worked_on_in_order_and_ahead_where_there_are_cpus(count):
    begun, seen = [], []

    def work(item):
        begun.append(item)
        return None if item == 2 else item * item

    for result in Workers(count).ahead(work, range(5)):
        seen.append(result)
        if count == 1:
            assert len(begun) == len(seen)
    assert seen == [0, 1, None, 9, 16]


@pytest.mark.parametrize("count", [1, 2])
def test_what_is_worked_on_ahead_stops_when_it_is_cancelled(count):
    cancel = threading.Event()
    results = Workers(count, cancel).ahead(lambda item: item, range(1000))
    next(results)
    cancel.set()
    with pytest.raises(CancelledError):
        list(results)


@pytest.mark.filterwarnings("ignore:.*multi-threaded.*fork:DeprecationWarning")
def test_a_forked_process_works_though_its_parent_had_threads():
    workers = Workers(2)
    workers.run_rows(8, lambda *_: None)
    child = os.fork()
    if child == 0:
        workers.run_rows(8, lambda *_: None)
        os._exit(7)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7


def test_the_share_that_is_done_is_told_to_who_listens():
    told = []
    Workers(1).tell(0.2)
    Workers(1).with_cancel(threading.Event(), told.append).tell(0.4)
    assert told == [0.4]
