import threading

import numpy as np
import pytest

from skybake.transport.threads import run_rows, thread_count


@pytest.mark.parametrize("chunk", [1, 3, 7, 100])
@pytest.mark.parametrize("rows", [0, 1, 10, 64])
def test_every_row_is_worked_on_once(rows, chunk):
    visits = np.zeros(rows, int)

    def work(first, last):
        visits[first:last] += 1

    run_rows(rows, work, chunk=chunk)
    assert (visits == 1).all()


def test_work_that_fails_tells_its_caller():
    def work(first, last):
        if first == 3:
            raise ArithmeticError("row 3")

    with pytest.raises(ArithmeticError, match="row 3"):
        run_rows(8, work)


def test_rows_within_rows_do_not_wait_for_themselves():
    done = []

    def outer(first, last):
        run_rows(4, lambda a, b: done.append((first, a)))

    worker = threading.Thread(target=run_rows, args=(2 * thread_count() + 2, outer), daemon=True)
    worker.start()
    worker.join(timeout=20.0)
    assert not worker.is_alive()
    assert len(set(done)) == 4 * (2 * thread_count() + 2)
